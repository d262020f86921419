#pragma once
#include <span>
#include <vector>

#include "renderer/cache/surface_points.hpp"
#include "renderer/vk/buffer.hpp"
#include "renderer/vk/command_recorder.hpp"
#include "shaders/shared/point_grid_shared.h"
#include "shaders/shared/point_shared.h"

namespace limn {

/// Reaches of a grid's points: means over about 10 points on a plane; the nearest point alone.
constexpr double kSmoothReach = 1.8, kNearestReach = 1.1;

/// Which points a grid holds: the first `slots` of every cluster.
struct PointSubset {
  std::span<const shared::SurfacePoint> points;  ///< all, cluster by cluster
  uint32_t clusterSize = 0, slots = 0;
  double areaPerPoint = 0.0;  ///< [m²] of the whole set
  double reach = kSmoothReach;  ///< how far points reach over the side of a point's square of surface
};

/// A uniform hashed grid over surface points, as the device reads it.
struct PointGridData {
  shared::PointGridInfo info{};
  std::vector<uint32_t> starts;   ///< of the buckets in entries, and the end
  std::vector<uint32_t> entries;  ///< point indices, bucket by bucket, lower slots first
};
PointGridData buildPointGrid(const PointSubset& subset);

/// Bucket of a cell; 2x2x2 neighbouring cells are always in different ones.
uint32_t bucketOf(const glm::ivec3& cell, uint32_t mask);

/// Weight of a point that lies `apart` from a position, for a normal there: 1 at the position itself, 0 from `radius`
/// on, where the plane is missed by kPointGridPlaneReach of it, and where `cosine` of the normals is not positive.
float pointWeight(const glm::vec3& apart, const glm::vec3& normal, float cosine, float radius);

/// The grid on the device: shaders/lib/point_grid.glsl looks up in it. Render thread.
class PointGrid {
 public:
  /// Builds the grid over the first `slots` points of every cluster; 0 < slots <= points.clusterSize(), unless there
  /// are no points. `reach` as in PointSubset. Errors: "limit", "out-of-memory", "device-lost".
  Result<void> update(vk::Device& device, const SurfacePoints& points, uint32_t slots, double reach = kSmoothReach);
  /// POINT_GRID and POINT_GRID_ENTRIES, both texel. After a successful update. Look-ups also read POINTS and
  /// POINT_LIGHT.
  std::vector<vk::Binding> bindings() const;
  float radius() const { return m_radius; }  ///< [m], how far a point reaches

 private:
  vk::Buffer m_starts, m_entries;
  float m_radius = 0.0f;
};

}  // namespace limn
