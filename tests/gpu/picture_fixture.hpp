#pragma once
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/glm.hpp>
#include <random>
#include <string>
#include <vector>

#include "renderer/gpu/packing.hpp"
#include "shaders/shared/gather_shared.h"
#include "shaders/shared/scene_shared.h"
#include "tests/gpu/kernel.hpp"

namespace limn::test {

using shared::GatherSite;
using shared::IndirectTexel;

/// What every pixel sees, and the light gathered there.
struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<GatherSite> sites;
  std::vector<IndirectTexel> light;

  size_t at(int x, int y) const { return size_t(y) * width + size_t(x); }
  bool holds(int x, int y) const { return x >= 0 && y >= 0 && x < int(width) && y < int(height); }
  size_t pixels() const { return sites.size(); }
};

/// The same on the device.
struct DevicePicture {
  explicit DevicePicture(const Picture& p)
      : sites(inputOf(p.sites)), gathered(inputOf(p.light)), filtered(inputOf(p.light)),
        list(inputOf(std::vector<uint32_t>(p.pixels()))) {}
  vk::Buffer sites, gathered, filtered, list;
};

inline bool seesSurface(const GatherSite& s) { return s.triangle != shared::kNoIndex; }

/// As octDecode() of math.glsl, in doubles.
inline glm::dvec3 decodedNormal(uint32_t packed) {
  const glm::dvec2 e(glm::unpackSnorm2x16(packed));
  glm::dvec3 v(e.x, e.y, 1.0 - std::abs(e.x) - std::abs(e.y));
  if (v.z < 0.0)
    v = {(1.0 - std::abs(e.y)) * (e.x >= 0.0 ? 1.0 : -1.0), (1.0 - std::abs(e.x)) * (e.y >= 0.0 ? 1.0 : -1.0), v.z};
  return glm::normalize(v);
}

inline IndirectTexel sampledLight(glm::vec3 diffuse, glm::vec3 glossy = glm::vec3(0.0f)) {
  return {diffuse, 1.0f, glossy, shared::kIndirectSampled};
}

/// A plane of one object that faces the viewer, a hundred pixels a metre, in the dark.
inline Picture planePicture(uint32_t width, uint32_t height) {
  Picture p{width, height, {}, {}};
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      p.sites.push_back({{0.01f * float(x), 0.01f * float(y), -1.0f}, gpu::octEncode({0, 0, 1}), 0, {}, 0});
      p.light.push_back({});
    }
  return p;
}

/// Changes every pixel.
inline void eachPixel(Picture& p, const std::function<void(int x, int y, GatherSite& site, IndirectTexel& light)>& f) {
  for (int y = 0; y < int(p.height); ++y)
    for (int x = 0; x < int(p.width); ++x) f(x, y, p.sites[p.at(x, y)], p.light[p.at(x, y)]);
}

/// Light everywhere on the grid of `stride`, none between.
inline void lightGrid(Picture& p, int stride, const std::function<IndirectTexel(int x, int y)>& light) {
  eachPixel(p, [&](int x, int y, GatherSite&, IndirectTexel& l) {
    l = x % stride == 0 && y % stride == 0 ? light(x, y) : IndirectTexel{};
  });
}

/// Patches of three objects with rough geometry, an eighth of it sky; no light.
inline Picture randomPicture(uint32_t seed, uint32_t width, uint32_t height) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f), around(-1.0f, 1.0f);
  Picture p = planePicture(width, height);
  const float roughness = 0.3f * unit(random);
  std::vector<uint32_t> patches(size_t(width / 7 + 1) * (height / 7 + 1));
  for (uint32_t& patch : patches) patch = random();
  eachPixel(p, [&](int x, int y, GatherSite& s, IndirectTexel&) {
    const uint32_t patch = patches[size_t(y / 7) * (width / 7 + 1) + size_t(x / 7)];
    s.posR += 0.02f * roughness * glm::vec3(around(random), around(random), around(random));
    s.posR.z += 0.3f * float(patch >> 8 & 1);
    const glm::vec3 facing = (patch >> 9 & 3) == 0 ? glm::vec3(1, 0, 0.2f) : glm::vec3(0, 0, 1);
    s.normal = gpu::octEncode(
        glm::normalize(facing + roughness * glm::vec3(around(random), around(random), around(random))));
    s.object = (patch >> 12) % 3;
    if ((patch >> 16 & 15) == 0 || random() % 16 == 0) s.triangle = s.object = shared::kNoIndex;
  });
  return p;
}

inline IndirectTexel randomLight(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  const auto colour = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
  const glm::vec3 diffuse = colour(), glossy = colour();
  return sampledLight(diffuse, glossy);
}

/// Pictures' sizes as test parameters.
using Size = std::pair<uint32_t, uint32_t>;
inline std::string nameOfSize(const testing::TestParamInfo<Size>& size) {
  return std::to_string(size.param.first) + "x" + std::to_string(size.param.second);
}

template <class T>
bool sameBits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

}  // namespace limn::test
