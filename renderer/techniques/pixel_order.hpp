#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace limn {

/// All pixels of a picture in the order of the first pass: those of the grid of stride 8 first, then of 4, 2 and 1, each in
/// tiles of Morton order. A coarse picture exists after 1/64 of the pass, and no sample is thrown away for it.
struct PixelOrder {
  static constexpr std::array<uint32_t, 4> kStrides{8, 4, 2, 1};
  std::vector<uint32_t> pixels;              ///< y * width + x
  std::array<uint32_t, 4> levelEnd{};        ///< entries at which the grid of kStrides[i] is complete
};
PixelOrder makePixelOrder(uint32_t width, uint32_t height);

}  // namespace limn
