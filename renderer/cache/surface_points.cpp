#include "renderer/cache/surface_points.hpp"

#include <algorithm>
#include <bit>

#include "renderer/base/check.hpp"
#include "renderer/base/clock.hpp"
#include "renderer/cache/parallel_for.hpp"
#include "renderer/cache/point_clusters.hpp"
#include "renderer/cache/word_hash.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"

namespace limn {
namespace {

constexpr uint32_t kFewPoints = 16;       // blocks of fewer have no spacing worth a figure
constexpr size_t kPointsAPiece = 8192;  // of work for one core

/// Milliseconds since `since`, which becomes now.
double lap(double& since) {
  const double now = nowSeconds(), ms = (now - since) * 1e3;
  since = now;
  return ms;
}

/// A point as its triangle carries it; corners are those of the placed block.
shared::SurfacePoint pointAt(const glm::vec3* corner, const glm::vec2& barycentrics) {
  const glm::dvec3 a(corner[0]), ab = glm::dvec3(corner[1]) - a, ac = glm::dvec3(corner[2]) - a;
  const glm::dvec3 normal = glm::cross(ab, ac);
  const double length = glm::length(normal);
  shared::SurfacePoint point;
  point.posR = glm::vec3(a + ab * double(barycentrics.x) + ac * double(barycentrics.y));
  point.normal = gpu::octEncode(length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0f, 0.0f, 1.0f));
  return point;
}

/// Calls work(begin, end) for pieces of [0, count) on all cores.
template <class Work>
void inPieces(size_t count, const Work& work) {
  parallelFor((count + kPointsAPiece - 1) / kPointsAPiece, [&](size_t piece) {
    work(piece * kPointsAPiece, std::min(count, (piece + 1) * kPointsAPiece));
  });
}

/// Writes values to a buffer that is made anew when its size is another; one dummy where there are none.
template <class T>
Result<void> write(vk::Device& device, vk::Buffer& buffer, const char* name, const std::vector<T>& values,
                   VkFormat texelFormat) {
  const std::vector<T> dummy(1);
  const std::span<const T> contents = values.empty() ? std::span<const T>(dummy) : std::span<const T>(values);
  if (buffer && buffer.size() == contents.size_bytes()) return vk::uploadArray(device, buffer, contents);
  vk::BufferDesc desc;
  desc.name = name;
  desc.owner = "surface-points";
  desc.texelFormat = texelFormat;
  desc.usage = texelFormat == VK_FORMAT_UNDEFINED ? vk::BufferUsage::storage : vk::BufferUsage::texel;
  buffer = vk::Buffer();
  auto made = vk::createBufferWith(device, desc, contents);
  if (!made) return made.error();
  buffer = made.take();
  return {};
}

}  // namespace

Result<SurfacePoints::Update> SurfacePoints::update(vk::Device& device, const Scene& scene,
                                                    const gpu::DeviceScene& mirror, uint32_t count, uint32_t clusters,
                                                    uint32_t seed) {
  LIMN_CHECK(count > 0 && std::has_single_bit(clusters));
  count = (count + clusters - 1) / clusters * clusters;
  Update result;
  double clock = nowSeconds();
  const std::vector<glm::dmat4> worlds = scene.worldFromNodes();
  const bool moved = lookAtPlacements(mirror, worlds);
  const bool recount = count != m_wanted || clusters != m_clusterCount;
  result.sampledBlocks = m_sampling.update(scene, mirror.blocks(), worlds, count, seed);
  result.sampleMs = lap(clock);
  if (m_valid && !moved && !recount && result.sampledBlocks == 0) return result;

  m_valid = false;
  m_wanted = count;
  m_clusterCount = clusters;
  placePoints(mirror);
  result.moveMs = lap(clock);
  cluster(clusters);
  result.clusterMs = lap(clock);
  if (auto done = upload(device); !done) return done.error();
  result.uploadMs = lap(clock);
  m_valid = result.changed = true;
  return result;
}

/// Whether any block is not where or what it was.
bool SurfacePoints::lookAtPlacements(const gpu::DeviceScene& mirror, const std::vector<glm::dmat4>& worldFromNodes) {
  const std::vector<gpu::GeometryBlock>& blocks = mirror.blocks();
  std::atomic<bool> moved = m_placements.size() != blocks.size();
  m_placements.resize(blocks.size());
  parallelFor(blocks.size(), [&](size_t i) {
    Placement& placement = m_placements[i];
    const uint64_t corners = hashWords(std::span(blocks[i].corners));
    const bool mirrored = glm::determinant(glm::dmat3(worldFromNodes[blocks[i].node])) < 0.0;
    if (corners == placement.corners && blocks[i].firstTriangle == placement.firstTriangle &&
        mirrored == placement.mirrored)
      return;
    placement = {corners, areaOf(blocks[i].corners), blocks[i].firstTriangle, mirrored};
    moved = true;
  });
  return moved;
}

/// Fills points and sites block by block.
void SurfacePoints::placePoints(const gpu::DeviceScene& mirror) {
  struct Piece {
    size_t block;
    size_t begin, end;  // of the block's sites
    size_t first;       // of the scene's points
  };
  std::vector<Piece> pieces;
  size_t total = 0;
  double area = 0.0;
  m_relativeRadius = 1.0;
  for (size_t b = 0; b < m_placements.size(); ++b) {
    const BlockPoints& block = m_sampling.blocks()[b];
    for (size_t begin = 0; begin < block.count; begin += kPointsAPiece)
      pieces.push_back({b, begin, std::min<size_t>(begin + kPointsAPiece, block.count), total + begin});
    total += block.count;
    area += m_placements[b].area;
    if (block.count >= kFewPoints) m_relativeRadius = std::min(m_relativeRadius, block.relativeRadius);
  }
  m_points.resize(total);
  m_sites.resize(total);
  m_areaPerPoint = total > 0 ? area / double(total) : 0.0;
  parallelFor(pieces.size(), [&](size_t p) {
    const Piece& piece = pieces[p];
    const Placement& placement = m_placements[piece.block];
    for (size_t i = piece.begin; i < piece.end; ++i) {
      BlockSite site = m_sampling.blocks()[piece.block].sites[i];
      // Mirrored blocks have corners 1 and 2 exchanged, so that their front stays in front.
      if (placement.mirrored) std::swap(site.barycentrics.x, site.barycentrics.y);
      const size_t at = piece.first + i - piece.begin;
      m_points[at] = pointAt(&mirror.blocks()[piece.block].corners[size_t(site.triangle) * 3], site.barycentrics);
      m_sites[at] = {placement.firstTriangle + site.triangle, site.barycentrics};
    }
  });
}

void SurfacePoints::cluster(uint32_t clusters) {
  std::vector<glm::vec3> positions(m_points.size());
  for (size_t i = 0; i < positions.size(); ++i) positions[i] = m_points[i].posR;
  const std::vector<uint32_t> order = clusterPoints(positions, clusters);
  std::vector<shared::SurfacePoint> points(order.size());
  std::vector<shared::PointSite> sites(order.size());
  inPieces(order.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      points[i] = m_points[order[i]];
      sites[i] = m_sites[order[i]];
    }
  });
  m_points = std::move(points);
  m_sites = std::move(sites);
}

Result<void> SurfacePoints::upload(vk::Device& device) {
  if (auto done = write(device, m_pointBuffer, "points", m_points, VK_FORMAT_R32G32B32A32_UINT); !done) return done;
  return write(device, m_siteBuffer, "pointSites", m_sites, VK_FORMAT_UNDEFINED);
}

std::vector<vk::Binding> SurfacePoints::bindings() const {
  LIMN_CHECK(m_valid);
  return {vk::texel(BINDING_POINTS, m_pointBuffer), vk::storage(BINDING_POINT_SITES, m_siteBuffer)};
}

}  // namespace limn
