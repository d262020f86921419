#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <random>
#include <vector>

#include "renderer/visibility/bvh.hpp"

namespace limn::test {

/// One block's triangles; they own what TriangleBlock only points to.
struct Object {
  std::vector<glm::vec3> corners;
  bool alphaTested = false;
};

/// As in shaders/bench/trace_rays.comp.
struct Ray {
  glm::vec3 originR{0};
  float tMax = 1e30f;
  glm::vec3 dirR{0, 0, 1};
  uint32_t alphaState = 0;
};
struct RayHit {
  float t;
  uint32_t triangle;
  glm::vec2 barycentrics;
};

struct Soup {
  std::vector<Object> objects;

  std::vector<TriangleBlock> blocks() const {
    std::vector<TriangleBlock> result;
    uint32_t first = 0;
    for (const Object& object : objects) {
      result.push_back({object.corners, first, object.alphaTested});
      first += uint32_t(object.corners.size() / 3);
    }
    return result;
  }
  /// Corners by global triangle id.
  std::vector<glm::vec3> corners() const {
    std::vector<glm::vec3> all;
    for (const Object& object : objects) all.insert(all.end(), object.corners.begin(), object.corners.end());
    return all;
  }
};

class Random {
 public:
  explicit Random(uint32_t seed) : m_engine(seed) {}
  uint32_t below(uint32_t n) { return uint32_t(m_engine() % n); }
  float unit() { return float(m_engine() >> 8) * 0x1p-24f; }
  float between(float a, float b) { return a + (b - a) * unit(); }
  glm::vec3 inCube() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
  glm::vec3 direction() {
    for (;;) {
      const glm::vec3 v = inCube();
      if (const float length = glm::length(v); length > 0.1f && length < 1) return v / length;
    }
  }

 private:
  std::mt19937 m_engine;
};

/// Triangles of every awkward kind around the origin, in a cube of half size 1.
inline Object randomObject(Random& random, uint32_t triangles) {
  Object object;
  while (object.corners.size() < 3 * size_t(triangles)) {
    const glm::vec3 a = random.inCube(), u = random.inCube() * 0.3f, v = random.inCube() * 0.3f;
    auto add = [&](glm::vec3 x, glm::vec3 y, glm::vec3 z) { object.corners.insert(object.corners.end(), {x, y, z}); };
    switch (random.below(9)) {
      case 0: add(a, a, a); break;                                       // a point
      case 1: add(a, a + u, a + u); break;                               // a line
      case 2: add(a, a + 3.0f * u, a + 3.0f * u + v * 1e-4f); break;     // a needle
      case 3: add({a.x, a.y, 0.25f}, {a.x + 0.5f, a.y, 0.25f}, {a.x, a.y + 0.5f, 0.25f}); break;  // in one plane
      case 4: {                                                          // flat in an axis
        const int axis = int(random.below(3));
        glm::vec3 b = a + u, c = a + v;
        b[axis] = c[axis] = a[axis];
        add(a, b, c);
        break;
      }
      case 5: {                                                          // again
        if (object.corners.empty()) break;
        const size_t i = 3 * size_t(random.below(uint32_t(object.corners.size() / 3)));
        add(object.corners[i], object.corners[i + 1], object.corners[i + 2]);
        break;
      }
      case 6: add(a * 4.0f, (a + u) * 4.0f, (a + v) * 4.0f); break;      // large
      default: add(a, a + u, a + v);
    }
  }
  object.corners.resize(3 * size_t(triangles));
  return object;
}

/// Objects of awkward triangles, some empty, at a random scale and distance from the origin.
inline Soup randomSoup(uint32_t seed) {
  Random random(seed);
  Soup soup;
  const float scale = std::pow(10.0f, random.between(-6, 6));
  const glm::vec3 offset = random.inCube() * (random.below(2) ? 1e3f : 0.0f) * scale;
  const uint32_t objects = 1 + random.below(20);
  for (uint32_t i = 0; i < objects; ++i) {
    Object object = randomObject(random, random.below(5) ? random.below(100) : 0);
    const glm::vec3 place = random.inCube() * 2.0f;
    for (glm::vec3& corner : object.corners) corner = (corner + place) * scale + offset;
    object.alphaTested = random.below(3) == 0;
    soup.objects.push_back(std::move(object));
  }
  return soup;
}

/// A closed sphere-like surface with radius around 1: latitudes × 2·latitudes quads, each of two triangles.
inline Object bumpySphere(glm::vec3 center, float radius, int latitudes) {
  Object object;
  auto at = [&](int i, int j) {
    const double theta = glm::pi<double>() * i / latitudes, phi = glm::pi<double>() * (j % (2 * latitudes)) / latitudes;
    const double r = i == 0 || i == latitudes ? 1 : 1 + 0.08 * std::sin(9 * theta) * std::sin(11 * phi);
    const glm::dvec3 v = i == 0 ? glm::dvec3(0, 1, 0) : i == latitudes ? glm::dvec3(0, -1, 0) :
        glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
    return center + radius * glm::vec3(r * v);
  };
  for (int i = 0; i < latitudes; ++i) {
    for (int j = 0; j < 2 * latitudes; ++j) {
      if (i + 1 < latitudes) object.corners.insert(object.corners.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      if (i > 0) object.corners.insert(object.corners.end(), {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return object;
}

/// Rays at, along, beside and away from the soup: also parallel to axes, through corners and edges, of any length.
inline std::vector<Ray> randomRays(const Soup& soup, uint32_t seed, uint32_t count) {
  Random random(seed ^ 0x9e3779b9u);
  const std::vector<glm::vec3> corners = soup.corners();
  Box bounds;
  for (const glm::vec3& corner : corners) bounds.add(corner);
  if (corners.empty()) bounds = {glm::vec3(-1), glm::vec3(1)};
  const glm::vec3 center = (bounds.lower + bounds.upper) * 0.5f;
  const float size = glm::length(bounds.upper - bounds.lower);

  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.originR = center + random.inCube() * size * (random.below(8) == 0 ? 30.0f : 0.7f);
    ray.dirR = random.direction();
    if (!corners.empty() && random.below(4) > 0) {
      const size_t i = 3 * size_t(random.below(uint32_t(corners.size() / 3)));
      float u = random.unit(), v = random.unit() * (1 - u);
      if (random.below(6) == 0) v = 0;
      if (random.below(8) == 0) u = v = 0;
      const glm::vec3 aim = corners[i] * (1 - u - v) + corners[i + 1] * u + corners[i + 2] * v;
      if (random.below(5) == 0) {
        const int axis = int(random.below(3));
        ray.originR = aim;
        ray.originR[axis] += random.between(-size, size);
        ray.dirR = glm::vec3(random.below(2) ? 0.0f : -0.0f);
        ray.dirR[axis] = aim[axis] > ray.originR[axis] ? 1.0f : -1.0f;
      } else if (glm::length(aim - ray.originR) > 0) {
        ray.dirR = glm::normalize(aim - ray.originR);
      }
    }
    if (random.below(4) == 0) ray.dirR *= random.between(0.01f, 100.0f);
    ray.tMax = random.below(4) == 0 ? size * random.unit() : 1e30f;
  }
  return rays;
}

}  // namespace limn::test
