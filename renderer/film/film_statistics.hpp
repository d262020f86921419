#pragma once
#include <limits>

#include "renderer/film/film.hpp"
#include "renderer/gpu/pass.hpp"
#include "shaders/shared/film_shared.h"

namespace limn {

/// How wrong the film is likely to be: relMSE = mean((a−r)² / (r² + 0.01·mean(r)²)) against the unknown truth r, without the
/// 0.1 % largest quotients, as `limn compare` says it.
struct FilmError {
  double relMse = std::numeric_limits<double>::infinity();  ///< infinity while it cannot be told
  double low = 0.0, high = std::numeric_limits<double>::infinity();  ///< 95 % interval
};

/// Estimates the film's error from its two half buffers, and lists the pixels that need more samples. Render thread.
class FilmStatistics {
 public:
  static Result<FilmStatistics> create(vk::Device& device, const Film& film);
  /// For a film of another size; the pipelines stay.
  Result<void> resize(vk::Device& device, const Film& film);
  struct Means {
    double samples = 0.0;     ///< per pixel
    double radiance = 0.0;    ///< of all pixels and channels [W·sr⁻¹·m⁻²]
  };
  /// Waits for the device, as all that follow.
  Result<Means> means(vk::Device& device, const Film& film);
  /// The noise alone: what both halves share, as the bias of a technique, is not seen. `meanRadiance` is Means'.
  Result<FilmError> estimate(vk::Device& device, const Film& film, double meanRadiance);
  /// Writes into `pixelList` (storage, one word a pixel) the pixels whose neighbourhood has not `minSamples` yet or a relative
  /// standard error over `threshold`; returns how many there are.
  Result<uint32_t> selectPixels(vk::Device& device, const Film& film, const vk::Buffer& pixelList, uint32_t minSamples,
                                float threshold, double meanRadiance);

 private:
  std::vector<vk::Binding> errorBindings(const Film& film) const;
  Result<void> runError(vk::Device& device, const Film& film, shared::FilmErrorPush push);

  uint32_t m_tilesX = 0, m_tilesY = 0;
  gpu::Pass m_error, m_select;
  vk::Buffer m_tileErrors, m_tileCounts, m_errorSizes;
};

}  // namespace limn
