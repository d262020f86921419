#pragma once
#include <cstdint>

namespace limn {

/// A permutation of the 32-bit numbers in which every bit of `x` changes about half of the others; `hash` of
/// shaders/lib/sampling.glsl.
constexpr uint32_t mix32(uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

}  // namespace limn
