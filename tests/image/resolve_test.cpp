// What the resolver makes of a film, byte for byte beside the published formulas in plain C++.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "renderer/film/exr.hpp"
#include "renderer/film/resolver.hpp"
#include "renderer/scene/image_file.hpp"
#include "renderer/vk/transfer.hpp"
#include "tests/support/shared_device.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kWidth = 45, kHeight = 27;  // no multiple of any grid or workgroup
constexpr size_t kPixels = size_t(kWidth) * kHeight;
using Plane = std::vector<glm::vec4>;

/// The film's planes as shaders/lib/film.glsl has them.
struct Planes {
  Plane mean = Plane(kPixels), half = mean, direct = mean, albedo = mean, normal = mean;
};

/// Radiance from black to far over white, saturated and grey, in every pixel 1 to 300 samples.
Planes somePlanes() {
  std::mt19937 engine(7);
  const auto unit = [&] { return float(engine() % 65536) / 65535.0f; };
  Planes p;
  for (size_t i = 0; i < kPixels; ++i) {
    const float level = std::exp2(-9.0f + 14.0f * float(i) / float(kPixels));
    p.mean[i] = glm::vec4(level * glm::vec3(unit(), unit(), i % 3 == 0 ? 0.0f : unit()), 1.0f + float(engine() % 300));
    if (i % 17 == 0) p.mean[i] = glm::vec4(glm::vec3(level), 5.0f);
    p.direct[i] = glm::vec4(glm::vec3(p.mean[i]) * unit(), 0.0f);
    p.albedo[i] = glm::vec4(unit(), unit(), unit(), 5.0f * unit());
    p.normal[i] = glm::vec4(2 * unit() - 1, 2 * unit() - 1, 2 * unit() - 1, i % 5 == 0 ? 0.0f : unit());
  }
  return p;
}

/// Khronos PBR Neutral, from its specification.
glm::dvec3 neutral(glm::dvec3 c) {
  const double x = std::min({c.r, c.g, c.b}), offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
  c -= offset;
  const double peak = std::max({c.r, c.g, c.b}), start = 0.8 - 0.04, d = 1 - start;
  if (peak < start) return c;
  const double newPeak = 1 - d * d / (peak + d - start), g = 1 - 1 / (0.15 * (peak - newPeak) + 1);
  return glm::mix(c * (newPeak / peak), glm::dvec3(newPeak), g);
}

/// S. Hill's fit of the ACES reference and output transforms; matrices row by row as published.
glm::dvec3 aces(const glm::dvec3& c) {
  const glm::dvec3 v(0.59719 * c.r + 0.35458 * c.g + 0.04823 * c.b, 0.07600 * c.r + 0.90834 * c.g + 0.01566 * c.b,
                     0.02840 * c.r + 0.13383 * c.g + 0.83777 * c.b);
  const glm::dvec3 f = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  return {1.60475 * f.r - 0.53108 * f.g - 0.07367 * f.b, -0.10208 * f.r + 1.10813 * f.g - 0.00605 * f.b,
          -0.00327 * f.r - 0.07276 * f.g + 1.07602 * f.b};
}

/// AgX without a look: inset, log2 from -12.47393 to 4.026069 EV, the sixth-degree contrast, outset.
glm::dvec3 agx(const glm::dvec3& c) {
  const glm::dmat3 inset(0.842479062253094, 0.0423282422610123, 0.0423756549057051,   // columns
                         0.0784335999999992, 0.878468636469772, 0.0784336,            //
                         0.0792237451477643, 0.0791661274605434, 0.879142973793104);
  glm::dvec3 v = inset * c;
  for (int k = 0; k < 3; ++k) {
    const double ev = std::clamp(std::log2(std::max(v[k], 1e-10)), -12.47393, 4.026069);
    const double x = (ev + 12.47393) / (4.026069 + 12.47393);
    v[k] = 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) - 6.868 * std::pow(x, 3) +
           0.4298 * x * x + 0.1191 * x - 0.00232;
  }
  return glm::pow(glm::clamp(glm::inverse(inset) * v, 0.0, 1.0), glm::dvec3(2.2));
}

double srgb(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return 255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
}

/// The display value of radiance [0, 255], before rounding.
glm::dvec3 shown(const glm::dvec3& radiance, const ResolveSettings& settings) {
  const glm::dvec3 c = glm::max(radiance, 0.0) * std::exp2(double(settings.exposure));
  const glm::dvec3 mapped = settings.toneMap == ToneMap::pbrNeutral ? neutral(c)
                            : settings.toneMap == ToneMap::aces     ? aces(c)
                            : settings.toneMap == ToneMap::agx      ? agx(c)
                                                                    : c;
  return {srgb(mapped.r), srgb(mapped.g), srgb(mapped.b)};
}

class Resolve : public testing::Test {
 protected:
  static vk::Device& device() { return SharedDevice::get(); }
  Resolve()
      : m_film(must(Film::create(device(), kWidth, kHeight))), m_resolver(must(Resolver::create(device(), m_film))) {}

  std::vector<uint8_t> resolve(const Planes& planes, const ResolveSettings& settings, uint32_t stride = 0) {
    const auto bindings = m_film.bindings();
    const Plane* sources[] = {&planes.mean, &planes.half, &planes.direct, &planes.albedo, &planes.normal};
    for (size_t i = 0; i < bindings.size(); ++i) {
      const vk::BufferDesc desc{0, vk::BufferUsage::storage, vk::MemoryKind::upload, "plane", "test"};
      const vk::Buffer source = must(vk::createBufferWith(device(), desc, std::span<const glm::vec4>(*sources[i])));
      must(gpu::runNow(device(), [&](vk::CommandRecorder& r) {
        r.copyBuffer(source, 0, *bindings[i].buffer, 0, source.size());
      }));
    }
    return must(m_resolver.resolve(device(), m_film, settings, stride));
  }

  /// Every byte is the expected value rounded, give or take what float cannot know; opaque.
  static void expectBytes(const std::vector<uint8_t>& rgba, const std::vector<glm::dvec3>& expected) {
    ASSERT_EQ(rgba.size(), kPixels * 4);
    int wrong = 0;
    for (size_t i = 0; i < kPixels && wrong < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        const int byte = rgba[4 * i + size_t(k)];
        if (std::abs(byte - expected[i][k]) > 0.52 && ++wrong < 3)
          ADD_FAILURE() << "pixel " << i << " channel " << k << ": " << byte << " for " << expected[i][k];
      }
      EXPECT_EQ(rgba[4 * i + 3], 255);
    }
  }

 private:
  Film m_film;
  Resolver m_resolver;
};

TEST_F(Resolve, ToneMapsAndExposuresAreThePublishedFormulas) {
  const Planes planes = somePlanes();
  for (const ToneMap map : {ToneMap::pbrNeutral, ToneMap::aces, ToneMap::agx, ToneMap::linear})
    for (const float exposure : {-2.5f, 0.0f, 3.0f}) {
      SCOPED_TRACE(std::string(toneMapName(map)) + " at " + std::to_string(exposure) + " EV");
      const ResolveSettings settings{exposure, map};
      std::vector<glm::dvec3> expected;
      for (const glm::vec4& mean : planes.mean) expected.push_back(shown(glm::dvec3(mean), settings));
      expectBytes(resolve(planes, settings), expected);
    }
}

TEST_F(Resolve, ViewsShowTheirOwnPlane) {
  const Planes planes = somePlanes();
  const auto expectView = [&](ResolveView view, const std::function<glm::dvec3(size_t)>& value) {
    SCOPED_TRACE(resolveViewName(view));
    std::vector<glm::dvec3> expected;
    for (size_t i = 0; i < kPixels; ++i) expected.push_back(value(i));
    expectBytes(resolve(planes, {1.5f, ToneMap::aces, view}), expected);
  };
  const auto radiance = [](const glm::vec3& v) { return shown(glm::dvec3(v), {1.5f, ToneMap::aces}); };
  const auto plain = [](const glm::dvec3& v) { return glm::dvec3(srgb(v.r), srgb(v.g), srgb(v.b)); };
  expectView(ResolveView::direct, [&](size_t i) { return radiance(glm::vec3(planes.direct[i])); });
  expectView(ResolveView::indirect, [&](size_t i) { return radiance(glm::vec3(planes.mean[i] - planes.direct[i])); });
  expectView(ResolveView::albedo, [&](size_t i) { return plain(glm::dvec3(planes.albedo[i])); });
  expectView(ResolveView::normal, [&](size_t i) { return plain(glm::dvec3(planes.normal[i]) * 0.5 + 0.5); });
  expectView(ResolveView::samples, [&](size_t i) { return plain(glm::dvec3(planes.mean[i].w / 256.0)); });
  expectView(ResolveView::depth, [&](size_t i) {
    const double hits = planes.normal[i].w;
    return plain(glm::dvec3(hits > 0 ? 1 / (1 + planes.albedo[i].w / hits) : 0.0));
  });
}

/// Bilinear between the nearest pixels of the grid; those beyond the picture have no say.
glm::dvec3 filled(const Plane& mean, uint32_t x, uint32_t y, uint32_t stride) {
  glm::dvec3 sum(0);
  double weights = 0;
  const uint32_t cx = x / stride * stride, cy = y / stride * stride;
  for (const uint32_t qx : {cx, cx + stride})
    for (const uint32_t qy : {cy, cy + stride}) {
      if (qx >= kWidth || qy >= kHeight) continue;
      const double wx = 1 - std::abs(double(x) - qx) / stride, wy = 1 - std::abs(double(y) - qy) / stride;
      sum += (wx * wy + 1e-6) * glm::dvec3(mean[size_t(qy) * kWidth + qx]);
      weights += wx * wy + 1e-6;
    }
  return sum / weights;
}

TEST_F(Resolve, ACoarseGridIsFilledBilinearly) {
  for (const uint32_t stride : {8u, 4u, 2u}) {
    SCOPED_TRACE("grid of " + std::to_string(stride));
    Planes planes = somePlanes();
    for (uint32_t y = 0; y < kHeight; ++y)
      for (uint32_t x = 0; x < kWidth; ++x)
        if (x % stride || y % stride)  // without samples the rest means nothing
          planes.mean[size_t(y) * kWidth + x] = glm::vec4(1e6f, 0.0f, 1e6f, 0.0f);
    const ResolveSettings settings{0.0f, ToneMap::linear};
    std::vector<glm::dvec3> expected;
    for (uint32_t y = 0; y < kHeight; ++y)
      for (uint32_t x = 0; x < kWidth; ++x) expected.push_back(shown(filled(planes.mean, x, y, stride), settings));
    expectBytes(resolve(planes, settings, stride), expected);
  }
}

TEST_F(Resolve, WhatHasTheFinerGridIsFilledFromItAndTheRestFromTheCoarser) {
  constexpr uint32_t kRows = 12;  // of the grid of 4; below only that of 8 has samples
  Planes planes = somePlanes();
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x)
      if (const uint32_t grid = y <= kRows ? 4 : 8; x % grid || y % grid) planes.mean[size_t(y) * kWidth + x].w = 0.0f;
  const ResolveSettings settings{0.0f, ToneMap::linear};
  std::vector<glm::dvec3> expected;
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x) {
      const size_t i = size_t(y) * kWidth + x;
      const bool sampled = planes.mean[i].w > 0;
      const glm::dvec3 fill = filled(planes.mean, x, y, y < kRows ? 4 : 8);
      expected.push_back(shown(sampled ? glm::dvec3(planes.mean[i]) : fill, settings));
    }
  expectBytes(resolve(planes, settings, 8), expected);
}

TEST_F(Resolve, ThePngHoldsTheVeryBytes) {
  const std::vector<uint8_t> rgba = resolve(somePlanes(), {});
  const std::vector<uint8_t> png = must(encodePng(kWidth, kHeight, rgba));
  const Image read = must(decodeImage(png, must(readImageHeader(png))));
  EXPECT_EQ(read.width, kWidth);
  EXPECT_EQ(read.height, kHeight);
  EXPECT_EQ(read.rgba8, rgba);
}

}  // namespace
}  // namespace limn::test
