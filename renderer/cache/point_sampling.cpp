#include "renderer/cache/point_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/base/check.hpp"
#include "renderer/cache/sample_elimination.hpp"

namespace limn {
namespace {

constexpr uint32_t kOversampling = 5;  // candidates a point [Yuksel 2015, §3]
constexpr uint32_t kLeastCandidates = 64;
constexpr double kClassesPerOctave = 4.0;

/// Uniform in [0, 1), 53 bits; a function of seed and index (splitmix64).
double uniformAt(uint64_t seed, uint64_t index) {
  uint64_t z = (seed << 32 ^ 0x5851f42d4c957f2dull) + (index + 1) * 0x9e3779b97f4a7c15ull;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ z >> 27) * 0x94d049bb133111ebull;
  return double((z ^ z >> 31) >> 11) * 0x1p-53;
}

glm::dvec3 doubledNormal(const glm::vec3* corner) {
  const glm::dvec3 a(corner[0]);
  return glm::cross(glm::dvec3(corner[1]) - a, glm::dvec3(corner[2]) - a);
}

double triangleArea(const glm::vec3* corner) {
  const double area = 0.5 * glm::length(doubledNormal(corner));
  return std::isfinite(area) ? area : 0.0;
}

/// Brings a block into the unit cube without changing its shape.
struct UnitFrame {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  double scale = 1.0;

  explicit UnitFrame(std::span<const glm::vec3> corners) {
    glm::dvec3 high = -low;
    for (size_t t = 0; t + 3 <= corners.size(); t += 3)
      if (triangleArea(&corners[t]) > 0.0)
        for (size_t k = 0; k < 3; ++k) {
          low = glm::min(low, glm::dvec3(corners[t + k]));
          high = glm::max(high, glm::dvec3(corners[t + k]));
        }
    const glm::dvec3 size = high - low;
    const double widest = std::max({size.x, size.y, size.z});
    scale = widest > 0.0 && std::isfinite(widest) ? 1.0 / widest : 1.0;
  }

  SurfaceCandidate place(std::span<const glm::vec3> corners, const BlockSite& site) const {
    const glm::vec3* corner = &corners[size_t(site.triangle) * 3];
    const double u = site.barycentrics.x, v = site.barycentrics.y;
    const glm::dvec3 p = glm::dvec3(corner[0]) * (1.0 - u - v) + glm::dvec3(corner[1]) * u + glm::dvec3(corner[2]) * v;
    return {glm::vec3((p - low) * scale), glm::vec3(glm::normalize(doubledNormal(corner)))};
  }

  std::vector<SurfaceCandidate> place(std::span<const glm::vec3> corners, std::span<const BlockSite> sites) const {
    std::vector<SurfaceCandidate> placed;
    placed.reserve(sites.size());
    for (const BlockSite& site : sites) placed.push_back(place(corners, site));
    return placed;
  }
};

glm::vec2 uniformBarycentrics(double u, double v) {
  const double root = std::sqrt(u);
  const glm::vec2 b(float(root * (1.0 - v)), float(root * v));
  return b.x + b.y <= 1.0f ? b : b / (b.x + b.y);
}

/// Candidates one to a stratum of equal area, triangle by triangle, so that every triangle has its share.
std::vector<BlockSite> drawCandidates(std::span<const glm::vec3> corners, double area, uint32_t count, uint32_t seed) {
  std::vector<BlockSite> sites;
  sites.reserve(count);
  double before = 0.0;
  for (size_t t = 0; t * 3 < corners.size() && sites.size() < count; ++t) {
    const double own = triangleArea(&corners[t * 3]);
    if (!(own > 0.0)) continue;
    const auto wanted = [&] { return (double(sites.size()) + uniformAt(seed, sites.size() * 3)) / count * area; };
    while (sites.size() < count && wanted() < before + own) {
      const uint64_t i = sites.size();
      sites.push_back({uint32_t(t), uniformBarycentrics(uniformAt(seed, i * 3 + 1), uniformAt(seed, i * 3 + 2))});
    }
    before += own;
  }
  // Sums that were rounded may leave the last ones out.
  while (!sites.empty() && sites.size() < count) {
    const uint64_t i = sites.size();
    sites.push_back(
        {sites.back().triangle, uniformBarycentrics(uniformAt(seed, i * 3 + 1), uniformAt(seed, i * 3 + 2))});
  }
  return sites;
}

double maxRadius(double area, double count) { return std::sqrt(area / (2.0 * std::sqrt(3.0) * count)); }

}  // namespace

CountClass countClassOf(uint32_t count) {
  if (count == 0) return {};
  const auto bound = [](int step) { return uint32_t(std::lround(std::exp2(step / kClassesPerOctave))); };
  int step = int(std::ceil(std::log2(double(count)) * kClassesPerOctave));
  while (bound(step) < count) ++step;
  while (step > 0 && bound(step - 1) >= count) --step;
  return {step > 0 ? bound(step - 1) + 1 : 1, bound(step)};
}

double areaOf(std::span<const glm::vec3> corners) {
  double sum = 0.0;
  for (size_t t = 0; t + 3 <= corners.size(); t += 3) sum += triangleArea(&corners[t]);
  return sum;
}

double misplacedShare(std::span<const glm::vec3> sampled, std::span<const glm::vec3> placed) {
  LIMN_CHECK_EQ(sampled.size(), placed.size());
  const double sampledArea = areaOf(sampled), placedArea = areaOf(placed);
  if (!(sampledArea > 0.0 && placedArea > 0.0)) return 1.0;
  double sum = 0.0;
  for (size_t t = 0; t + 3 <= sampled.size(); t += 3)
    sum += std::abs(triangleArea(&sampled[t]) / sampledArea - triangleArea(&placed[t]) / placedArea);
  return 0.5 * sum;
}

std::vector<BlockSite> sampleBlock(std::span<const glm::vec3> corners, CountClass counts, uint32_t seed) {
  const double area = areaOf(corners);
  if (!(area > 0.0) || counts.most == 0) return {};
  const uint32_t candidateCount = std::max(kOversampling * counts.most, kLeastCandidates);
  const std::vector<BlockSite> candidates = drawCandidates(corners, area, candidateCount, seed);
  const UnitFrame frame(corners);
  const EliminationGoal goal{counts.most, counts.least, frame.scale * maxRadius(area, counts.most)};
  std::vector<BlockSite> sites;
  sites.reserve(counts.most);
  for (const uint32_t i : eliminateSamples(frame.place(corners, candidates), goal)) sites.push_back(candidates[i]);
  return sites;
}

double relativeRadius(std::span<const glm::vec3> corners, std::span<const BlockSite> sites) {
  if (sites.size() < 2) return 1.0;
  const UnitFrame frame(corners);
  const double densest = 2.0 * frame.scale * maxRadius(areaOf(corners), double(sites.size()));
  return smallestDistance(frame.place(corners, sites), densest) / densest;
}

}  // namespace limn
