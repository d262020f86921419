#include "renderer/cache/point_clusters.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "renderer/base/check.hpp"
#include "renderer/cache/parallel_for.hpp"

namespace limn {
namespace {

constexpr float kFlat = 0.25f;         // share of the longest side under which an axis is passed over
constexpr uint32_t kSerialLevels = 3;  // splits before the groups go to the cores
constexpr uint32_t kMortonBits = 10;   // an axis
constexpr size_t kCountedSize = 2048;  // groups of fewer items are halved by comparisons alone
constexpr uint32_t kBins = 1024;       // along an axis

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

/// Bins of equal width along an axis: an item in a lower bin than another has the smaller coordinate.
class Bins {
 public:
  Bins(const Box& box, int axis) : m_axis(axis), m_low(box.low[axis]), m_perUnit(float(kBins) / box.size()[axis]) {}
  /// Not where all lie in one place, or so near that the width has no reciprocal.
  bool usable() const { return m_perUnit > 0.0f && std::isfinite(m_perUnit); }
  uint32_t operator()(const Item& item) const {
    return std::min(uint32_t((item.position[m_axis] - m_low) * m_perUnit), kBins - 1);
  }

 private:
  int m_axis;
  float m_low, m_perUnit;
};

void selectSmallest(Group group, size_t count, int axis) {
  std::nth_element(group.begin(), group.begin() + std::ptrdiff_t(count), group.end(),
                   [axis](const Item& a, const Item& b) {
                     return a.position[axis] != b.position[axis] ? a.position[axis] < b.position[axis]
                                                                 : a.index < b.index;
                   });
}

/// Brings the smaller half of the group to the front of what is given back: `group` or `spare`, which is as long. Items
/// are counted into bins, which no branch depends on; only those in the median's bin are compared.
Group halved(Group group, Group spare, const Box& box, int axis) {
  const size_t half = group.size() / 2;
  const Bins binOf(box, axis);
  if (group.size() < kCountedSize || !binOf.usable()) {
    selectSmallest(group, half, axis);
    return group;
  }
  std::array<uint32_t, kBins> counts{};
  for (const Item& item : group) ++counts[binOf(item)];
  uint32_t median = 0;
  size_t before = 0;
  while (before + counts[median] <= half) before += counts[median++];
  std::array<size_t, 3> next{0, before, before + counts[median]};  // lower bins, the median's, higher ones
  for (const Item& item : group) {
    const uint32_t bin = binOf(item);
    spare[next[size_t(bin >= median) + size_t(bin > median)]++] = item;
  }
  selectSmallest(spare.subspan(before, counts[median]), half - before, axis);
  return spare;
}

/// A group on its way to clusters.
struct Part {
  Group group, spare;       // the items, and as much room
  int lastAxis;             // it was split along; -1: none yet
  std::span<uint32_t> out;  // its part of the answer
};

std::array<Part, 2> split(const Part& part) {
  const Box box(part.group);
  const int axis = axisAfter(part.lastAxis, box.size());
  const Group group = halved(part.group, part.spare, box, axis);
  const Group spare = group.data() == part.group.data() ? part.spare : part.group;
  const size_t half = group.size() / 2;
  return {Part{group.first(half), spare.first(half), axis, part.out.first(half)},
          Part{group.subspan(half), spare.subspan(half), axis, part.out.subspan(half)}};
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

/// Splits the part `levels` times over and orders what comes out.
void clusterPart(const Part& part, uint32_t levels) {
  if (levels == 0) return orderCluster(part.group, part.out);
  for (const Part& half : split(part)) clusterPart(half, levels - 1);
}

}  // namespace

std::vector<uint32_t> clusterPoints(std::span<const glm::vec3> points, uint32_t clusters) {
  LIMN_CHECK(std::has_single_bit(clusters));
  LIMN_CHECK_EQ(points.size() % clusters, 0u);
  std::vector<uint32_t> order(points.size());
  if (points.empty()) return order;
  std::vector<Item> items(points.size());
  for (uint32_t i = 0; i < items.size(); ++i) items[i] = {points[i], i};

  std::vector<Item> room(items.size());
  std::vector<Part> parts{{items, room, -1, order}};
  uint32_t levels = uint32_t(std::countr_zero(clusters));
  for (uint32_t level = 0; level < kSerialLevels && levels > 0; ++level, --levels) {
    std::vector<Part> halves(parts.size() * 2);
    parallelFor(parts.size(), [&](size_t i) {
      const std::array<Part, 2> both = split(parts[i]);
      std::copy(both.begin(), both.end(), halves.begin() + std::ptrdiff_t(2 * i));
    });
    parts = std::move(halves);
  }
  parallelFor(parts.size(), [&](size_t i) { clusterPart(parts[i], levels); });
  return order;
}

}  // namespace limn
