#pragma once
#include <cmath>
#include <functional>
#include <numbers>

#include "tests/support/scene_builder.hpp"

namespace limn::test {

constexpr double kPi = std::numbers::pi;

/// All rays parallel and within `halfHeight` of the axis: a picture of one point under one direction.
inline void lookParallel(SceneBuilder& b, glm::dvec3 eye, glm::dvec3 target, float halfHeight,
                         glm::dvec3 up = {0, 1, 0}) {
  b.look(eye, target, 0.5f, up);
  b.scene.view.lens.perspective = false;
  b.scene.view.lens.ymag = halfHeight;
}

/// A horizontal square about the origin, facing up.
inline uint32_t floorOf(SceneBuilder& b, uint32_t material, float half) {
  return b.quad(material, {-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half});
}

/// Mean of f over the unit square by the midpoint rule.
inline double quadrature(int n, const std::function<double(double, double)>& f) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) sum += f((i + 0.5) / n, (j + 0.5) / n);
  return sum / (double(n) * n);
}

/// Share of unpolarised light that a smooth surface of index `ior` reflects at a cosine. [Fresnel]
inline double fresnel(double cosine, double ior) {
  const double t = std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));
  const double s = (cosine - ior * t) / (cosine + ior * t), p = (ior * cosine - t) / (ior * cosine + t);
  return 0.5 * (s * s + p * p);
}

/// Fresnel's factor as glTF takes it. [Schlick 1994]
inline double schlick(double cosine, double f0) { return f0 + (1 - f0) * std::pow(1 - cosine, 5); }

/// GGX with height-correlated Smith shadowing in double precision, written from [Heitz 2014].
struct Ggx {
  double alpha;
  double lambda(const glm::dvec3& w) const {
    const double tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 0.5 * (std::sqrt(1 + alpha * alpha * tan2) - 1);
  }
  double d(const glm::dvec3& h) const {
    const double x = h.x / alpha, y = h.y / alpha, s = x * x + y * y + h.z * h.z;
    return 1 / (kPi * alpha * alpha * s * s);
  }
  /// Reflected radiance per irradiance for a Fresnel factor of 1.
  double brdf(const glm::dvec3& o, const glm::dvec3& i) const {
    if (o.z <= 0 || i.z <= 0) return 0;
    return d(glm::normalize(o + i)) / (1 + lambda(o) + lambda(i)) / (4 * o.z * i.z);
  }
  /// Share of the light of a white sky that goes to a viewer at this cosine, by microfacets that reflect `fresnel` of the
  /// cosine with them; n² directions.
  double albedo(double cosine, const std::function<double(double)>& fresnel = [](double) { return 1.0; },
                int n = 1000) const {
    if (alpha == 0) return fresnel(cosine);
    const glm::dvec3 o(std::sqrt(1 - cosine * cosine), 0, cosine);
    // u is the distribution function of the slope of a normal: D cos(h) dh = du dphi / 2pi.
    return quadrature(n, [&](double u, double v) {
      const double r = alpha * std::sqrt(u / (1 - u)), phi = 2 * kPi * v;
      const glm::dvec3 h = glm::normalize(glm::dvec3(r * std::cos(phi), r * std::sin(phi), 1));
      const double oh = glm::dot(o, h);
      const glm::dvec3 i = 2 * oh * h - o;
      if (oh <= 0 || i.z <= 0) return 0.0;
      return fresnel(oh) * oh / (o.z * h.z) / (1 + lambda(o) + lambda(i));
    });
  }
};

}  // namespace limn::test
