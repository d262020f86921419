#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>

#include "tests/gpu/bvh_scenes.hpp"

namespace limn::test {

/// A ray and a triangle in double precision, seen along the ray: x and y across, z the ray parameter.
struct Crossing {
  glm::dvec3 corners[3];
  double tolerance = 0;  ///< [m]: what rounding in float may move a corner or the origin across the ray
  double drift = 0;      ///< [m]: what rounding may move the interpolated point; much in a needle
  double slope = 0;      ///< how much z changes at most when the ray moves by 1 m across
  double inside = 0;     ///< [m] from the ray to the nearest edge, negative outside
  double t = 0;
  glm::dvec2 barycentrics{0};
  bool edgeOn = true;    ///< the rest means nothing: the ray lies in the triangle's plane, or there is no plane
};

inline Crossing cross(const Ray& ray, std::span<const glm::vec3> corners) {
  const glm::dvec3 origin = ray.originR, dir = ray.dirR;
  const glm::dvec3 axis = glm::normalize(dir);
  const glm::dvec3 across = glm::normalize(std::abs(axis.x) > 0.7 ? glm::cross(axis, glm::dvec3(0, 1, 0))
                                                                  : glm::cross(axis, glm::dvec3(1, 0, 0)));
  const glm::dvec3 up = glm::cross(axis, across);
  Crossing c;
  double magnitude = 0;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 p = glm::dvec3(corners[size_t(i)]) - origin;
    c.corners[i] = {glm::dot(p, across), glm::dot(p, up), glm::dot(p, dir) / glm::dot(dir, dir)};
    magnitude = std::max(magnitude, glm::length(p));
  }
  c.tolerance = 2e-6 * magnitude;
  const glm::dvec3 &a = c.corners[0], &b = c.corners[1], &d = c.corners[2];
  auto edge = [](const glm::dvec3& p, const glm::dvec3& q) { return p.x * q.y - p.y * q.x; };
  const double u = edge(b, d), v = edge(d, a), w = edge(a, b), area = u + v + w;
  if (std::abs(area) <= 1e-300) return c;
  double reach = 0;
  for (const glm::dvec3& p : c.corners) reach = std::max(reach, glm::length(glm::dvec2(p)) + c.tolerance);
  c.drift = c.tolerance * (1 + reach * reach / std::abs(area)) + 5e-7 * reach * reach * reach / std::abs(area);
  c.edgeOn = false;
  const double sign = area < 0 ? -1 : 1;
  auto length = [](const glm::dvec3& p, const glm::dvec3& q) { return glm::length(glm::dvec2(p) - glm::dvec2(q)); };
  c.inside = std::min({sign * u / length(b, d), sign * v / length(d, a), sign * w / length(a, b)});
  c.t = (u * a.z + v * b.z + w * d.z) / area;
  c.barycentrics = {v / area, w / area};
  const glm::dvec2 e1 = glm::dvec2(b) - glm::dvec2(a), e2 = glm::dvec2(d) - glm::dvec2(a);
  const glm::dvec2 gradient =
      glm::dvec2(e2.y * (b.z - a.z) - e1.y * (d.z - a.z), e1.x * (d.z - a.z) - e2.x * (b.z - a.z)) / area;
  c.slope = glm::length(gradient);
  return c;
}

using Accepts = std::function<std::optional<bool>(uint32_t triangle, glm::dvec2 barycentrics)>;

/// What is wrong with `hit` as the closest hit of `ray`, beyond what rounding in float explains; empty when nothing is.
/// `accepts` may leave a hit open (nullopt), which then is neither demanded nor refused.
inline std::string judge(const Ray& ray, const RayHit& hit, std::span<const glm::vec3> corners,
                         const Accepts& accepts = {}) {
  const double length = glm::length(glm::dvec3(ray.dirR));
  const uint32_t count = uint32_t(corners.size() / 3);
  const double found = hit.triangle == shared::kNoTriangle ? double(ray.tMax) : double(hit.t);
  if (hit.triangle != shared::kNoTriangle) {
    if (hit.triangle >= count) return "no such triangle: " + std::to_string(hit.triangle);
    const auto c = corners.subspan(3 * size_t(hit.triangle), 3);
    const glm::dvec2 w = hit.barycentrics;
    if (w.x < -1e-6 || w.y < -1e-6 || w.x + w.y > 1 + 1e-6) return "barycentrics outside";
    if (!(hit.t > 0 && hit.t < ray.tMax)) return "t outside the interval";
    const glm::dvec3 onTriangle = glm::dvec3(c[0]) * (1 - w.x - w.y) + glm::dvec3(c[1]) * w.x + glm::dvec3(c[2]) * w.y;
    const glm::dvec3 onRay = glm::dvec3(ray.originR) + double(hit.t) * glm::dvec3(ray.dirR);
    const Crossing crossing = cross(ray, c);
    const double allowed = crossing.drift * (1 + length * crossing.slope);
    if (glm::length(onTriangle - onRay) > allowed) {
      return "the ray's point is " + std::to_string(glm::length(onTriangle - onRay) / allowed) +
             " tolerances off the triangle's";
    }
    if (accepts && accepts(hit.triangle, w) == false) return "a hit that alphaAccepts refuses";
  }
  for (uint32_t i = 0; i < count; ++i) {
    const Crossing c = cross(ray, corners.subspan(3 * size_t(i), 3));
    if (c.edgeOn || c.inside <= c.tolerance) continue;
    const double tTolerance = c.drift * (c.slope + 1 / length);
    if (c.t <= tTolerance || c.t >= found - tTolerance - 1e-6 * found) continue;
    if (accepts && accepts(i, c.barycentrics) != true) continue;
    return "triangle " + std::to_string(i) + " at t " + std::to_string(c.t) + " was overlooked for t " +
           std::to_string(found);
  }
  return {};
}

}  // namespace limn::test
