#include "server/flow_control.hpp"

#include <algorithm>
#include <numeric>

namespace limn::server {
namespace {

constexpr double kDelayWindow = 10.0;      ///< [s] over which the shortest delay is kept: a queue must not hide itself
constexpr double kSmoothing = 0.3;
constexpr double kFreeLagMs = 20.0;        ///< [ms] of lag that cost no quality
constexpr double kLagMsPerQuality = 2.0;
constexpr int kMovingQuality = 75, kLeastQuality = 45, kQualityStep = 10;  ///< few values, so that clients share bytes
constexpr uint8_t kConvergingQuality = 90;
constexpr double kCongestedLag = 0.2;      ///< [s] above it a converging picture is sent as a moving one

uint8_t movingQuality(double lagSeconds) {
  const double wanted = kMovingQuality - (lagSeconds * 1e3 - kFreeLagMs) / kLagMsPerQuality;
  const int clamped = std::clamp(int(wanted), kLeastQuality, kMovingQuality);
  return uint8_t(kMovingQuality - (kMovingQuality - clamped + kQualityStep - 1) / kQualityStep * kQualityStep);
}

}  // namespace

size_t FlowControl::bytesInFlight() const {
  return std::accumulate(m_inFlight.begin(), m_inFlight.end(), size_t(0),
                         [](size_t sum, const Sent& s) { return sum + s.bytes; });
}

void FlowControl::sent(uint32_t frameId, size_t bytes, double now) {
  m_inFlight.push_back({frameId, bytes, now});
  m_newestSent = frameId;
}

FlowControl::Ack FlowControl::acknowledged(uint32_t frameId, double now) {
  const auto found =
      std::find_if(m_inFlight.begin(), m_inFlight.end(), [&](const Sent& s) { return s.frameId == frameId; });
  if (found == m_inFlight.end()) return frameId > m_newestSent || m_newestSent == 0 ? Ack::neverSent : Ack::old;
  const double delay = now - found->at;
  m_inFlight.erase(found);
  while (!m_delays.empty() && m_delays.back().seconds >= delay) m_delays.pop_back();
  m_delays.push_back({now, delay});
  m_lag += kSmoothing * (delay - shortestDelay(now) - m_lag);
  return Ack::taken;
}

double FlowControl::shortestDelay(double now) {
  while (m_delays.size() > 1 && now - m_delays.front().at > kDelayWindow) m_delays.pop_front();
  return m_delays.front().seconds;
}

bool FlowControl::overdue(double now, double seconds) const {
  if (m_inFlight.empty()) return false;
  return now - m_inFlight.front().at > seconds + double(bytesInFlight()) / kSlowBytesPerSecond;
}

EncodingKey FlowControl::encodingFor(Phase phase, bool takesJpeg, bool takesPng) const {
  if (takesPng && (phase == Phase::converged || !takesJpeg)) return kLossless;
  const bool moving = phase == Phase::coarse || (phase == Phase::converging && m_lag > kCongestedLag);
  if (moving) return {ImageCodec::jpeg, movingQuality(m_lag), false};
  return {ImageCodec::jpeg, kConvergingQuality, true};
}

}  // namespace limn::server
