#include "renderer/techniques/pixel_order.hpp"

#include <algorithm>
#include <bit>

namespace limn {
namespace {

uint32_t spreadBits(uint32_t x) {
  x = (x | (x << 8)) & 0x00ff00ffu;
  x = (x | (x << 4)) & 0x0f0f0f0fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

}  // namespace

PixelOrder makePixelOrder(uint32_t width, uint32_t height) {
  PixelOrder order;
  order.pixels.reserve(size_t(width) * height);
  std::vector<std::pair<uint32_t, uint32_t>> level;  // Morton code, pixel
  for (size_t i = 0; i < PixelOrder::kStrides.size(); ++i) {
    const uint32_t stride = PixelOrder::kStrides[i];
    level.clear();
    for (uint32_t y = 0; y < height; y += stride)
      for (uint32_t x = 0; x < width; x += stride) {
        const bool onCoarser = i > 0 && x % (2 * stride) == 0 && y % (2 * stride) == 0;
        if (!onCoarser) level.push_back({spreadBits(x / stride) | spreadBits(y / stride) << 1, y * width + x});
      }
    std::sort(level.begin(), level.end());
    for (const auto& [code, pixel] : level) order.pixels.push_back(pixel);
    order.levelEnd[i] = uint32_t(order.pixels.size());
  }
  return order;
}

}  // namespace limn
