#include "tests/bench/ray_workload.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

#include "shaders/shared/bvh_shared.h"

namespace limn::bench {
namespace {

void addQuad(std::vector<glm::vec3>& corners, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  corners.insert(corners.end(), {a, b, c, a, c, d});
}

void addBumpySphere(std::vector<glm::vec3>& corners, glm::vec3 center, float radius, int latitudes) {
  auto at = [&](int i, int j) {
    const float theta = glm::pi<float>() * float(i) / float(latitudes),
                phi = glm::pi<float>() * float(j) / float(latitudes);
    const float r = radius * (1 + 0.08f * std::sin(9 * theta) * std::sin(11 * phi));
    return center + r * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  };
  for (int i = 0; i < latitudes; ++i) {
    for (int j = 0; j < 2 * latitudes; ++j) addQuad(corners, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
}

// Every second bit of a Morton index.
uint32_t deinterleave(uint32_t x) {
  uint32_t result = 0;
  for (int bit = 0; bit < 16; ++bit) result |= (x >> (2 * bit) & 1u) << bit;
  return result;
}

struct SurfacePoint {
  glm::vec3 posR;
  glm::vec3 normal;  // towards the camera
};

template <class Function>
void forEachHit(const std::vector<glm::vec3>& corners, const std::vector<Ray>& camera, const std::vector<RayHit>& hits,
                Function function) {
  for (size_t i = 0; i < camera.size(); ++i) {
    if (hits[i].triangle == shared::kNoTriangle) continue;
    const glm::vec3* c = &corners[3 * size_t(hits[i].triangle)];
    glm::vec3 normal = glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
    if (glm::dot(normal, camera[i].dirR) > 0) normal = -normal;
    function(SurfacePoint{camera[i].originR + camera[i].dirR * hits[i].t + normal * 1e-3f, normal});
  }
}

}  // namespace

std::vector<glm::vec3> makeScene(uint32_t triangleCount) {
  std::vector<glm::vec3> corners;
  addQuad(corners, {-1, -1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1});
  addQuad(corners, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}, {1, 1, -1});
  addQuad(corners, {-1, -1, -1}, {-1, 1, -1}, {1, 1, -1}, {1, -1, -1});
  addQuad(corners, {-1, -1, -1}, {-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1});
  addQuad(corners, {1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1});
  const int latitudes = int(std::sqrt(triangleCount / 12.0));
  addBumpySphere(corners, {-0.4f, -0.5f, -0.2f}, 0.45f, latitudes);
  addBumpySphere(corners, {0.45f, -0.6f, 0.3f}, 0.35f, latitudes);
  addBumpySphere(corners, {0.1f, 0.2f, -0.4f}, 0.3f, latitudes);
  return corners;
}

std::vector<Ray> cameraRays(uint32_t size) {
  constexpr uint32_t kSquare = 32 * 32, kSpread = 16;
  const uint32_t squares = size * size / kSquare;
  std::vector<Ray> rays(size_t(size) * size);
  for (uint32_t i = 0; i < rays.size(); ++i) {
    const uint32_t place = i / kSquare, perRun = squares / kSpread;
    const uint32_t morton = (place % perRun * kSpread + place / perRun) * kSquare + i % kSquare;
    const glm::vec2 pixel = {float(deinterleave(morton)) + 0.5f, float(deinterleave(morton >> 1)) + 0.5f};
    const glm::vec2 plane = (pixel / float(size) * 2.0f - 1.0f) * 0.5f;
    rays[i] = {{0, 0, 3.2f}, 1e30f, glm::normalize(glm::vec3(plane.x, -plane.y, -1)), 0};
  }
  return rays;
}

std::vector<Ray> shadowRays(const std::vector<glm::vec3>& corners, const std::vector<Ray>& camera,
                            const std::vector<RayHit>& hits) {
  std::vector<Ray> rays;
  forEachHit(corners, camera, hits, [&](const SurfacePoint& p) {
    const glm::vec3 toLight = glm::vec3(0.3f, 0.9f, 0.3f) - p.posR;
    rays.push_back({p.posR, glm::length(toLight), glm::normalize(toLight), 0});
  });
  return rays;
}

std::vector<Ray> bounceRays(const std::vector<glm::vec3>& corners, const std::vector<Ray>& camera,
                            const std::vector<RayHit>& hits) {
  std::vector<Ray> rays;
  std::mt19937 random(1);
  auto unit = [&] { return float(random() >> 8) * 0x1p-24f; };
  forEachHit(corners, camera, hits, [&](const SurfacePoint& p) {
    const float phi = 2 * glm::pi<float>() * unit(), sinTheta = std::sqrt(unit());
    const glm::vec3 other = std::abs(p.normal.x) > 0.5f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 tangent = glm::normalize(glm::cross(p.normal, other)), bitangent = glm::cross(p.normal, tangent);
    const float cosTheta = std::sqrt(std::max(0.0f, 1 - sinTheta * sinTheta));
    rays.push_back(
        {p.posR, 1e30f, sinTheta * (std::cos(phi) * tangent + std::sin(phi) * bitangent) + cosTheta * p.normal, 0});
  });
  return rays;
}

}  // namespace limn::bench
