#pragma once
#include <algorithm>
#include <cstdint>

namespace limn {

/// How many items of work fit into a time, from what earlier quanta took.
class WorkRate {
 public:
  /// At a time: as workgroups of 64 half of the 65,535 that every device runs in one dispatch.
  static constexpr double kMostItems = 1 << 21;

  explicit WorkRate(double initialPerSecond) : m_perSecond(initialPerSecond) {}
  void measured(uint64_t items, double seconds) {
    if (items == 0 || seconds <= 0.0) return;
    const double rate = double(items) / seconds;
    // Small quanta are mostly overhead and say little; large ones are believed at once.
    const double trust = std::clamp(seconds / 0.01, 0.05, 0.5);
    m_perSecond += trust * (rate - m_perSecond);
  }
  uint64_t itemsIn(double seconds) const { return uint64_t(std::clamp(m_perSecond * seconds, 1.0, kMostItems)); }
  double secondsFor(uint64_t items) const { return double(items) / m_perSecond; }

 private:
  double m_perSecond;
};

}  // namespace limn
