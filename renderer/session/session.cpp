#include "renderer/session/session.hpp"

#include <algorithm>

#include "renderer/base/clock.hpp"
#include "renderer/session/session_impl.hpp"

namespace limn {

Session::Session(std::unique_ptr<Impl> impl) : m_impl(std::move(impl)) {}
Session::~Session() = default;

Result<std::unique_ptr<Session>> Session::create(vk::Device& device, Scene scene, LoadReport report, const SessionConfig& config,
                                                 Mailbox& mailbox, FrameSlot& frames, StatusQueue& replies) {
  auto impl = std::make_unique<Impl>(device, mailbox, frames, replies);
  if (auto ready = impl->init(std::move(scene), std::move(report), config); !ready) return ready.error();
  return std::unique_ptr<Session>(new Session(std::move(impl)));
}

Result<bool> Session::step() {
  Impl& s = *m_impl;
  // At least one picture of every state is shown to who watches, or dragging would show nothing.
  if (s.frameOfState || s.idle() || !s.watched)
    if (auto done = s.drainMailbox(); !done) return done.error();
  const bool warmUp = s.warmUpIsDue();
  if (s.idle() && !s.frameIsDue(nowSeconds()) && !warmUp) return s.tailorAtRest();
  if (!s.idle())
    if (auto done = s.work(s.config.quantumSeconds); !done) return done.error();
  if (auto done = s.answerWaits(); !done) return done.error();
  if (auto done = s.publishIfDue(); !done) return done.error();
  if (warmUp)
    if (auto done = s.warmUpOnePipeline(); !done) return done.error();
  return true;
}

Result<void> Session::Impl::work(double seconds) {
  if (auditIsDue(seconds)) return auditFor(seconds);
  const double begin = nowSeconds();
  auto made = technique->advance(context(), seconds);
  if (!made) return made.error();
  progress = *made;
  knownHash.reset();
  const double spent = nowSeconds() - begin;
  sampledSeconds += spent;
  auditOwed += spent * auditShare() / (1.0 - auditShare());
  newSamples = true;
  ++status.quanta;
  return made->passFinished ? auditPass() : Result<void>{};
}

Result<void> Session::runSteps(uint32_t steps) {
  Impl& s = *m_impl;
  if (auto done = s.drainMailbox(); !done) return done;
  while (s.progress.passes < steps && !s.progress.converged)
    if (auto done = s.work(s.config.quantumSeconds); !done) return done;
  return {};
}

Result<void> Session::runSeconds(double seconds) {
  Impl& s = *m_impl;
  const double end = nowSeconds() + seconds;
  if (auto done = s.drainMailbox(); !done) return done;
  for (double left = seconds; left > 0.0 && !s.progress.converged; left = end - nowSeconds())
    if (auto done = s.work(std::min(s.config.quantumSeconds, left)); !done) return done;
  return {};
}

Result<void> Session::run() {
  constexpr double kSleep = 1.0;  // only a bound: mail wakes the thread at once
  while (!m_impl->mailbox.closed()) {
    auto worked = step();
    if (!worked) return worked.error();
    if (!*worked) m_impl->mailbox.waitFor(kSleep);
  }
  return {};
}

Result<Status> Session::status() {
  if (auto done = m_impl->estimateError(); !done) return done.error();
  m_impl->refreshStatus();
  return m_impl->status;
}

Result<uint64_t> Session::filmHash() { return m_impl->film->hash(m_impl->device); }
Result<FilmImage> Session::readFilm() { return m_impl->readFilm(); }
Result<std::shared_ptr<const Frame>> Session::resolveFrame() {
  if (auto done = m_impl->estimateError(); !done) return done.error();
  return m_impl->makeFrame();
}
const Scene& Session::scene() const { return m_impl->scene; }
const Technique& Session::technique() const { return *m_impl->technique; }
bool Session::warm() const { return m_impl->coldTechniques.empty(); }

}  // namespace limn
