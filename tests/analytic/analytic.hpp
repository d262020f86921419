#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/closed_form.hpp"
#include "tests/support/path_tracer.hpp"
#include "tests/support/shared_device.hpp"
#include "tests/support/statistics.hpp"

namespace limn::test {

/// Of one comparison: about eighty in these programs, so that all together err by chance in one of 75 seeds.
constexpr double kLevel = 0.01 / 60;

inline FilmImage render(const SceneBuilder& builder, const RenderOptions& options = {}) {
  static std::unique_ptr<PathTracer> tracer;
  if (!tracer) {
    tracer = std::make_unique<PathTracer>(SharedDevice::get());
    SharedDevice::atEnd([] { tracer.reset(); });
  }
  return tracer->render(builder.scene, options);
}

/// The picture's mean is `expected` by a z-test, and within `relative` of it: stratified samples err less than they
/// know. `model` is a relative error that the scene itself makes, such as a tessellation's.
inline void expectMean(const FilmImage& image, double expected, double relative = 0.01, double model = 0.0,
                       const std::string& layer = "beauty") {
  Measured m = measure(image, layer);
  EXPECT_NEAR(m.mean, expected, (relative + model) * expected) << "standard error " << m.error;
  m.mean += std::clamp(expected - m.mean, -model * expected, model * expected);
  const double z = zScore(m, expected);
  EXPECT_GT(normalTails(z), kLevel) << m.mean << " for " << expected << ", z = " << z;
}

/// Irradiance at `p` under normal `n` of a polygon of radiance 1 above its horizon. [Lambert 1760]
inline double polygonIrradiance(const glm::dvec3& p, const glm::dvec3& n, const std::vector<glm::dvec3>& corners) {
  double sum = 0.0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - p), b = glm::normalize(corners[(i + 1) % corners.size()] - p);
    sum += std::acos(glm::dot(a, b)) * glm::dot(n, glm::normalize(glm::cross(a, b)));
  }
  return std::abs(0.5 * sum);
}

}  // namespace limn::test
