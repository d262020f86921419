#pragma once
#include <vector>

#include "renderer/gpu/pass.hpp"
#include "shaders/shared/placement_shared.h"

namespace limn {

/// What reconstruction reads and writes: buffers of one picture.
struct ReconstructBuffers {
  const vk::Buffer& sites;     ///< shared::GatherSite, one a pixel
  const vk::Buffer& gathered;  ///< shared::IndirectTexel, one a pixel
  const vk::Buffer& filtered;  ///< the same, written by the filter
};

/// Rows of a grid, or of the picture, that one call works on.
struct RowRange {
  uint32_t first = 0, count = 0;
};

/// Joint bilateral upsampling of gathered light, and the filter after it: edges of position, normal and object are
/// kept, constants exactly; light that is no number stays where it is. [IPP §3.3, §4] Render thread.
class JointBilateral {
 public:
  /// Compiles and warms the pipelines the first time. Errors: "device", "out-of-memory".
  Result<void> prepare(vk::Device& device, const ReconstructBuffers& buffers, uint32_t width,
                       uint32_t height);

  /// Rows of the grid of `stride` [pixel].
  uint32_t gridRows(uint32_t stride) const { return (m_height + stride - 1) / stride; }
  /// Pixels of the grid of `stride` that are not sampled take their parents' light, on the grid of twice that. A count
  /// of kCountFar or kCountGuessed says that none of the four was on the same surface; the state is kIndirectNone where
  /// none had any light. Ends with a barrier.
  void recordInterpolate(vk::CommandRecorder& recorder, const ReconstructBuffers& buffers,
                         uint32_t stride) const;
  /// Filters rows of the picture into `filtered`; diffuse light over `size` x `size` pixels, glossy over 3x3 at most.
  /// `size` is odd; 1 copies. Guesses, and light that is no number, are replaced by what is around them.
  void recordFilter(vk::CommandRecorder& recorder, const ReconstructBuffers& buffers, uint32_t size,
                    RowRange rows) const;

 private:
  gpu::Pass m_interpolate, m_filter;
  uint32_t m_width = 0, m_height = 0;
};

}  // namespace limn
