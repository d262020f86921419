#include <algorithm>

#include "renderer/base/clock.hpp"
#include "renderer/session/session_impl.hpp"

namespace limn {
namespace {

/// A dispatch smaller than this share of a quantum is mostly overhead.
constexpr double kLeastShareOfQuantum = 0.5;

}  // namespace

// Pipelines are made with those of the technique, whatever the share: a share that rises later stops nobody.
Result<void> Session::Impl::restartAudit(bool mayCompile) {
  auditOwed = auditedSeconds = 0.0;
  if (!technique->info().biased) return {};
  if (auto done = audit.prepare(context(), needs, mayCompile); !done) return done;
  return audit.restart(context());
}

double Session::Impl::auditShare() const {
  if (!technique->info().biased) return 0.0;
  const auto found = parameters.find(auditShareInfo().name);
  return found == parameters.end() ? 0.0 : found->second;
}

bool Session::Impl::everyPixelIsShown() const { return progress.passes > 0 || progress.fillStride <= 1; }

// The first picture is not kept waiting; what it owes is made good later.
bool Session::Impl::auditIsDue(double seconds) const {
  const bool early = !everyPixelIsShown() || auditOwed < kLeastShareOfQuantum * seconds;
  return auditShare() > 0.0 && config.auditPathsPerPass == 0 && !early;
}

Result<void> Session::Impl::auditFor(double seconds) {
  const double begin = nowSeconds();
  if (auto done = audit.advance(context(), std::min(seconds, auditOwed)); !done) return done;
  const double spent = nowSeconds() - begin;
  auditOwed -= spent;
  auditedSeconds += spent;
  newSamples = true;
  ++status.quanta;
  return {};
}

Result<void> Session::Impl::auditPass() {
  if (auditShare() == 0.0) return {};
  while (audit.paths() < uint64_t(progress.passes) * config.auditPathsPerPass)
    if (auto done = audit.advance(context(), 1.0); !done) return done;
  return {};
}

// The samples of a biased technique agree on what is wrong in all of them: others' samples tell its error, or nothing does.
Result<void> Session::Impl::estimateError() {
  auto told = statistics->means(device, *film);
  if (!told) return told.error();
  means = *told;
  if (technique->info().biased && (auditShare() == 0.0 || !everyPixelIsShown())) {
    error = {};
    return {};
  }
  auto estimate = technique->info().biased ? audit.estimate(context()) : statistics->estimate(device, *film, means.radiance);
  if (!estimate) return estimate.error();
  error = *estimate;
  return {};
}

}  // namespace limn
