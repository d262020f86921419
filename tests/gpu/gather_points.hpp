#pragma once
#include <algorithm>
#include <bit>
#include <random>
#include <vector>

#include "renderer/gpu/packing.hpp"
#include "shaders/shared/point_shared.h"

namespace limn::test {

/// A made-up surface point with the light that leaves both of its sides.
struct LitPoint {
  glm::vec3 posR, normal;
  glm::vec3 front{0.0f}, back{0.0f};  ///< [W·sr⁻¹·m⁻²]
};

/// Points of a parallelogram with a corner `a`, jittered in a grid of n x n; they face the cross product of the edges.
inline std::vector<LitPoint> parallelogram(glm::vec3 a, glm::vec3 u, glm::vec3 v, uint32_t n, glm::vec3 radiance) {
  std::mt19937 random(n);
  std::uniform_real_distribution<float> jitter(0.1f, 0.9f);
  std::vector<LitPoint> all;
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t j = 0; j < n; ++j) {
      const float x = (float(i) + jitter(random)) / float(n), y = (float(j) + jitter(random)) / float(n);
      all.push_back({a + u * x + v * y, glm::normalize(glm::cross(u, v)), radiance, radiance});
    }
  return all;
}

inline void append(std::vector<LitPoint>& all, const std::vector<LitPoint>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// The inside of a box around the origin, n x n points a face; `radiance` of each of -x, x, -y, y, -z, z.
inline std::vector<LitPoint> boxPoints(float half, uint32_t n, const std::vector<glm::vec3>& radiance) {
  std::vector<LitPoint> all;
  for (int face = 0; face < 6; ++face) {
    glm::vec3 n0(0.0f), u(0.0f), v(0.0f);
    n0[face / 2] = face % 2 ? half : -half;
    u[(face / 2 + 1) % 3] = 2 * half;
    v[(face / 2 + 2) % 3] = 2 * half;
    if (face % 2) std::swap(u, v);
    append(all, parallelogram(n0 - 0.5f * (u + v), u, v, n, radiance[size_t(face)]));
  }
  return all;
}

/// Points of a sphere seen from the inside, on a spiral.
inline std::vector<LitPoint> spherePoints(glm::vec3 center, float radius, uint32_t count, glm::vec3 radiance) {
  std::vector<LitPoint> all;
  for (uint32_t i = 0; i < count; ++i) {
    const float y = 1.0f - 2.0f * (float(i) + 0.5f) / float(count), r = std::sqrt(1.0f - y * y);
    const float phi = 2.39996323f * float(i);
    const glm::vec3 d(r * std::cos(phi), y, r * std::sin(phi));
    all.push_back({center + radius * d, -d, radiance, radiance});
  }
  return all;
}

/// Splits at medians until clusters are left, and on within them: the order inside is that of reversed bits, so that
/// its first points are spread over the cluster. The count becomes the next power of two by repeating points.
inline std::vector<LitPoint> clusterMajor(std::vector<LitPoint> points, uint32_t clusters) {
  const size_t given = points.size(), count = std::max<size_t>(std::bit_ceil(given), clusters);
  for (size_t i = given; i < count; ++i) points.push_back(points[(i * 7919) % given]);
  for (size_t width = count; width > 1; width /= 2)
    for (size_t first = 0; first < count; first += width) {
      glm::vec3 low(3e38f), high(-3e38f);
      for (size_t i = first; i < first + width; ++i) {
        low = glm::min(low, points[i].posR);
        high = glm::max(high, points[i].posR);
      }
      const glm::vec3 e = high - low;
      const int axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
      const auto begin = points.begin() + long(first);
      std::nth_element(begin, begin + long(width / 2), begin + long(width),
                       [axis](const LitPoint& a, const LitPoint& b) { return a.posR[axis] < b.posR[axis]; });
    }
  const size_t size = count / clusters;
  std::vector<LitPoint> ordered(count);
  for (size_t i = 0; i < count; ++i) {
    size_t slot = i % size, reversed = 0;
    for (size_t bit = 1; bit < size; bit *= 2) reversed = reversed * 2 + (slot & bit ? 1 : 0);
    ordered[i / size * size + reversed] = points[i];
  }
  return ordered;
}

inline std::vector<shared::SurfacePoint> pointWords(const std::vector<LitPoint>& points) {
  std::vector<shared::SurfacePoint> words;
  for (const LitPoint& p : points) words.push_back({p.posR, gpu::octEncode(p.normal)});
  return words;
}
inline std::vector<glm::vec4> radianceWords(const std::vector<LitPoint>& points, float lobes = 0.0f) {
  std::vector<glm::vec4> words;
  for (const LitPoint& p : points) {
    words.emplace_back(p.front, lobes);
    words.emplace_back(p.back, lobes);
  }
  return words;
}

}  // namespace limn::test
