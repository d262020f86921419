#include "server/limn/bench_ablation.hpp"

#include <algorithm>
#include <limits>

#include "renderer/base/clock.hpp"
#include "renderer/vk/device.hpp"

namespace limn::bench {
namespace {

constexpr uint32_t kFirstSteps = 4;  // those of a technique that differ from the rest

/// All of the device's, which other sessions share [MB].
Result<double> megabytesHeld(Session& session) {
  const Result<Status> status = session.status();
  if (!status) return status.error();
  double megabytes = 0.0;
  for (const auto& [owner, bytes] : status->memory) megabytes += double(bytes) * 1e-6;
  return megabytes;
}

/// One more step of a session; the quickest is kept.
Result<void> timeStep(Session& session, uint32_t step, double& quickest) {
  const double begin = nowSeconds();
  if (Result<void> done = session.runSteps(step); !done) return done;
  quickest = std::min(quickest, nowSeconds() - begin);
  return {};
}

}  // namespace

Result<Ablation> measureAblation(vk::Device& device, const LoadedScene& loaded, SessionConfig config) {
  // Everything on comes second, so that its memory is what comes on top.
  Ablation ablation;
  ablation.technique = config.technique;
  Result<std::unique_ptr<BenchSession>> needed = BenchSession::create(device, loaded, config);
  if (!needed) return needed.error();
  const Result<double> ofNeeded = megabytesHeld(***needed);
  if (!ofNeeded) return ofNeeded.error();
  config.allNeeds = true;
  Result<std::unique_ptr<BenchSession>> all = BenchSession::create(device, loaded, config);
  if (!all) return all.error();
  const Result<double> ofBoth = megabytesHeld(***all);
  if (!ofBoth) return ofBoth.error();
  ablation.needed.megabytes = *ofNeeded;
  ablation.all.megabytes = *ofBoth - *ofNeeded;

  ablation.needed.stepSeconds = ablation.all.stepSeconds = std::numeric_limits<double>::infinity();
  for (Session* session : {&***needed, &***all})
    if (Result<void> done = session->runSteps(kFirstSteps); !done) return done.error();
  for (uint32_t step = kFirstSteps + 1; step <= kFirstSteps + kAblationRounds; ++step) {
    if (Result<void> done = timeStep(***needed, step, ablation.needed.stepSeconds); !done) return done.error();
    if (Result<void> done = timeStep(***all, step, ablation.all.stepSeconds); !done) return done.error();
  }
  return ablation;
}

}  // namespace limn::bench
