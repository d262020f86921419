#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "renderer/gpu/device_scene.hpp"
#include "renderer/gpu/tailored_pass.hpp"
#include "renderer/scene/scene_needs.hpp"
#include "renderer/visibility/scene_tracer.hpp"

namespace limn {

/// Whether any surface in use reflects so much without scattering that points keep glossy lobes: kLobeReflectance.
bool hasGlossySources(const Scene& scene);

/// What lighting the points reads.
struct PointLightContext {
  vk::Device& device;
  const gpu::DeviceScene& scene;
  const SceneTracer& tracer;
  std::vector<vk::Binding> points;  ///< of SurfacePoints: BINDING_POINTS and BINDING_POINT_SITES
  bool panes = false;               ///< the scene has some, and a shadow ray may be many
};

/// Points are stored cluster by cluster: point = cluster * clusterSize + slot.
struct PointLayout {
  uint32_t clusterCount = 0, clusterSize = 0;
  uint32_t count() const { return clusterCount * clusterSize; }
  bool operator==(const PointLayout&) const = default;
};

/// The slots [first, end) of every cluster: a spread-out part of all points.
struct SlotRange {
  uint32_t first = 0, end = 0;
};

/// Light that is there soon, and light from more samples: two sets of buffers.
enum class PointLightVersion : uint32_t { first, refined };

/// One share of next-event samples of points.
struct RelightWork {
  SlotRange slots;
  uint32_t samples = 1;        ///< taken of every point now
  uint32_t samplesBefore = 0;  ///< taken of the same points since the light changed; 0 replaces what they hold
  uint32_t seed = 0;
};

/// One share of the paths of points.
struct PathWork {
  SlotRange slots;             ///< of the points that are in the grid of recordSpread()
  uint32_t samples = 1;        ///< taken of both sides of every point now
  uint32_t samplesBefore = 0;  ///< taken of the same points since the light changed; 0 replaces what they hold
  uint32_t bounces = 1;        ///< that reach the points, at least 1
  uint32_t seed = 0;
};

/// The light at surface points: irradiance of both sides, kept free of the surface's colours, the diffuse radiance that
/// leaves, and up to 4 glossy lobes where the scene has glossy sources. [IPP §4] Every point is lit by rays; what comes
/// out depends on scene, seed and numbers of samples alone. A sample that is not finite counts as one without light.
/// Render thread.
class PointLightCache {
 public:
  PointLightCache();

  /// Makes room, for one point at least, and for refined light where it is told; contents are undefined until recordClear()
  /// and recordCopy(). Nothing happens where the room is right already. Errors: "limit", "out-of-memory", "device-lost".
  Result<void> resize(vk::Device& device, PointLayout layout, bool lobes, bool refined = false);

  /// What everything below works on from now on; at first that is PointLightVersion::first.
  void select(PointLightVersion version);

  /// Pipelines for what the scene needs, compiled and warm; made the first time and where `mayCompile` says that a stop
  /// is no matter. After resize(). Errors: "device", "out-of-memory", "device-lost".
  Result<void> prepare(const PointLightContext& context, const SceneNeeds& needs, bool mayCompile);

  /// The pipeline of recordSpread(), compiled and warm; made the first time only. `grid` is as for recordSpread().
  /// Errors as prepare().
  Result<void> prepareSpread(const PointLightContext& context, const std::vector<vk::Binding>& grid);

  /// Sets all light to zero, that of gathers too.
  void recordClear(vk::CommandRecorder& recorder) const;

  /// Copies the first version to the refined one. Ends with a barrier.
  void recordCopy(vk::CommandRecorder& recorder) const;

  /// Takes direct-light samples of the points and adds them to their means; indirect light stays. Ends with a barrier.
  void recordRelight(vk::CommandRecorder& recorder, const PointLightContext& context, const RelightWork& work) const;

  /// Follows paths from the points and adds what they find to the means of indirect light. Ends with a barrier.
  void recordPaths(vk::CommandRecorder& recorder, const PointLightContext& context, const PathWork& work) const;

  /// Writes POINT_RADIANCE of the slots from POINT_LIGHT and the materials. Ends with a barrier.
  void recordCompose(vk::CommandRecorder& recorder, const PointLightContext& context, SlotRange slots) const;

  /// Interpolates the indirect light of points that are in a PointGrid, whose bindings `grid` are, to the slots given,
  /// which are not in it. Ends with a barrier.
  void recordSpread(vk::CommandRecorder& recorder, const PointLightContext& context,
                    const std::vector<vk::Binding>& grid, SlotRange slots) const;

  /// POINT_LIGHT, POINT_RADIANCE (texel) and POINT_LOBES, for gathers. Without lobes the last is a dummy of one point.
  std::vector<vk::Binding> bindings() const;
  bool hasLobes() const { return m_lobesKept; }
  const PointLayout& layout() const { return m_layout; }
  const vk::Buffer& light() const { return now().light; }        ///< shared::PointLight, one a point
  const vk::Buffer& radiance() const { return now().radiance; }  ///< vec4, two a point
  const vk::Buffer& lobes() const { return now().lobes; }        ///< shared::PointLobes

  /// The worse of those that depend on the scene's needs, as of the last prepare().
  gpu::PipelineVariant pipelines() const { return std::max(m_relight.variant(), m_compose.variant()); }

  /// Since the cache was made; up to date once the device has done what was recorded.
  uint64_t raysTraced() const;
  uint64_t discardedSamples() const;

 private:
  struct Buffers {
    vk::Buffer light, radiance, lobes;
  };
  static Result<Buffers> makeBuffers(vk::Device& device, size_t points, size_t lobes);
  const Buffers& now() const { return m_buffers[size_t(m_selected)]; }
  std::vector<vk::Binding> relightBindings(const PointLightContext& context) const;
  std::vector<vk::Binding> composeBindings(const PointLightContext& context) const;
  std::vector<vk::Binding> spreadBindings(const PointLightContext& context, const std::vector<vk::Binding>& grid) const;
  uint32_t slotsOf(SlotRange slots) const;

  PointLayout m_layout;
  bool m_lobesKept = false, m_refinedKept = false;
  std::array<Buffers, 2> m_buffers;  ///< by PointLightVersion
  PointLightVersion m_selected = PointLightVersion::first;
  vk::Buffer m_counters;
  gpu::TailoredPass m_relight, m_paths, m_compose;
  gpu::Pass m_spread;
};

}  // namespace limn
