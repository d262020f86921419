#pragma once
#include <algorithm>
#include <vector>

#include "renderer/gpu/tailored_pass.hpp"
#include "renderer/vk/command_recorder.hpp"
#include "shaders/shared/gather_shared.h"

namespace limn {

/// Most that a gather's shared memory has room for.
constexpr uint32_t kMostProjections = 4096, kMostGatherClusters = 1024, kMostMicroSize = 32;

/// Gathers light at sites by splatting surface points into a micro-buffer, the points drawn by how much of the site's
/// view their clusters fill. The same scene, seed and round give the same bits. [IPP §3.2, §4] Render thread.
class PointProjection {
 public:
  PointProjection();

  /// Pipelines for what the scene needs, compiled and warm; made the first time and where `mayCompile` says that a stop
  /// is no matter. Both sets hold the scene's, the camera's and the points' bindings with their radiance and lobes, and
  /// PIXEL_LIST. `atPixels` adds G_BUFFER and INDIRECT, `atPoints` POINT_LIGHT; more does no harm. `lobes` says whether
  /// any point may have glossy lobes; without, POINT_LOBES is not read. Errors: "device", "out-of-memory", "device-lost".
  Result<void> prepare(vk::Device& device, const std::vector<vk::Binding>& atPixels,
                       const std::vector<vk::Binding>& atPoints, const SceneNeeds& needs, bool lobes, bool mayCompile);

  /// Gathers at the pixels of a list and averages with the rounds before; round 0 and pixels that were not sampled begin
  /// anew. PIXEL_LIST holds pixels. Projections are raised to two a cluster where they are fewer. No barrier at the end.
  void recordAtPixels(vk::CommandRecorder& recorder, const std::vector<vk::Binding>& bindings,
                      const shared::PointProjectionPush& push) const;

  /// Gathers diffuse light at sides of points, whose indirect light it replaces. PIXEL_LIST holds 2 * point + side.
  /// No barrier at the end.
  void recordAtPoints(vk::CommandRecorder& recorder, const std::vector<vk::Binding>& bindings,
                      const shared::PointProjectionPush& push) const;

  /// The worse of the two, as of the last prepare().
  gpu::PipelineVariant pipelines() const { return std::max(m_pixels.variant(), m_points.variant()); }

 private:
  gpu::TailoredPass m_pixels, m_points;
};

/// How a gather picks points and how it splats them: constants of gather_pixels, gather_points and gather_micro_buffers.
/// The defaults are the method's; the others are for its validation. [IPP figs. 7 and 9]
struct GatherVariant {
  enum Selection : uint32_t { byImportance, atRandom, everyPoint };
  Selection selection = byImportance;
  uint32_t splatSide = 0;       ///< [texel] of every splat; 0: as large as what the point stands for
  uint32_t workgroup = 64;      ///< invocations a site, a power of two, at most 128
};

/// Specialization constants of the three shaders.
std::vector<uint32_t> gatherConstants(const SceneNeeds& needs, bool lobes, const GatherVariant& variant = {});

}  // namespace limn
