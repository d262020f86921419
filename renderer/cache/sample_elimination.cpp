#include "renderer/cache/sample_elimination.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/base/check.hpp"
#include "renderer/cache/parallel_for.hpp"
#include "renderer/cache/point_cells.hpp"

namespace limn {
namespace {

constexpr float kSightCosine = -0.2f;  // of normals; faces of a thin plate leave each other alone
constexpr double kMaxCrowding = 40.0;  // candidates a cell; more only where sheets lie in one place
constexpr uint32_t kBuckets = 1024;    // of crowdedness
constexpr size_t kPart = 32768;        // candidates thinned out as one, in a core's cache
constexpr size_t kChunk = 65536;       // candidates weighed by one core
constexpr double kRoughShare = 2.0;    // of the goal that parts leave

bool seeEachOther(const SurfaceCandidate& a, const SurfaceCandidate& b) {
  return glm::dot(a.normal, b.normal) > kSightCosine;
}

std::vector<glm::vec3> positionsOf(std::span<const SurfaceCandidate> candidates) {
  std::vector<glm::vec3> positions(candidates.size());
  for (size_t i = 0; i < candidates.size(); ++i) positions[i] = candidates[i].position;
  return positions;
}

std::vector<SurfaceCandidate> gathered(std::span<const SurfaceCandidate> candidates,
                                       std::span<const uint32_t> indices) {
  std::vector<SurfaceCandidate> result;
  result.reserve(indices.size());
  for (const uint32_t i : indices) result.push_back(candidates[i]);
  return result;
}

/// Cells as wide as points reach. Where many sheets lie in one place the reach is cut, so that work stays linear.
PointCells cellsFor(std::span<const glm::vec3> positions, float& reach) {
  for (;;) {
    PointCells cells(positions, reach);
    if (cells.crowding() <= kMaxCrowding || reach == 0.0f) return cells;
    reach = reach > 1e-9f ? reach * 0.7f : 0.0f;
  }
}

constexpr float kStraightCosine = 0.86f;  // three times the angle is less than that of kSightCosine

/// Candidates in the order of their cells, with what takes them away.
class Elimination {
 public:
  /// `kept`: share of all candidates that the goal is.
  Elimination(std::span<const SurfaceCandidate> candidates, double maxRadius, double kept)
      : m_reach(float(2.0 * maxRadius)), m_cells(cellsFor(positionsOf(candidates), m_reach)) {
    m_cells.findNeighbours();
    m_floor = m_reach * float(0.65 * (1.0 - std::pow(kept, 1.5)));  // [Yuksel 2015, eq. 4]
    m_inverseReach = m_reach > 0.0f ? 1.0f / m_reach : 0.0f;
    m_spots.reserve(candidates.size());
    m_normals.reserve(candidates.size());
    for (const uint32_t i : m_cells.order()) {
      m_spots.push_back({candidates[i].position, 0.0f});
      m_normals.push_back(candidates[i].normal);
    }
    m_cellOf.resize(candidates.size());
    for (uint32_t c = 0; c < m_cells.cellCount(); ++c)
      std::fill(&m_cellOf[m_cells.begin(c)], m_cellOf.data() + m_cells.end(c), c);
    findBentCells();
    weighAll();
  }

  /// Takes candidates away until `least` are left; gives those, then the ones taken after `most` were left, last one
  /// first.
  std::vector<uint32_t> run(size_t most, size_t least) {
    std::vector<uint32_t> tail;
    fillBuckets();
    for (size_t left = m_spots.size(); left > least; --left) {
      const uint32_t worst = takeWorst();
      forNeighbours(worst, [&](uint32_t j, float weight) { m_spots[j].weight -= weight; });
      m_spots[worst].position.x = kFarAway;
      if (left <= most) tail.push_back(m_cells.order()[worst]);
    }
    std::vector<uint32_t> kept;
    for (size_t i = 0; i < m_spots.size(); ++i)
      if (m_spots[i].position.x != kFarAway) kept.push_back(m_cells.order()[i]);
    kept.insert(kept.end(), tail.rbegin(), tail.rend());
    return kept;
  }

 private:
  static constexpr float kFarAway = 1.0e9f;  // where candidates go that were taken away
  struct Spot {
    glm::vec3 position;
    float weight;  // how crowded it is
  };

  /// Calls f(j, weight) for all candidates in reach that are still there, i itself excepted. [Yuksel 2015, eq. 2]
  template <class F>
  void forNeighbours(uint32_t i, const F& f) const {
    const glm::vec3 position = m_spots[i].position;
    const bool bent = m_bent[m_cellOf[i]] != 0;
    for (const uint32_t cell : m_cells.neighbours(m_cellOf[i]))
      for (uint32_t j = m_cells.begin(cell), end = m_cells.end(cell); j < end; ++j) {
        const glm::vec3 apart = m_spots[j].position - position;
        const float squared = glm::dot(apart, apart);
        if (squared >= m_reach * m_reach || j == i || (bent && !(glm::dot(m_normals[i], m_normals[j]) > kSightCosine)))
          continue;
        const float closeness = 1.0f - std::max(std::sqrt(squared), m_floor) * m_inverseReach;
        const float p2 = closeness * closeness, p4 = p2 * p2;
        f(j, p4 * p4);
      }
  }

  /// Marks the cells round which normals part so much that some may not see each other.
  void findBentCells() {
    std::vector<float> spread(m_cells.cellCount(), 1.0f);  // least cosine of a cell's normals with its first one
    for (uint32_t c = 0; c < m_cells.cellCount(); ++c)
      for (uint32_t i = m_cells.begin(c); i < m_cells.end(c); ++i)
        spread[c] = std::min(spread[c], glm::dot(m_normals[m_cells.begin(c)], m_normals[i]));
    m_bent.assign(m_cells.cellCount(), 0);
    for (uint32_t c = 0; c < m_cells.cellCount(); ++c)
      for (const uint32_t other : m_cells.neighbours(c)) {
        const float between = glm::dot(m_normals[m_cells.begin(c)], m_normals[m_cells.begin(other)]);
        if (!(std::min({between, spread[c], spread[other]}) >= kStraightCosine)) m_bent[c] = 1;
      }
  }

  void weighAll() {
    parallelFor((m_spots.size() + kChunk - 1) / kChunk, [&](size_t chunk) {
      const size_t end = std::min(m_spots.size(), (chunk + 1) * kChunk);
      for (uint32_t i = uint32_t(chunk * kChunk); i < end; ++i) {
        float sum = 0.0f;
        forNeighbours(i, [&](uint32_t, float weight) { sum += weight; });
        m_spots[i].weight = sum;
      }
    });
  }

  uint32_t bucketOf(uint32_t i) const {
    return uint32_t(std::clamp(m_spots[i].weight * m_perWeight, 0.0f, float(kBuckets - 1)));
  }

  void fillBuckets() {
    float most = 0.0f;
    for (const Spot& spot : m_spots) most = std::max(most, spot.weight);
    m_perWeight = most > 0.0f ? float(kBuckets - 1) / most : 0.0f;
    m_buckets.assign(kBuckets, {});
    m_top = kBuckets - 1;
    for (uint32_t i = 0; i < m_spots.size(); ++i) m_buckets[bucketOf(i)].push_back(i);
  }

  /// Weights only fall, so a candidate is looked at again when the bucket it was put in comes to be the top one.
  uint32_t takeWorst() {
    for (;;) {
      while (m_buckets[m_top].empty()) --m_top;
      std::vector<uint32_t>& top = m_buckets[m_top];
      const uint32_t i = top.back();
      top.pop_back();
      prefetch(top);
      const uint32_t bucket = bucketOf(i);
      if (bucket == m_top) return i;
      m_buckets[bucket].push_back(i);
    }
  }

  /// Asks for what the next candidates will need.
  void prefetch(const std::vector<uint32_t>& top) const {
    constexpr size_t kFar = 12, kNear = 4;
    if (top.size() < kFar) return;
    __builtin_prefetch(&m_spots[top[top.size() - kFar]]);
    __builtin_prefetch(&m_cellOf[top[top.size() - kFar]]);
    const uint32_t next = top[top.size() - kNear];
    if (bucketOf(next) != m_top) return;
    for (const uint32_t cell : m_cells.neighbours(m_cellOf[next])) {
      const Spot* spots = &m_spots[m_cells.begin(cell)];
      __builtin_prefetch(spots);
      __builtin_prefetch(spots + 4);
    }
  }

  float m_reach, m_floor = 0.0f, m_inverseReach = 0.0f, m_perWeight = 0.0f;
  PointCells m_cells;
  std::vector<Spot> m_spots;
  std::vector<glm::vec3> m_normals;
  std::vector<uint32_t> m_cellOf;
  std::vector<uint8_t> m_bent;
  std::vector<std::vector<uint32_t>> m_buckets;
  uint32_t m_top = 0;
};

/// Thins large sets part by part, on all cores, to kRoughShare times the goal each; candidates at the seams do not see
/// beyond. Gives indices.
std::vector<uint32_t> thinOut(std::span<const SurfaceCandidate> candidates, const EliminationGoal& goal, double kept) {
  float reach = float(2.0 * goal.maxRadius);
  const std::vector<uint32_t> order = cellsFor(positionsOf(candidates), reach).order();
  const size_t parts = (order.size() + kPart - 1) / kPart;
  std::vector<std::vector<uint32_t>> left(parts);
  parallelFor(parts, [&](size_t part) {
    const auto own = std::span(order).subspan(part * order.size() / parts,
                                              (part + 1) * order.size() / parts - part * order.size() / parts);
    const size_t wanted = std::min(own.size(), size_t(std::ceil(double(own.size()) * kept * kRoughShare)));
    for (const uint32_t i : Elimination(gathered(candidates, own), goal.maxRadius, kept).run(wanted, wanted))
      left[part].push_back(own[i]);
  });
  std::vector<uint32_t> all;
  for (const std::vector<uint32_t>& part : left) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

std::vector<uint32_t> eliminateSamples(std::span<const SurfaceCandidate> candidates, const EliminationGoal& goal) {
  LIMN_CHECK_LE(goal.least, goal.most);
  LIMN_CHECK_LE(size_t(goal.most), candidates.size());
  if (candidates.empty()) return {};
  const double kept = double(goal.most) / double(candidates.size());
  if (candidates.size() < 2 * kPart) return Elimination(candidates, goal.maxRadius, kept).run(goal.most, goal.least);
  const std::vector<uint32_t> rough = thinOut(candidates, goal, kept);
  std::vector<uint32_t> chosen =
      Elimination(gathered(candidates, rough), goal.maxRadius, kept).run(goal.most, goal.least);
  for (uint32_t& i : chosen) i = rough[i];
  return chosen;
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
