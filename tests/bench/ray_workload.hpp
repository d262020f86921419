#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace limn::bench {

/// As in shaders/bench/trace_rays.comp.
struct Ray {
  glm::vec3 originR{0};
  float tMax = 1e30f;
  glm::vec3 dirR{0, 0, 1};
  uint32_t alphaState = 0;
};
struct RayHit {
  float t;
  uint32_t triangle;  ///< kNoTriangle on a miss; any-hit tracing says 0 for whatever it met
  glm::vec2 barycentrics;
};

enum class RayKind { camera, shadow, bounce };
inline constexpr std::array kRayKinds{RayKind::camera, RayKind::shadow, RayKind::bounce};
constexpr const char* name(RayKind kind) {
  return kind == RayKind::camera ? "camera" : kind == RayKind::shadow ? "shadow" : "bounce";
}
/// Shadow rays only ask whether anything is hit.
constexpr bool asksAny(RayKind kind) { return kind == RayKind::shadow; }

/// A box that is open to the camera, with three bumpy spheres of about `triangleCount` triangles in all: 3 corners a
/// triangle.
std::vector<glm::vec3> makeScene(uint32_t triangleCount);

/// One ray through each pixel of a size × size image, in 8x8 tiles, tiles in Morton order inside squares of 32x32, the
/// squares spread so that equal shares of the list are equal work (lavapipe gives each thread one contiguous share).
std::vector<Ray> cameraRays(uint32_t size);

/// From where camera rays hit (misses leave none): to a point under the ceiling, and about the normal by the cosine.
std::vector<Ray> shadowRays(const std::vector<glm::vec3>& corners, const std::vector<Ray>& camera,
                            const std::vector<RayHit>& hits);
std::vector<Ray> bounceRays(const std::vector<glm::vec3>& corners, const std::vector<Ray>& camera,
                            const std::vector<RayHit>& hits);

}  // namespace limn::bench
