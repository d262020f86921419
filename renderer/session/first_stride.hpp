#pragma once
#include <cstdint>

namespace limn {

constexpr uint32_t kCoarsestStride = 8;  ///< [pixel]

/// The grid of the first picture after an edit: every `stride`-th pixel of every `stride`-th row. It becomes twice as
/// coarse when the picture would be more than 30 % late, and twice as fine when the finer one comes with 20 % to spare;
/// between the two nothing changes, so that it does not flicker. At most one step a restart. `secondsTo(stride)` is the
/// time to that grid at the measured rate [s], `wanted` the time in which the picture has to come [s].
template <class SecondsTo>
uint32_t nextFirstStride(uint32_t stride, double wanted, SecondsTo&& secondsTo) {
  if (stride < kCoarsestStride && secondsTo(stride) > 1.3 * wanted) return 2 * stride;
  if (stride > 1 && secondsTo(stride / 2) <= 0.8 * wanted) return stride / 2;
  return stride;
}

}  // namespace limn
