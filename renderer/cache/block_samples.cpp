#include "renderer/cache/block_samples.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "renderer/base/check.hpp"
#include "renderer/base/mix.hpp"
#include "renderer/cache/block_metric.hpp"
#include "renderer/cache/parallel_for.hpp"
#include "renderer/cache/word_hash.hpp"

namespace limn {
namespace {

const Primitive& primitiveOf(const Scene& scene, const gpu::GeometryBlock& block) {
  return scene.meshes[block.mesh].primitives[block.primitive];
}

/// Positions that sites are sampled on when they may ride.
std::span<const glm::vec3> restOf(const Primitive& p) {
  return p.restPositions.empty() ? std::span(p.positions) : std::span(p.restPositions);
}

/// Other points for every block, so that instances differ.
uint32_t seedOf(uint32_t seed, size_t block) {
  return mix32(seed * 0x9e3779b9u + uint32_t(block) * 0x85ebca6bu + 1u);
}

}  // namespace

std::vector<uint32_t> shareOut(uint32_t count, const std::vector<double>& weights) {
  std::vector<uint32_t> shares(weights.size(), 0);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(sum > 0.0)) return shares;
  std::vector<double> remainders(weights.size());
  uint64_t given = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    const double exact = count * (weights[i] / sum);
    shares[i] = uint32_t(exact);
    remainders[i] = weights[i] > 0.0 ? exact - shares[i] : -1.0;
    given += shares[i];
  }
  LIMN_CHECK_LE(given, uint64_t(count));
  std::vector<uint32_t> order(weights.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return remainders[a] > remainders[b]; });
  for (size_t i = 0; given < count; i = (i + 1) % order.size())
    if (weights[order[i]] > 0.0) ++shares[order[i]], ++given;
  return shares;
}

BlockSampling::Poses BlockSampling::posesOf(const Primitive& p) {
  const uint64_t posed = hashWords(std::span(p.indices), hashWords(std::span(p.positions)));
  if (p.restPositions.empty()) return {posed, posed};
  return {posed, hashWords(std::span(p.indices), hashWords(std::span(p.restPositions)))};
}

/// Looks at a block that is not what it was; gives whether it needs other points.
bool BlockSampling::measure(const Primitive& p, const Surface& surface, size_t block) {
  m_surfaces[block] = surface;
  const std::vector<glm::vec3> posed = stretchedCorners(p.positions, p.indices, surface.stretch);
  std::vector<glm::vec3> sampled = stretchedCorners(restOf(p), p.indices, surface.shape);
  const bool atRest = p.restPositions.empty() || misplacedShare(sampled, posed) <= kMostMisplaced;
  if (!atRest) sampled = stretchedCorners(p.positions, p.indices, surface.shape);
  m_areas[block] = areaOf(sampled) > 0.0 ? areaOf(posed) : 0.0;
  const Source source{atRest ? surface.poses.rest : surface.poses.posed, atRest, surface.shape, surface.seed};
  if (source == m_sources[block]) return false;
  m_sources[block] = source;
  return true;
}

uint32_t BlockSampling::update(const Scene& scene, const std::vector<gpu::GeometryBlock>& blocks,
                               const std::vector<glm::dmat4>& worldFromNodes, uint32_t count, uint32_t seed) {
  std::map<std::pair<uint32_t, uint32_t>, Poses> poses;  // instances share one
  for (const gpu::GeometryBlock& block : blocks) {
    const auto [entry, isNew] = poses.try_emplace({block.mesh, block.primitive});
    if (isNew) entry->second = posesOf(primitiveOf(scene, block));
  }
  m_surfaces.resize(blocks.size());
  m_sources.resize(blocks.size());
  m_areas.resize(blocks.size(), 0.0);
  m_points.resize(blocks.size());

  std::vector<uint8_t> stale(blocks.size(), 0);
  parallelFor(blocks.size(), [&](size_t i) {
    const gpu::GeometryBlock& block = blocks[i];
    const glm::dmat3 linear(worldFromNodes[block.node]);
    const Surface now{poses.at({block.mesh, block.primitive}), roundedStretch(linear), roundedShape(linear),
                      seedOf(seed, i)};
    if (now == m_surfaces[i]) return;
    stale[i] = measure(primitiveOf(scene, block), now, i);
  });

  const std::vector<uint32_t> counts = shareOut(count, m_areas);
  std::vector<uint32_t> work;
  uint32_t sampled = 0;
  for (uint32_t i = 0; i < blocks.size(); ++i) {
    if (stale[i] || m_points[i].sites.size() != countClassOf(counts[i]).most) work.push_back(i);
    m_points[i].count = counts[i];
  }
  for (const uint32_t i : work) sampled += counts[i] > 0;
  std::stable_sort(work.begin(), work.end(), [&](uint32_t a, uint32_t b) { return counts[a] > counts[b]; });
  parallelFor(work.size(), [&](size_t w) {
    BlockPoints& points = m_points[work[w]];
    const Source& source = m_sources[work[w]];
    const Primitive& p = primitiveOf(scene, blocks[work[w]]);
    const std::vector<glm::vec3> corners =
        stretchedCorners(source.atRest ? restOf(p) : std::span(p.positions), p.indices, source.shape);
    const CountClass counted = countClassOf(points.count);
    points.sites = sampleBlock(corners, counted, source.seed);
    points.relativeRadius = relativeRadius(corners, std::span(points.sites).first(counted.least));
  });
  return sampled;
}

}  // namespace limn
