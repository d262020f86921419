#pragma once
#include <memory>
#include <vector>

#include "renderer/cache/point_light.hpp"
#include "renderer/cache/surface_points.hpp"
#include "renderer/gather/point_projection.hpp"
#include "renderer/gpu/device_scene.hpp"
#include "renderer/visibility/scene_tracer.hpp"

namespace limn::projection {

constexpr uint32_t kMicroSide = 32;  ///< [texel] of the micro-buffers, which are square

/// A scene's surface points, lit directly, and what its pixels see: all that gathers read, without the technique about
/// it, so that they can be made in other ways than its own. Render thread.
class LitScene {
 public:
  /// About `pointCount` points on the scene's surfaces, and the sites of width x height pixels. Errors: those of the
  /// device, "limit".
  static Result<std::unique_ptr<LitScene>> create(vk::Device& device, const Scene& scene, uint32_t width,
                                                  uint32_t height, uint32_t pointCount);

  /// Whether a pixel sees a surface that gathers.
  bool gathersAt(uint32_t pixel) const { return m_visible[pixel]; }

  /// Micro-buffers of pixels one after the other, kMicroSide² texels each, row by row: radiance [W·sr⁻¹·m⁻²], and in w
  /// 1 where something is seen. `projections` as in shared::PointProjectionPush.
  Result<std::vector<glm::vec4>> microBuffers(const std::vector<uint32_t>& pixels, const GatherVariant& variant,
                                              uint32_t projections) const;
  /// Irradiance over pi [W·sr⁻¹·m⁻²] of the same micro-buffers.
  Result<std::vector<glm::vec3>> diffuseLight(const std::vector<uint32_t>& pixels, const GatherVariant& variant,
                                              uint32_t projections) const;

  uint32_t width() const { return m_width; }    ///< [pixel]
  uint32_t height() const { return m_height; }  ///< [pixel]
  const SurfacePoints& points() const { return m_points; }

 private:
  LitScene(vk::Device& device, uint32_t width, uint32_t height)
      : m_device(device), m_width(width), m_height(height), m_mirror(device) {}
  Result<void> sync(const Scene& scene);
  Result<void> lightPoints(const Scene& scene, uint32_t pointCount);
  Result<void> findSites();
  Result<void> gather(const char* shader, const std::vector<uint32_t>& pixels, const vk::Binding& output,
                      const GatherVariant& variant, uint32_t projections) const;

  vk::Device& m_device;
  uint32_t m_width, m_height;
  SceneNeeds m_needs;
  gpu::DeviceScene m_mirror;
  SceneTracer m_tracer;
  SurfacePoints m_points;
  PointLightCache m_light;
  vk::Buffer m_camera, m_sites;
  std::vector<bool> m_visible;
};

}  // namespace limn::projection
