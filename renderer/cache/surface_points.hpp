#pragma once
#include <vector>

#include "renderer/cache/block_samples.hpp"
#include "renderer/gpu/device_scene.hpp"
#include "renderer/vk/buffer.hpp"
#include "renderer/vk/command_recorder.hpp"
#include "shaders/shared/point_shared.h"

namespace limn {

/// Blue-noise points on all surfaces, each of about equal area, in clusters of equal size; they ride on their triangles
/// when objects are moved, bent or scaled, see BlockSampling. POINTS and POINT_SITES of shaders/shared/bindings.h are
/// cluster-major, and the first m points of every cluster are spread over it. The contents are a function of scene,
/// count, clusters and seed alone, however they came to be. [IPP §3.1, §3.2, §4] Render thread.
class SurfacePoints {
 public:
  /// What update() did and how long it took [ms].
  struct Update {
    uint32_t sampledBlocks = 0;  ///< got new points; 0: points only moved, if at all
    bool changed = false;        ///< the buffers hold something new: points are to be lit again
    double sampleMs = 0.0, moveMs = 0.0, clusterMs = 0.0, uploadMs = 0.0;
  };

  /// Brings the points up to date with a scene and its mirror. `count` is rounded up to a multiple of `clusters`, a
  /// power of two. Errors: "limit", "out-of-memory", "device-lost"; then bindings() are not to be used until an update
  /// succeeds.
  Result<Update> update(vk::Device& device, const Scene& scene, const gpu::DeviceScene& mirror, uint32_t count,
                        uint32_t clusters, uint32_t seed);

  /// 0 in scenes without area; the buffers hold one dummy then.
  uint32_t count() const { return uint32_t(m_points.size()); }
  uint32_t clusterCount() const { return m_clusterCount; }
  uint32_t clusterSize() const { return m_clusterCount > 0 ? count() / m_clusterCount : 0; }
  /// [m²], of the surfaces as they are placed; 0 without points.
  double areaPerPoint() const { return m_areaPerPoint; }
  /// Of the least even block, see relativeRadius() in point_sampling.hpp; blocks of under 16 points do not count.
  double relativeRadius() const { return m_relativeRadius; }
  /// POINTS (texel) and POINT_SITES (storage). After a successful update.
  std::vector<vk::Binding> bindings() const;

  /// The same on the host.
  const std::vector<shared::SurfacePoint>& points() const { return m_points; }
  const std::vector<shared::PointSite>& sites() const { return m_sites; }

 private:
  /// What a block looked like last time.
  struct Placement {
    uint64_t corners = 0;  ///< hash
    double area = 0.0;     ///< [m²]
    uint32_t firstTriangle = 0;
    bool mirrored = false;
  };

  bool lookAtPlacements(const gpu::DeviceScene& mirror, const std::vector<glm::dmat4>& worldFromNodes);
  void placePoints(const gpu::DeviceScene& mirror);
  void cluster(uint32_t clusters);
  Result<void> upload(vk::Device& device);

  BlockSampling m_sampling;
  std::vector<Placement> m_placements;
  std::vector<shared::SurfacePoint> m_points;
  std::vector<shared::PointSite> m_sites;
  vk::Buffer m_pointBuffer, m_siteBuffer;
  uint32_t m_wanted = 0, m_clusterCount = 0;
  double m_areaPerPoint = 0.0, m_relativeRadius = 1.0;
  bool m_valid = false;
};

}  // namespace limn
