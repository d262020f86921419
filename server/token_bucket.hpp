#pragma once
#include <algorithm>

namespace limn::server {

/// Allows `rate` units a second on average and `burst` at once. May be overdrawn by one take; then it stays empty
/// longer.
class TokenBucket {
 public:
  TokenBucket(double rate, double burst) : m_rate(rate), m_burst(burst), m_tokens(burst) {}

  void take(double units, double now) {
    refill(now);
    m_tokens -= units;
  }
  bool empty(double now) {
    refill(now);
    return m_tokens <= 0.0;
  }

 private:
  void refill(double now) {
    if (m_last > 0.0) m_tokens = std::min(m_burst, m_tokens + (now - m_last) * m_rate);
    m_last = now;
  }

  double m_rate, m_burst, m_tokens;
  double m_last = 0.0;  ///< [s] of nowSeconds()
};

}  // namespace limn::server
