#pragma once
#include <memory>

#include <glm/glm.hpp>

#include "renderer/film/film_image.hpp"
#include "renderer/scene/scene.hpp"
#include "renderer/visibility/scene_tracer.hpp"
#include "renderer/vk/device.hpp"

namespace limn::test {

struct RenderOptions {
  uint32_t samples = 64;  ///< of every pixel
  uint32_t seed = 1;
  uint32_t maxBounces = 1000;  ///< closed forms know no limit
  uint32_t rouletteStart = 3;
  TraceMethod method = TraceMethod::best;
};

/// The path-tracing technique with a film of kSize x kSize and without the session about it, so that a program with
/// many small scenes compiles once.
class PathTracer {
 public:
  static constexpr uint32_t kSize = 16;  ///< [pixel]

  explicit PathTracer(vk::Device& device);
  ~PathTracer();

  /// All layers of the film. Aborts the program on errors.
  FilmImage render(const Scene& scene, const RenderOptions& options = {});

 private:
  struct Parts;
  std::unique_ptr<Parts> m_parts;
};

/// Mean over all pixels with its standard error, from the film's own error layer.
struct Measured {
  double mean = 0.0, error = 0.0;
};
/// Of the luminance of `layer`, a radiance layer; the error is that of beauty.
Measured measure(const FilmImage& image, const std::string& layer = "beauty");

/// Deviation in standard errors; what both know only to rounding (1e-4 relative) counts as equal.
double zScore(const Measured& measured, double expected);

}  // namespace limn::test
