#pragma once
#include <array>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/film/film_image.hpp"
#include "renderer/vk/buffer.hpp"
#include "renderer/vk/command_recorder.hpp"

namespace limn {

/// Running means of every pixel on the device: radiance, its even-numbered half, second moment of its luminance, the direct
/// part, and what the first hit looks like. shaders/lib/film.glsl writes it. Render thread.
class Film {
 public:
  static Result<Film> create(vk::Device& device, uint32_t width, uint32_t height);

  uint32_t width() const { return m_width; }    ///< [pixel]
  uint32_t height() const { return m_height; }  ///< [pixel]
  uint32_t pixelCount() const { return m_width * m_height; }

  /// Records that no pixel has a sample. Only the counts are reset: a pixel's other words mean nothing while its count is 0.
  void recordClear(vk::CommandRecorder& recorder) const;
  /// Bindings BINDING_FILM_MEAN ... BINDING_FILM_NORMAL.
  std::vector<vk::Binding> bindings() const;

  /// All layers: beauty, direct, indirect, albedo, normal, depth, samples, error. Waits for the device.
  Result<FilmImage> read(vk::Device& device) const;
  /// Of every bit that sampling decided: means, halves, second moments and counts. Waits for the device.
  Result<uint64_t> hash(vk::Device& device) const;

 private:
  Result<std::vector<glm::vec4>> readPlane(vk::Device& device, size_t plane) const;

  static constexpr size_t kPlanes = 5;  ///< mean, half, direct, albedo, normal; in binding order
  uint32_t m_width = 0, m_height = 0;
  std::array<vk::Buffer, kPlanes> m_planes;
};

}  // namespace limn
