#include "renderer/gpu/environment_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "renderer/gpu/alias_table.hpp"

namespace limn::gpu {
namespace {

constexpr uint32_t kMaxWidth = 512, kMaxHeight = 256;

/// Luminance of each texel, raised to what its neighbours shine: the bilinear filter spreads a texel over them, and no
/// direction that shines may have probability 0.
std::vector<float> spreadLuminance(const Image& image) {
  const uint32_t w = image.width, h = image.height;
  std::vector<float> own(size_t(w) * h), spread(size_t(w) * h);
  for (size_t i = 0; i < own.size(); ++i) {
    const float* t = &image.rgbaF[i * 4];
    own[i] = 0.2126f * t[0] + 0.7152f * t[1] + 0.0722f * t[2];
  }
  for (uint32_t y = 0; y < h; ++y)
    for (uint32_t x = 0; x < w; ++x) {
      float sum = 0.0f;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          sum += own[size_t(std::clamp(int(y) + dy, 0, int(h) - 1)) * w + (x + w + uint32_t(dx)) % w];
      spread[size_t(y) * w + x] = 0.5f * own[size_t(y) * w + x] + sum / 18.0f;
    }
  return spread;
}

}  // namespace

glm::uvec2 environmentCells(const Image& image) {
  return {std::clamp(image.width, 1u, kMaxWidth), std::clamp(image.height / 2, 1u, kMaxHeight)};
}

EnvironmentTable buildEnvironmentTable(const Scene& scene) {
  EnvironmentTable table;
  if (!scene.environment.image) return table;
  const Image& image = *scene.environment.image;
  const glm::uvec2 cells = environmentCells(image);
  table.width = cells.x;
  table.height = cells.y;
  const std::vector<float> luminance = spreadLuminance(image);

  std::vector<double> weights(size_t(table.width) * table.height, 0.0);
  for (uint32_t y = 0; y < image.height; ++y) {
    // The texel row reaches half a row further on both sides, for the filter does.
    const double top = std::cos(std::max(0.0, y - 0.5) / image.height * std::numbers::pi);
    const double bottom = std::cos(std::min(double(image.height), y + 1.5) / image.height * std::numbers::pi);
    const double first = (1.0 - top) * 0.5 * table.height, last = (1.0 - bottom) * 0.5 * table.height;
    for (uint32_t row = uint32_t(first); row < table.height && row < last; ++row) {
      const double share = std::min(last, row + 1.0) - std::max(first, double(row));
      for (uint32_t x = 0; x < image.width; ++x)
        weights[size_t(row) * table.width + size_t(x) * table.width / image.width] += share * luminance[size_t(y) * image.width + x];
    }
  }
  // A cell at the seam of two texels shines with both; the floor covers what the binning above put next door.
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  for (double& weight : weights) weight += 1e-3 * sum / double(weights.size());

  for (const AliasEntry& entry : buildAliasTable(weights))
    table.entries.push_back({std::bit_cast<uint32_t>(entry.share), entry.alias, std::bit_cast<uint32_t>(entry.probability), 0u});
  return table;
}

}  // namespace limn::gpu
