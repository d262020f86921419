#pragma once
#include <vector>

#include "renderer/gpu/pass.hpp"
#include "shaders/shared/placement_shared.h"

namespace limn {

/// What selection reads, and the list that it writes: buffers of one picture.
struct PlacementBuffers {
  const vk::Buffer& sites;     ///< shared::GatherSite, one a pixel
  const vk::Buffer& gathered;  ///< shared::IndirectTexel, one a pixel
  const vk::Buffer& list;      ///< one word a pixel
};

/// The coherence metric of a level. [IPP §3.3]
struct CoherenceRule {
  float threshold = 0.3f;         ///< doubles a level
  float lambda = 8.0f;            ///< weight of radiance against geometry
  float extent = 1.0f;            ///< [m] half the diagonal of the scene's bounding box
  float luminance = 1.0f;         ///< [W·sr⁻¹·m⁻²] that a change is measured over
};

/// Adaptive image sampling: which pixels gather, from a coarse grid down to every pixel. Lists are compacted on the
/// device in an order that depends on the data alone; pixels that see no surface are never in them. [IPP §3.3] Render
/// thread.
class AdaptiveGrid {
 public:
  /// Compiles and warms the pipelines the first time; makes room for the size. Errors: "device", "out-of-memory".
  Result<void> prepare(vk::Device& device, const PlacementBuffers& buffers, uint32_t width, uint32_t height);

  /// Every pixel of the grid of `stride`. All of these wait for the device and give the length of the list.
  Result<uint32_t> selectGrid(vk::Device& device, const PlacementBuffers& buffers, uint32_t stride) const;
  /// Pixels of the grid of `stride` that are not sampled and incoherent, or that interpolation could not serve. A pixel
  /// beside another object has an incoherence of 1 at least; where a parent's light is no number it has no bound.
  Result<uint32_t> selectIncoherent(vk::Device& device, const PlacementBuffers& buffers, uint32_t stride,
                                    const CoherenceRule& rule) const;
  /// The share [first, first + count) of scatteredCount() places, spread over the whole picture: those not sampled yet,
  /// or all.
  Result<uint32_t> selectScattered(vk::Device& device, const PlacementBuffers& buffers, uint32_t first, uint32_t count,
                                   bool unsampledOnly) const;
  uint32_t scatteredCount() const { return scatteredCount(m_width, m_height); }

  /// Mean luminance of the light gathered on the grid of `stride`; 0 where it holds none.
  Result<double> meanLuminance(vk::Device& device, const PlacementBuffers& buffers, uint32_t stride) const;

 private:
  static uint32_t scatteredCount(uint32_t width, uint32_t height);
  uint32_t gridCount(uint32_t stride) const;
  std::vector<vk::Binding> bindings(const PlacementBuffers& buffers) const;
  Result<uint32_t> select(vk::Device& device, const PlacementBuffers& buffers, shared::SelectSitesPush push) const;

  gpu::Pass m_pass;
  vk::Buffer m_selection;
  uint32_t m_width = 0, m_height = 0;
};

}  // namespace limn
