#include "renderer/cache/sample_elimination.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/base/check.hpp"
#include "renderer/cache/point_cells.hpp"

namespace limn {
namespace {

constexpr uint32_t kEnd = ~0u;
constexpr float kSightCosine = -0.2f;    // of normals; faces of a thin plate leave each other alone
constexpr double kMaxCrowding = 40.0;    // candidates a cell; more only where sheets lie in one place
constexpr uint32_t kBuckets = 4096;      // of crowdedness

bool seeEachOther(const SurfaceCandidate& a, const SurfaceCandidate& b) { return glm::dot(a.normal, b.normal) > kSightCosine; }

std::vector<glm::vec3> positionsOf(std::span<const SurfaceCandidate> candidates) {
  std::vector<glm::vec3> positions(candidates.size());
  for (size_t i = 0; i < candidates.size(); ++i) positions[i] = candidates[i].position;
  return positions;
}

/// Cells as wide as points reach. Where many sheets lie in one place the reach is cut, so that work stays linear.
PointCells cellsFor(std::span<const glm::vec3> positions, float& reach) {
  for (;;) {
    PointCells cells(positions, reach);
    if (cells.crowding() <= kMaxCrowding || reach == 0.0f) return cells;
    reach = reach > 1e-9f ? reach * 0.7f : 0.0f;
  }
}

/// Candidates in the order of their cells, with what takes them away.
class Elimination {
 public:
  Elimination(std::span<const SurfaceCandidate> candidates, const EliminationGoal& goal)
      : m_reach(float(2.0 * goal.maxRadius)), m_cells(cellsFor(positionsOf(candidates), m_reach)) {
    m_cells.findNeighbours();
    const double kept = double(goal.most) / double(candidates.size());
    m_floor = m_reach * float(0.65 * (1.0 - std::pow(kept, 1.5)));  // [Yuksel 2015, eq. 4]
    m_inverseReach = m_reach > 0.0f ? 1.0f / m_reach : 0.0f;
    m_sorted.reserve(candidates.size());
    for (const uint32_t i : m_cells.order()) m_sorted.push_back(candidates[i]);
    m_cellOf.resize(candidates.size());
    for (uint32_t c = 0; c < m_cells.cellCount(); ++c) std::fill(&m_cellOf[m_cells.begin(c)], m_cellOf.data() + m_cells.end(c), c);
    weighAll();
  }

  std::vector<uint32_t> run(const EliminationGoal& goal) {
    std::vector<uint32_t> tail;
    fillBuckets();
    for (size_t left = m_sorted.size(); left > goal.least; --left) {
      const uint32_t worst = takeWorst();
      m_gone[worst] = 1;
      forNeighbours(worst, [&](uint32_t j, float weight) { m_weights[j] -= weight; });
      if (left <= goal.most) tail.push_back(m_cells.order()[worst]);
    }
    std::vector<uint32_t> kept;
    for (size_t i = 0; i < m_sorted.size(); ++i)
      if (!m_gone[i]) kept.push_back(m_cells.order()[i]);
    kept.insert(kept.end(), tail.rbegin(), tail.rend());
    return kept;
  }

 private:
  /// Calls f(j, weight) for all candidates in reach that are still there, i itself excepted. [Yuksel 2015, eq. 2]
  template <class F>
  void forNeighbours(uint32_t i, const F& f) const {
    const SurfaceCandidate& a = m_sorted[i];
    for (const uint32_t cell : m_cells.neighbours(m_cellOf[i]))
      for (uint32_t j = m_cells.begin(cell); j < m_cells.end(cell); ++j) {
        const glm::vec3 apart = m_sorted[j].position - a.position;
        const float squared = glm::dot(apart, apart);
        if (squared >= m_reach * m_reach || m_gone[j] || j == i || !seeEachOther(a, m_sorted[j])) continue;
        const float closeness = 1.0f - std::max(std::sqrt(squared), m_floor) * m_inverseReach;
        const float p2 = closeness * closeness, p4 = p2 * p2;
        f(j, p4 * p4);
      }
  }

  void weighAll() {
    m_gone.assign(m_sorted.size(), 0);
    m_weights.assign(m_sorted.size(), 0.0f);
    for (uint32_t i = 0; i < m_sorted.size(); ++i) {
      float sum = 0.0f;
      forNeighbours(i, [&](uint32_t, float weight) { sum += weight; });
      m_weights[i] = sum;
    }
  }

  uint32_t bucketOf(uint32_t i) const { return uint32_t(std::clamp(m_weights[i] * m_perWeight, 0.0f, float(kBuckets - 1))); }

  void fillBuckets() {
    const float most = *std::max_element(m_weights.begin(), m_weights.end());
    m_perWeight = most > 0.0f ? float(kBuckets - 1) / most : 0.0f;
    m_first.assign(kBuckets, kEnd);
    m_next.assign(m_sorted.size(), kEnd);
    m_top = kBuckets - 1;
    for (uint32_t i = 0; i < m_sorted.size(); ++i) put(i);
  }

  void put(uint32_t i) {
    const uint32_t bucket = bucketOf(i);
    m_next[i] = m_first[bucket];
    m_first[bucket] = i;
  }

  /// Weights only fall, so a candidate is looked at again when the bucket it was put in comes to be the top one.
  uint32_t takeWorst() {
    for (;;) {
      while (m_first[m_top] == kEnd) --m_top;
      const uint32_t i = m_first[m_top];
      m_first[m_top] = m_next[i];
      if (bucketOf(i) == m_top) return i;
      put(i);
    }
  }

  float m_reach, m_floor = 0.0f, m_inverseReach = 0.0f, m_perWeight = 0.0f;
  PointCells m_cells;
  std::vector<SurfaceCandidate> m_sorted;
  std::vector<uint32_t> m_cellOf, m_first, m_next;
  std::vector<float> m_weights;
  std::vector<uint8_t> m_gone;
  uint32_t m_top = 0;
};

}  // namespace

std::vector<uint32_t> eliminateSamples(std::span<const SurfaceCandidate> candidates, const EliminationGoal& goal) {
  LIMN_CHECK_LE(goal.least, goal.most);
  LIMN_CHECK_LE(size_t(goal.most), candidates.size());
  if (candidates.empty()) return {};
  return Elimination(candidates, goal).run(goal);
}

double smallestDistance(std::span<const SurfaceCandidate> points, double limit) {
  const std::vector<glm::vec3> positions = positionsOf(points);
  float reach = float(limit);
  PointCells cells = cellsFor(positions, reach);
  cells.findNeighbours();
  float smallest = reach * reach;
  for (uint32_t c = 0; c < cells.cellCount(); ++c)
    for (const uint32_t other : cells.neighbours(c)) {
      if (other < c) continue;
      for (uint32_t a = cells.begin(c); a < cells.end(c); ++a)
        for (uint32_t b = other == c ? a + 1 : cells.begin(other); b < cells.end(other); ++b) {
          const SurfaceCandidate &p = points[cells.order()[a]], &q = points[cells.order()[b]];
          const glm::vec3 apart = p.position - q.position;
          const float squared = glm::dot(apart, apart);
          if (squared < smallest && seeEachOther(p, q)) smallest = squared;
        }
    }
  return std::min(limit, double(std::sqrt(smallest)));
}

}  // namespace limn
