#include "renderer/cache/point_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "renderer/base/check.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"

namespace limn {
namespace {

constexpr double kMinReachShare = 1e-5;  // of the scene's size: cells stay few enough to count them in integers

glm::ivec3 cellOf(const glm::vec3& posR, const shared::PointGridInfo& info) {
  return glm::ivec3(glm::floor((posR - info.originR) * info.cellsPerM));
}

/// Calls f(point) for every point of the subset, lower slots first.
template <class F>
void forSubset(const PointSubset& subset, const F& f) {
  for (uint32_t slot = 0; slot < subset.slots; ++slot)
    for (size_t point = slot; point < subset.points.size(); point += subset.clusterSize) f(uint32_t(point));
}

/// Where cells start and how wide they are.
shared::PointGridInfo layOut(const PointSubset& subset, size_t count) {
  glm::vec3 low(3.0e38f), high(-3.0e38f);
  forSubset(subset, [&](uint32_t point) {
    low = glm::min(low, subset.points[point].posR);
    high = glm::max(high, subset.points[point].posR);
  });
  const double size = glm::length(glm::dvec3(high) - glm::dvec3(low));
  const double spacing = std::sqrt(subset.areaPerPoint * double(subset.points.size()) / double(count));
  const double radius = std::max(subset.reach * spacing, kMinReachShare * size);
  shared::PointGridInfo info{};
  info.originR = low;
  info.radius = radius > 0.0 ? float(radius) : 1.0f;
  info.cellsPerM = 0.5f / info.radius;
  info.bucketMask = uint32_t(std::bit_ceil(std::max<size_t>(count, 8))) - 1;
  return info;
}

/// Writes words to a texel buffer that is made anew when its size is another.
Result<void> write(vk::Device& device, vk::Buffer& buffer, const char* name, const std::vector<uint32_t>& words) {
  if (buffer && buffer.size() == words.size() * sizeof(uint32_t))
    return vk::uploadArray(device, buffer, std::span<const uint32_t>(words));
  vk::BufferDesc desc;
  desc.name = name;
  desc.owner = "surface-points";
  desc.usage = vk::BufferUsage::texel;
  desc.texelFormat = VK_FORMAT_R32_UINT;
  buffer = vk::Buffer();
  auto made = vk::createBufferWith(device, desc, std::span<const uint32_t>(words));
  if (!made) return made.error();
  buffer = made.take();
  return {};
}

}  // namespace

uint32_t bucketOf(const glm::ivec3& cell, uint32_t mask) {
  const glm::uvec3 block = glm::uvec3(cell >> 1) * glm::uvec3(0x8da6b343u, 0xd8163841u, 0xcb1ab31fu);
  uint32_t h = block.x ^ block.y ^ block.z;
  h ^= h >> 15;
  const glm::uvec3 parity(cell & 1);
  return (h << 3 | parity.z << 2 | parity.y << 1 | parity.x) & mask;
}

float pointWeight(const glm::vec3& apart, const glm::vec3& normal, float cosine, float radius) {
  const float near = std::max(1.0f - glm::dot(apart, apart) / (radius * radius), 0.0f);
  const float height = glm::dot(apart, normal) / (shared::kPointGridPlaneReach * radius);
  const float level = std::max(1.0f - height * height, 0.0f);
  return near * near * level * level * std::max(cosine, 0.0f);
}

PointGridData buildPointGrid(const PointSubset& subset) {
  PointGridData grid;
  if (subset.points.empty() || subset.slots == 0) {
    grid.info.radius = 1.0f;
    grid.info.bucketMask = 7;
    grid.starts.assign(9, 0);
    return grid;
  }
  LIMN_CHECK_LE(subset.slots, subset.clusterSize);
  const size_t count = subset.points.size() / subset.clusterSize * subset.slots;
  grid.info = layOut(subset, count);

  std::vector<uint32_t> buckets;
  buckets.reserve(count);
  grid.starts.assign(size_t(grid.info.bucketMask) + 2, 0);
  forSubset(subset, [&](uint32_t point) {
    buckets.push_back(bucketOf(cellOf(subset.points[point].posR, grid.info), grid.info.bucketMask));
    ++grid.starts[buckets.back() + 1];
  });
  for (size_t b = 1; b < grid.starts.size(); ++b) grid.starts[b] += grid.starts[b - 1];
  std::vector<uint32_t> cursor(grid.starts.begin(), grid.starts.end() - 1);
  grid.entries.resize(count);
  size_t next = 0;
  forSubset(subset, [&](uint32_t point) { grid.entries[cursor[buckets[next++]]++] = point; });
  return grid;
}

Result<void> PointGrid::update(vk::Device& device, const SurfacePoints& points, uint32_t slots, double reach) {
  PointGridData grid = buildPointGrid({points.points(), points.clusterSize(), slots, points.areaPerPoint(), reach});
  m_radius = grid.info.radius;
  std::vector<uint32_t> head(shared::kPointGridInfoWords);
  std::memcpy(head.data(), &grid.info, sizeof(grid.info));
  grid.starts.insert(grid.starts.begin(), head.begin(), head.end());
  if (grid.entries.empty()) grid.entries.push_back(0);
  if (auto done = write(device, m_starts, "pointGrid", grid.starts); !done) return done;
  return write(device, m_entries, "pointGridEntries", grid.entries);
}

std::vector<vk::Binding> PointGrid::bindings() const {
  return {vk::texel(BINDING_POINT_GRID, m_starts), vk::texel(BINDING_POINT_GRID_ENTRIES, m_entries)};
}

}  // namespace limn
