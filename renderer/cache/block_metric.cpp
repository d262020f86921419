#include "renderer/cache/block_metric.hpp"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

double roundedScale(double scale) {
  if (!(scale > 0.0) || !std::isfinite(scale)) return 0.0;
  return std::exp2(std::round(std::log2(scale) * kScaleStepsPerOctave) / kScaleStepsPerOctave);
}

double roundedCosine(const glm::dvec3& a, const glm::dvec3& b) {
  const double lengths = glm::length(a) * glm::length(b);
  return lengths > 0.0 ? std::clamp(std::round(glm::dot(a, b) / lengths * kCosineSteps) / kCosineSteps, -1.0, 1.0)
                       : 0.0;
}

}  // namespace

glm::dmat3 roundedStretch(const glm::dmat3& m) {
  // Unit images of the axes first: x along (1,0,0), y in the upper xy-plane, z where the cosines say.
  const double xy = roundedCosine(m[0], m[1]), xz = roundedCosine(m[0], m[2]), yz = roundedCosine(m[1], m[2]);
  const glm::dvec3 x(1.0, 0.0, 0.0);
  const glm::dvec3 y(xy, std::sqrt(std::max(1.0 - xy * xy, 0.0)), 0.0);
  glm::dvec3 z(xz, 0.0, 0.0);
  if (y.y > 0.0) z.y = std::clamp((yz - xy * xz) / y.y, -1.0, 1.0);
  z.z = std::sqrt(std::max(1.0 - z.x * z.x - z.y * z.y, 0.0));
  return {x * roundedScale(glm::length(m[0])), y * roundedScale(glm::length(m[1])),
          z * roundedScale(glm::length(m[2]))};
}

std::vector<glm::vec3> stretchedCorners(const Primitive& primitive, const glm::dmat3& stretch) {
  std::vector<glm::vec3> stretched(primitive.positions.size()), corners(primitive.indices.size());
  for (size_t i = 0; i < stretched.size(); ++i) stretched[i] = glm::vec3(stretch * glm::dvec3(primitive.positions[i]));
  for (size_t i = 0; i < corners.size(); ++i) corners[i] = stretched[primitive.indices[i]];
  return corners;
}

}  // namespace limn
