#include "renderer/cache/block_metric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn {
namespace {

/// log2 of the lengths of the axes' images; minus infinity for what has no length.
glm::dvec3 octavesOf(const glm::dmat3& m) {
  glm::dvec3 octaves;
  for (int axis = 0; axis < 3; ++axis) {
    const double scale = glm::length(m[axis]);
    octaves[axis] = scale > 0.0 && std::isfinite(scale) ? std::log2(scale) : -std::numeric_limits<double>::infinity();
  }
  return octaves;
}

double roundedCosine(const glm::dvec3& a, const glm::dvec3& b) {
  const double lengths = glm::length(a) * glm::length(b);
  return lengths > 0.0 ? std::clamp(std::round(glm::dot(a, b) / lengths * kCosineSteps) / kCosineSteps, -1.0, 1.0)
                       : 0.0;
}

/// Unit images of the axes, their cosines rounded: x along (1,0,0), y in the upper xy-plane, z where the cosines say.
glm::dmat3 roundedAxes(const glm::dmat3& m) {
  const double xy = roundedCosine(m[0], m[1]), xz = roundedCosine(m[0], m[2]), yz = roundedCosine(m[1], m[2]);
  const glm::dvec3 x(1.0, 0.0, 0.0);
  const glm::dvec3 y(xy, std::sqrt(std::max(1.0 - xy * xy, 0.0)), 0.0);
  glm::dvec3 z(xz, 0.0, 0.0);
  if (y.y > 0.0) z.y = std::clamp((yz - xy * xz) / y.y, -1.0, 1.0);
  z.z = std::sqrt(std::max(1.0 - z.x * z.x - z.y * z.y, 0.0));
  return {x, y, z};
}

/// The axes times 2^octaves, these rounded to steps.
glm::dmat3 scaled(const glm::dmat3& axes, const glm::dvec3& octaves, double stepsPerOctave) {
  glm::dmat3 result;
  for (int axis = 0; axis < 3; ++axis)
    result[axis] = axes[axis] * std::exp2(std::round(octaves[axis] * stepsPerOctave) / stepsPerOctave);
  return result;
}

}  // namespace

glm::dmat3 roundedStretch(const glm::dmat3& linear) {
  return scaled(roundedAxes(linear), octavesOf(linear), kScaleStepsPerOctave);
}

glm::dmat3 roundedShape(const glm::dmat3& linear) {
  const glm::dvec3 octaves = octavesOf(linear);
  const double longest = std::max({octaves.x, octaves.y, octaves.z});
  if (!std::isfinite(longest)) return glm::dmat3(0.0);
  return scaled(roundedAxes(linear), octaves - longest, kShapeStepsPerOctave);
}

std::vector<glm::vec3> stretchedCorners(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                                        const glm::dmat3& stretch) {
  std::vector<glm::vec3> stretched(positions.size()), corners(indices.size());
  for (size_t i = 0; i < stretched.size(); ++i) stretched[i] = glm::vec3(stretch * glm::dvec3(positions[i]));
  for (size_t i = 0; i < corners.size(); ++i) corners[i] = stretched[indices[i]];
  return corners;
}

}  // namespace limn
