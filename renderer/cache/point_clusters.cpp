#include "renderer/cache/point_clusters.hpp"

#include <algorithm>
#include <bit>

#include "renderer/base/check.hpp"
#include "renderer/cache/parallel_for.hpp"

namespace limn {
namespace {

constexpr float kFlat = 0.25f;         // share of the longest side under which an axis is passed over
constexpr uint32_t kSerialLevels = 3;  // splits before the groups go to the cores
constexpr uint32_t kMortonBits = 10;   // an axis

struct Item {
  glm::vec3 position;
  uint32_t index;
};
using Group = std::span<Item>;

struct Box {
  glm::vec3 low{3.0e38f}, high{-3.0e38f};
  explicit Box(Group group) {
    for (const Item& item : group) low = glm::min(low, item.position), high = glm::max(high, item.position);
  }
  glm::vec3 size() const { return high - low; }
};

int longestAxis(const glm::vec3& size) {
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

int axisAfter(int last, const glm::vec3& size) {
  const int longest = longestAxis(size);
  if (last < 0) return longest;
  for (int step = 1; step < 3; ++step) {
    const int axis = (last + step) % 3;
    if (size[axis] >= kFlat * size[longest]) return axis;
  }
  return longest;
}

/// Halves the group and gives the axis.
int split(Group group, int lastAxis) {
  const int axis = axisAfter(lastAxis, Box(group).size());
  std::nth_element(group.begin(), group.begin() + std::ptrdiff_t(group.size() / 2), group.end(),
                   [axis](const Item& a, const Item& b) {
                     return a.position[axis] != b.position[axis] ? a.position[axis] < b.position[axis]
                                                                 : a.index < b.index;
                   });
  return axis;
}

uint32_t spreadBits(uint32_t v) {
  v = (v | v << 16) & 0x030000ffu;
  v = (v | v << 8) & 0x0300f00fu;
  v = (v | v << 4) & 0x030c30c3u;
  return (v | v << 2) & 0x09249249u;
}

uint32_t reversedBits(uint32_t v, int bits) {
  uint32_t reversed = 0;
  for (int b = 0; b < bits; ++b) reversed |= (v >> b & 1u) << (bits - 1 - b);
  return reversed;
}

/// Orders a cluster so that its first points, however many, are spread over it. On a plane a fifth of the Morton curve
/// is a third of either side of the cell, at every level of the curve: the points that are picked stand inside their
/// cells, not at corners.
void orderCluster(Group cluster, std::span<uint32_t> out) {
  const Box box(cluster);
  const glm::vec3 size = box.size();
  const float longest = size[longestAxis(size)];
  const float scale = longest > 0.0f ? float((1u << kMortonBits) - 1) / longest : 0.0f;
  std::vector<uint64_t> keys;
  keys.reserve(cluster.size());
  for (const Item& item : cluster) {
    const glm::vec3 cell = (item.position - box.low) * scale;
    const uint32_t code =
        spreadBits(uint32_t(cell.x)) | spreadBits(uint32_t(cell.y)) << 1 | spreadBits(uint32_t(cell.z)) << 2;
    keys.push_back(uint64_t(code) << 32 | item.index);
  }
  std::sort(keys.begin(), keys.end());
  const int bits = std::bit_width(cluster.size() - 1);
  size_t written = 0;
  for (uint32_t i = 0; i < 1u << bits; ++i) {
    const uint32_t j = reversedBits(i, bits);
    if (j < keys.size()) out[written++] = uint32_t(keys[(j + keys.size() / 5) % keys.size()]);
  }
}

/// Splits `group` `levels` times over and orders what comes out; `out` is the group's part of the answer.
void clusterGroup(Group group, uint32_t levels, int lastAxis, std::span<uint32_t> out) {
  if (levels == 0) return orderCluster(group, out);
  const int axis = split(group, lastAxis);
  const size_t half = group.size() / 2;
  clusterGroup(group.first(half), levels - 1, axis, out.first(half));
  clusterGroup(group.subspan(half), levels - 1, axis, out.subspan(half));
}

}  // namespace

std::vector<uint32_t> clusterPoints(std::span<const glm::vec3> points, uint32_t clusters) {
  LIMN_CHECK(std::has_single_bit(clusters));
  LIMN_CHECK_EQ(points.size() % clusters, 0u);
  std::vector<uint32_t> order(points.size());
  if (points.empty()) return order;
  std::vector<Item> items(points.size());
  for (uint32_t i = 0; i < items.size(); ++i) items[i] = {points[i], i};

  struct Part {
    Group group;
    int axis;
    std::span<uint32_t> out;
  };
  std::vector<Part> parts{{items, -1, order}};
  uint32_t levels = uint32_t(std::countr_zero(clusters));
  for (uint32_t level = 0; level < kSerialLevels && levels > 0; ++level, --levels) {
    std::vector<Part> halves(parts.size() * 2);
    parallelFor(parts.size(), [&](size_t i) {
      const auto [group, last, out] = parts[i];
      const int axis = split(group, last);
      const size_t half = group.size() / 2;
      halves[2 * i] = {group.first(half), axis, out.first(half)};
      halves[2 * i + 1] = {group.subspan(half), axis, out.subspan(half)};
    });
    parts = std::move(halves);
  }
  parallelFor(parts.size(), [&](size_t i) { clusterGroup(parts[i].group, levels, parts[i].axis, parts[i].out); });
  return order;
}

}  // namespace limn
