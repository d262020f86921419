#pragma once
#include <cstdint>
#include <deque>

#include "server/encoders.hpp"

namespace limn::server {

/// The frames of one client between sending and acknowledgement. A client that shows frames late is sent smaller ones.
/// Loop thread; times are nowSeconds().
class FlowControl {
 public:
  static constexpr size_t kFramesInFlight = 2;
  static constexpr double kSlowBytesPerSecond = 65536.0;
  enum class Ack { taken, old, neverSent };

  bool hasCredit() const { return m_inFlight.size() < kFramesInFlight; }
  size_t inFlight() const { return m_inFlight.size(); }
  size_t bytesInFlight() const;

  /// `bytes` are those of the frame and of whatever the client has to take in before it.
  void sent(uint32_t frameId, size_t bytes, double now);
  /// A frame is acknowledged after it was shown or dropped. Credits come back one a frame; `old` for one twice
  /// acknowledged.
  Ack acknowledged(uint32_t frameId, double now);
  /// Whether the oldest frame in flight should have been acknowledged: within `seconds` and the time that all bytes in
  /// flight take over a slow line, since one picture at rest may be many megabytes.
  bool overdue(double now, double seconds) const;
  /// [s] from sending a frame to its acknowledgement, beyond the shortest one seen of late; smoothed.
  double lag() const { return m_lag; }

  /// How a picture is encoded for this client.
  EncodingKey encodingFor(Phase phase, bool takesJpeg, bool takesPng) const;

 private:
  struct Sent { uint32_t frameId = 0; size_t bytes = 0; double at = 0.0; };
  struct Delay { double at = 0.0, seconds = 0.0; };
  double shortestDelay(double now);

  std::deque<Sent> m_inFlight;
  std::deque<Delay> m_delays;   ///< of the last kDelayWindow seconds, rising: the front is the least
  uint32_t m_newestSent = 0;
  double m_lag = 0.0;
};

}  // namespace limn::server
