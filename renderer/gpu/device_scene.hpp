#pragma once
#include <vector>

#include "renderer/gpu/geometry.hpp"
#include "renderer/gpu/light_table.hpp"
#include "renderer/scene/edit.hpp"
#include "renderer/vk/buffer.hpp"
#include "renderer/vk/command_recorder.hpp"

namespace limn::gpu {

/// What sync() did, for the layers that derive more from the geometry.
struct SyncReport {
  bool reloaded = false;                ///< every block is new
  std::vector<uint32_t> movedBlocks;    ///< indices into blocks(); sorted
  std::vector<uint32_t> alphaBlocks;    ///< blocks whose need of the alpha test changed
  bool lightsChanged = false;
};

/// The scene mirrored on the device, a function of the Scene alone: nothing remembers how it came to be.
/// Written by sync() only. Render thread.
class DeviceScene {
 public:
  explicit DeviceScene(vk::Device& device) : m_device(device) {}

  /// Brings the mirror up to date. Errors: "limit", "out-of-memory", "device-lost"; then the mirror is unusable until a sync
  /// with `everything` succeeds.
  Result<SyncReport> sync(const Scene& scene, const ChangeSet& changes);
  /// Whether the device has room for an environment image, so that an edit is refused by its place before anything is tried.
  /// Errors: "limit", "out-of-memory".
  Result<void> checkEnvironment(const Image& image) const;

  /// The scene's bindings of shaders/shared/bindings.h, without hierarchy and camera.
  std::vector<vk::Binding> bindings() const;
  const std::vector<GeometryBlock>& blocks() const { return m_blocks; }
  bool blockNeedsAlpha(size_t block) const { return m_blockAlpha[block] != 0; }
  bool anyAlpha() const;
  const glm::dvec3& renderOrigin() const { return m_renderOrigin; }
  double radius() const { return m_radius; }
  const std::vector<shared::LightData>& lights() const { return m_lightTable.lights; }
  uint64_t triangleCount() const { return m_triangleCount; }
  /// Kept on the host of the blocks and lights, to rebuild from [byte].
  uint64_t hostBytes() const;

 private:
  Result<void> reload(const Scene& scene);
  Result<void> moveBlocks(const Scene& scene, const std::vector<uint32_t>& moved);
  Result<void> writeMaterials(const Scene& scene);
  Result<void> writeLights(const Scene& scene);
  Result<void> writeEnvironment(const Scene& scene);
  bool updateOrigin(const Scene& scene);

  vk::Device& m_device;
  glm::dvec3 m_renderOrigin{0.0};
  double m_radius = 1.0;
  uint64_t m_triangleCount = 0;
  std::vector<GeometryBlock> m_blocks;
  std::vector<uint8_t> m_blockAlpha;
  LightTable m_lightTable;
  shared::SceneInfo m_info{};
  vk::Buffer m_triangles, m_positions, m_vertices, m_triangleLights, m_materials, m_textureSlots, m_lights, m_lightTree,
      m_images, m_texels, m_environment, m_environmentTable, m_sceneInfo;
};

}  // namespace limn::gpu
