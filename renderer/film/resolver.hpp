#pragma once
#include <vector>

#include "renderer/film/film.hpp"
#include "renderer/gpu/pass.hpp"
#include "renderer/scene/edit.hpp"

namespace limn {

/// Film to display values: exposure, tone map, sRGB; pixels without samples are filled from the coarse grid. Render thread.
class Resolver {
 public:
  /// Its pipeline is compiled and warm afterwards, and serves every size.
  static Result<Resolver> create(vk::Device& device, const Film& film);
  /// For a film of another size. Nothing is compiled.
  Result<void> resize(vk::Device& device, const Film& film);
  /// RGBA8, sRGB-encoded, row 0 on top. `stride` is the grid on which every pixel has a sample [pixel]; 0: no filling.
  /// `indirect` holds a shared::IndirectTexel of every pixel, whose states the view `placement` shows; null where nothing is
  /// interpolated. Waits for the device.
  Result<std::vector<uint8_t>> resolve(vk::Device& device, const Film& film, const ResolveSettings& settings,
                                       uint32_t stride, const vk::Buffer* indirect = nullptr);

 private:
  gpu::Pass m_pass;
  vk::Buffer m_output;
  vk::Buffer m_noIndirect;  ///< bound where nothing is interpolated
};

}  // namespace limn
