#pragma once
#include <algorithm>

#include "tests/gpu/picture_fixture.hpp"

namespace limn::test {

/// Joint bilateral reconstruction in plain doubles. [IPP §3.3, §4]
class JointBilateralReference {
 public:
  /// A surface that light is looked for.
  struct Seen {
    glm::dvec3 posR, normal;
    uint32_t object;
  };
  struct Light {
    glm::dvec3 diffuse{0.0}, glossy{0.0};
    double weight = 0.0, glossyWeight = 0.0;
    float count = 0.0f, state = shared::kIndirectInterpolated;
    bool written = true;
    bool unsure = false;  ///< rounding decides between two ways

    void add(const IndirectTexel& l, double w, bool withGlossy = true) {
      diffuse += w * glm::dvec3(l.diffuse);
      weight += w;
      if (!withGlossy) return;
      glossy += w * glm::dvec3(l.glossy);
      glossyWeight += w;
    }
    Light divided() const {
      Light l = *this;
      if (weight > 0.0) l.diffuse /= weight;
      if (glossyWeight > 0.0) l.glossy /= glossyWeight;
      return l;
    }
    bool enough() {
      unsure = unsure || std::abs(weight - 1e-3) < 1e-5;
      return weight >= 1e-3;
    }
  };

  explicit JointBilateralReference(const Picture& picture) : p(picture) {}

  static Seen seenAt(const GatherSite& s) { return {glm::dvec3(s.posR), decodedNormal(s.normal), s.object}; }

  static bool usable(const IndirectTexel& l) {
    for (int c = 0; c < 3; ++c)
      if (!(std::abs(l.diffuse[c]) < 1e30f) || !(std::abs(l.glossy[c]) < 1e30f)) return false;
    return true;
  }
  static bool known(const IndirectTexel& l) {
    return l.state != shared::kIndirectNone && l.count != shared::kCountGuessed && usable(l);
  }

  static double alikeness(const Seen& s, const GatherSite& other) {
    if (!seesSurface(other) || other.object != s.object) return 0.0;
    const glm::dvec3 apart = glm::dvec3(other.posR) - s.posR;
    const double d2 = glm::dot(apart, apart), largest = std::max({std::abs(s.posR.x), std::abs(s.posR.y), std::abs(s.posR.z)});
    const double height = std::max(std::abs(glm::dot(apart, s.normal)) - 8.0 / 16777216.0 * largest, 0.0);
    const double level = d2 > 0.0 ? height * height / (d2 * 0.12 * 0.12) : 0.0;
    return std::pow(std::max(0.0, glm::dot(s.normal, decodedNormal(other.normal))), 16.0) * std::exp(-level);
  }

  Light aroundOf(int x, int y, int stride, const Seen& s) const {
    Light sum;
    for (int k = 0; k < 9; ++k) {
      const int qx = ((x + stride / 2) / stride + k % 3 - 1) * stride;
      const int qy = ((y + stride / 2) / stride + k / 3 - 1) * stride;
      addFitting(sum, qx, qy, 1.0, s);
    }
    return sum;
  }

  Light cellOf(double x, double y, int stride, const Seen& s) const {
    Light sum;
    const double cx = std::floor(x / stride), cy = std::floor(y / stride), fx = x / stride - cx, fy = y / stride - cy;
    for (int k = 0; k < 4; ++k) {
      const double bilinear = (k % 2 ? fx : 1.0 - fx) * (k / 2 ? fy : 1.0 - fy);
      addFitting(sum, (int(cx) + k % 2) * stride, (int(cy) + k / 2) * stride, bilinear, s);
    }
    return sum;
  }

  /// Light of a pixel of the grid of `stride` after interpolation of that grid.
  Light interpolated(int x, int y, int stride) const {
    const int coarse = 2 * stride;
    const GatherSite& site = p.sites[p.at(x, y)];
    const bool left = x % stride != 0 || y % stride != 0 || (x % coarse == 0 && y % coarse == 0);
    if (left || !seesSurface(site) || p.light[p.at(x, y)].state == shared::kIndirectSampled) return untouched();
    Light light = cellOf(x, y, coarse, seenAt(site));
    if (light.enough()) return light.divided();
    const bool unsure = light.unsure;
    light = aroundOf(x, y, coarse, seenAt(site));
    if (light.enough()) {
      light.count = shared::kCountFar;
    } else {
      light = guessOf(x, y, coarse);
      light.count = shared::kCountGuessed;
      if (light.weight == 0.0) light.state = shared::kIndirectNone;
    }
    light.unsure = light.unsure || unsure;
    return light.divided();
  }

  Light filtered(int x, int y, int reach) const {
    const size_t own = p.at(x, y);
    const IndirectTexel& centre = p.light[own];
    if (!seesSurface(p.sites[own])) return untouched();
    Light sum;
    for (int qy = y - reach; qy <= y + reach; ++qy)
      for (int qx = x - reach; qx <= x + reach; ++qx) {
        if (!p.holds(qx, qy) || !known(p.light[p.at(qx, qy)])) continue;
        const IndirectTexel& other = p.light[p.at(qx, qy)];
        const double alike = p.at(qx, qy) == own ? 1.0 : alikeness(seenAt(p.sites[own]), p.sites[p.at(qx, qy)]);
        const bool near = std::abs(qx - x) <= 1 && std::abs(qy - y) <= 1;
        if (alike > 1e-6) sum.add(other, alike * std::max(1.0, double(other.count)), near || !known(centre));
      }
    sum.count = known(centre) ? centre.count : 0.0;
    sum.state = known(centre) ? centre.state : shared::kIndirectInterpolated;
    if (sum.enough()) return sum.divided();
    if (usable(centre)) return untouched();
    Light dark;
    dark.count = shared::kCountGuessed;
    dark.state = shared::kIndirectNone;
    return dark;
  }

  Light lookedUp(double x, double y, const Seen& s) const {
    Light light = cellOf(x - 0.5, y - 0.5, 1, s);
    if (light.enough()) return light.divided();
    bool unsure = light.unsure;
    light = aroundOf(int(x), int(y), 1, s);
    if (!light.enough()) {
      unsure = unsure || light.unsure;
      const IndirectTexel& own = p.light[p.at(std::min(int(x), int(p.width) - 1), std::min(int(y), int(p.height) - 1))];
      light = {};
      if (usable(own)) light.add(own, 1.0);
      else light.state = shared::kIndirectNone;
    }
    light.unsure = light.unsure || unsure;
    return light.divided();
  }

 private:
  static Light untouched() {
    Light l;
    l.written = false;
    return l;
  }

  void addFitting(Light& sum, int x, int y, double factor, const Seen& s) const {
    if (!p.holds(x, y) || !known(p.light[p.at(x, y)])) return;
    const double weight = factor * alikeness(s, p.sites[p.at(x, y)]);
    if (weight > 1e-6) sum.add(p.light[p.at(x, y)], weight);
  }

  Light guessOf(int x, int y, int coarse) const {
    Light sum;
    for (int k = 0; k < 4; ++k) {
      const int qx = (x / coarse + k % 2) * coarse, qy = (y / coarse + k / 2) * coarse;
      if (!p.holds(qx, qy) || !seesSurface(p.sites[p.at(qx, qy)])) continue;
      const IndirectTexel& l = p.light[p.at(qx, qy)];
      if (l.state != shared::kIndirectNone && usable(l)) sum.add(l, known(l) ? 1.0 : 1e-3);
    }
    return sum;
  }

  const Picture& p;
};

}  // namespace limn::test
