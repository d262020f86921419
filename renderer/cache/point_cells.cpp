#include "renderer/cache/point_cells.hpp"

#include <algorithm>
#include <bit>

namespace limn {
namespace {

constexpr uint32_t kEmpty = ~0u;
constexpr float kMinSide = 1.0f / float(1 << 20);
constexpr uint64_t kStepX = 1, kStepY = uint64_t(1) << 21, kStepZ = uint64_t(1) << 42;

uint64_t slotOf(uint64_t key) {
  key *= 0x9e3779b97f4a7c15ull;
  return key ^ key >> 32;
}

/// Coordinates count from 1, so that a step down stays above zero.
uint64_t keyOf(const glm::vec3& p, float perSide) {
  const glm::vec3 cell = glm::clamp(p, 0.0f, 1.0f) * perSide;
  return (uint64_t(cell.x) + 1) * kStepX + (uint64_t(cell.y) + 1) * kStepY + (uint64_t(cell.z) + 1) * kStepZ;
}

uint64_t spreadBits(uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

/// Place on the Morton curve.
uint64_t alongCurve(uint64_t key) { return spreadBits(key) | spreadBits(key >> 21) << 1 | spreadBits(key >> 42) << 2; }

}  // namespace

PointCells::PointCells(std::span<const glm::vec3> points, float side) {
  const float perSide = 1.0f / std::max(side, kMinSide);
  m_table.assign(std::bit_ceil(points.size() + points.size() / 2 + 1), kEmpty);
  const uint64_t mask = m_table.size() - 1;
  std::vector<uint32_t> cellOf(points.size()), counts;
  for (size_t i = 0; i < points.size(); ++i) {
    const uint64_t key = keyOf(points[i], perSide);
    uint64_t slot = slotOf(key) & mask;
    while (m_table[slot] != kEmpty && m_keys[m_table[slot]] != key) slot = (slot + 1) & mask;
    if (m_table[slot] == kEmpty) {
      m_table[slot] = uint32_t(m_keys.size());
      m_keys.push_back(key);
      counts.push_back(0);
    }
    cellOf[i] = m_table[slot];
    ++counts[cellOf[i]];
  }
  sortCells(cellOf, counts);
  m_start.assign(m_keys.size() + 1, 0);
  for (size_t c = 0; c < counts.size(); ++c) m_start[c + 1] = m_start[c] + counts[c];
  std::vector<uint32_t> cursor(m_start.begin(), m_start.end() - 1);
  m_order.resize(points.size());
  for (size_t i = 0; i < points.size(); ++i) m_order[cursor[cellOf[i]]++] = uint32_t(i);
}

/// Renumbers the cells along a curve that stays near where it is, so that neighbours are near in memory too.
void PointCells::sortCells(std::vector<uint32_t>& cellOf, std::vector<uint32_t>& counts) {
  std::vector<std::pair<uint64_t, uint32_t>> curve(m_keys.size());
  for (uint32_t c = 0; c < curve.size(); ++c) curve[c] = {alongCurve(m_keys[c]), c};
  std::sort(curve.begin(), curve.end());
  std::vector<uint32_t> place(curve.size()), sortedCounts(curve.size());
  std::vector<uint64_t> sortedKeys(curve.size());
  for (uint32_t at = 0; at < curve.size(); ++at) {
    place[curve[at].second] = at;
    sortedKeys[at] = m_keys[curve[at].second];
    sortedCounts[at] = counts[curve[at].second];
  }
  for (uint32_t& cell : cellOf) cell = place[cell];
  for (uint32_t& cell : m_table)
    if (cell != kEmpty) cell = place[cell];
  m_keys = std::move(sortedKeys);
  counts = std::move(sortedCounts);
}

double PointCells::crowding() const {
  double sum = 0.0;
  for (uint32_t c = 0; c < cellCount(); ++c) {
    const double n = end(c) - begin(c);
    sum += n * n;
  }
  return m_order.empty() ? 0.0 : sum / double(m_order.size());
}

uint32_t PointCells::find(uint64_t key) const {
  const uint64_t mask = m_table.size() - 1;
  uint64_t slot = slotOf(key) & mask;
  while (m_table[slot] != kEmpty && m_keys[m_table[slot]] != key) slot = (slot + 1) & mask;
  return m_table[slot];
}

void PointCells::findNeighbours() {
  m_neighbours.clear();
  m_neighbourStart.assign(1, 0);
  for (const uint64_t key : m_keys) {
    for (uint64_t z = 0; z < 3; ++z)
      for (uint64_t y = 0; y < 3; ++y)
        for (uint64_t x = 0; x < 3; ++x) {
          const uint32_t cell = find(key + x * kStepX + y * kStepY + z * kStepZ - kStepX - kStepY - kStepZ);
          if (cell != kEmpty) m_neighbours.push_back(cell);
        }
    m_neighbourStart.push_back(uint32_t(m_neighbours.size()));
  }
}

}  // namespace limn
