#include "renderer/gpu/camera.hpp"

#include <algorithm>
#include <cmath>

namespace limn::gpu {

shared::CameraData cameraData(const View& view, const glm::dvec3& renderOrigin, uint32_t width, uint32_t height) {
  const glm::dvec3 forward = glm::normalize(view.target - view.eye);
  glm::dvec3 right = glm::cross(forward, view.up);
  if (!(glm::length(right) > 1e-9))
    right = glm::cross(forward, std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
  right = glm::normalize(right);
  const glm::dvec3 up = glm::cross(right, forward);
  const double halfHeight = view.lens.perspective ? std::tan(view.lens.yfov * 0.5) : double(view.lens.ymag);
  const double halfWidth = halfHeight * width / height;
  shared::CameraData data{};
  data.eyeR = glm::vec3(view.eye - renderOrigin);
  // An eye on a surface sees the side that it looks to.
  const double rounding = 16.0 / 16777216.0 * std::max({std::abs(data.eyeR.x), std::abs(data.eyeR.y), std::abs(data.eyeR.z)});
  data.clipNear = std::max(view.lens.znear, float(rounding));
  data.right = glm::vec3(right * halfWidth);
  data.perspective = view.lens.perspective ? 1 : 0;
  data.up = glm::vec3(up * halfHeight);
  data.width = width;
  data.forward = glm::vec3(forward);
  data.height = height;
  return data;
}

}  // namespace limn::gpu
