#pragma once
#include <chrono>

namespace limn {

/// Monotonic time [s]. Any thread.
inline double nowSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace limn
