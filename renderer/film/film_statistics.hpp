#pragma once
#include <limits>

#include "renderer/film/film.hpp"
#include "renderer/gpu/pass.hpp"

namespace limn {

/// How wrong the film is likely to be: relMSE = mean((a−r)² / (r² + 0.01·mean(r)²)) against the unknown truth.
struct FilmError {
  double relMse = 0.0;        ///< infinity while no pixel has two samples
  double low = 0.0, high = 0.0;  ///< 95 % interval, from the spread of the tiles
  double meanSamples = 0.0;   ///< per pixel
  double meanValue = 0.0;     ///< of all pixels and channels [W·sr⁻¹·m⁻²]

  /// Keeps the means alone: the error may be anything.
  void withhold() {
    low = 0.0;
    relMse = high = std::numeric_limits<double>::infinity();
  }
};

/// Estimates the film's error from its two half buffers, and lists the pixels that need more samples. Render thread.
class FilmStatistics {
 public:
  static Result<FilmStatistics> create(vk::Device& device, const Film& film);
  /// For a film of another size; the pipelines stay.
  Result<void> resize(vk::Device& device, const Film& film);
  /// Waits for the device.
  Result<FilmError> estimate(vk::Device& device, const Film& film);
  /// Writes into `pixelList` (storage, one word a pixel) the pixels whose neighbourhood has not `minSamples` yet or a relative
  /// standard error over `threshold`; returns how many there are. `meanValue` is FilmError's. Waits for the device.
  Result<uint32_t> selectPixels(vk::Device& device, const Film& film, const vk::Buffer& pixelList, uint32_t minSamples,
                                float threshold, double meanValue);

 private:
  uint32_t m_tilesX = 0, m_tilesY = 0;
  gpu::Pass m_error, m_select;
  vk::Buffer m_tileErrors, m_tileCounts;
};

}  // namespace limn
