#include "renderer/reconstruct/joint_bilateral.hpp"

#include <limits>
#include <memory>

#include "shaders/shared/bindings.h"
#include "tests/gpu/joint_bilateral.spv.hpp"
#include "tests/gpu/joint_bilateral_reference.hpp"

namespace limn::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

using Texels = std::vector<IndirectTexel>;
using Reference = JointBilateralReference;

JointBilateral& joint() {
  static std::unique_ptr<JointBilateral> kept;
  if (kept == nullptr) {
    kept = std::make_unique<JointBilateral>();
    SharedDevice::atEnd([] { kept.reset(); });
  }
  return *kept;
}

/// Light after interpolation of the grids of `stride`, half of it, and so on until `last`.
Texels interpolate(const Picture& p, uint32_t stride, uint32_t last) {
  const DevicePicture device(p);
  const ReconstructBuffers buffers{device.sites, device.gathered, device.filtered};
  must(joint().prepare(SharedDevice::get(), buffers, p.width, p.height));
  must(gpu::runNow(SharedDevice::get(), [&](vk::CommandRecorder& r) {
    for (uint32_t s = stride; s >= last; s /= 2) joint().recordInterpolate(r, buffers, s);
  }));
  return must(vk::readBackArray<IndirectTexel>(SharedDevice::get(), device.gathered, p.pixels()));
}
Texels interpolate(const Picture& p, uint32_t stride) { return interpolate(p, stride, stride); }

/// Filtered in two calls of rows.
Texels filter(const Picture& p, uint32_t size) {
  const DevicePicture device(p);
  const ReconstructBuffers buffers{device.sites, device.gathered, device.filtered};
  must(joint().prepare(SharedDevice::get(), buffers, p.width, p.height));
  const uint32_t half = p.height / 2;
  must(gpu::runNow(SharedDevice::get(), [&](vk::CommandRecorder& r) {
    if (half > 0) joint().recordFilter(r, buffers, size, {0, half});
    joint().recordFilter(r, buffers, size, {half, p.height - half});
  }));
  return must(vk::readBackArray<IndirectTexel>(SharedDevice::get(), device.filtered, p.pixels()));
}

struct Query {
  glm::vec2 place;
  glm::vec3 posR;
  uint32_t normal, object;
  uint32_t column;  ///< where the surface is in the picture
};

Texels lookUp(const Picture& p, const std::vector<Query>& queries) {
  const DevicePicture device(p);
  const vk::Buffer in = inputOf(queries);
  const struct {
    glm::ivec2 size;
    uint32_t count;
  } push{{p.width, p.height}, uint32_t(queries.size())};
  const std::vector<vk::Binding> bindings{vk::storage(0, in), vk::storage(BINDING_G_BUFFER, device.sites),
                                          vk::storage(BINDING_INDIRECT, device.gathered)};
  return runKernel<IndirectTexel>(joint_bilateralSpirv, bindings, push, queries.size(), groupsFor(queries.size()));
}

/// Surfaces of the picture, seen from places up to a pixel off.
std::vector<Query> randomQueries(const Picture& p, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<Query> queries;
  for (int k = 0; k < 2000; ++k) {
    const glm::vec2 place(unit(random) * float(p.width) * 0.9999f, unit(random) * float(p.height) * 0.9999f);
    const int x = std::min(int(place.x + unit(random)), int(p.width) - 1);
    const GatherSite& s = p.sites[p.at(x, int(place.y))];
    if (seesSurface(s)) queries.push_back({place, s.posR, s.normal, s.object, uint32_t(x)});
  }
  return queries;
}

/// Pictures before interpolation of `stride`: the coarser grid is lit, some finer pixels as well.
Picture unevenPicture(uint32_t seed, uint32_t width, uint32_t height, int coarse, bool broken = false) {
  Picture p = randomPicture(seed, width, height);
  std::mt19937 random(seed);
  eachPixel(p, [&](int x, int y, GatherSite&, IndirectTexel& l) {
    const bool parent = x % coarse == 0 && y % coarse == 0;
    const uint32_t kind = random() % 16;
    if (!parent && kind > 3) return;
    l = randomLight(random);
    l.count = float(1 + random() % 4);
    if (parent && kind < 5) l.state = shared::kIndirectInterpolated;
    if (l.state == shared::kIndirectInterpolated)
      l.count = kind == 0 ? shared::kCountGuessed : kind == 1 ? shared::kCountFar : 0.0f;
    if (broken && random() % 8 == 0) (random() % 2 == 0 ? l.diffuse : l.glossy)[random() % 3] = kind % 2 ? kNan : -kInf;
  });
  return p;
}

void expectLight(const IndirectTexel& actual, const Reference::Light& expected, const std::string& where) {
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(actual.diffuse[c], expected.diffuse[c], 2e-5) << where;
    EXPECT_NEAR(actual.glossy[c], expected.glossy[c], 2e-5) << where;
  }
  EXPECT_EQ(actual.count, expected.count) << where;
  EXPECT_EQ(actual.state, expected.state) << where;
}

/// All pixels against the reference; where it writes nothing the bits of `before` stay.
template <class Expected>
void expectPicture(const Picture& before, const Texels& after, Expected expected, const std::string& where) {
  size_t unsure = 0;
  for (int y = 0; y < int(before.height); ++y)
    for (int x = 0; x < int(before.width); ++x) {
      const size_t i = before.at(x, y);
      const Reference::Light light = expected(x, y);
      const std::string place = where + " at " + std::to_string(x) + ", " + std::to_string(y);
      unsure += light.unsure;
      if (!light.written) {
        EXPECT_TRUE(sameBits(before.light[i], after[i])) << place;
      } else if (!light.unsure) {
        expectLight(after[i], light, place);
      }
    }
  EXPECT_LE(unsure, before.pixels() / 100) << where;
}

class JointBilateralSizes : public testing::TestWithParam<Size> {};

TEST_P(JointBilateralSizes, InterpolationIsThatOfTheReference) {
  const auto [width, height] = GetParam();
  for (int stride = 16; stride > 0; stride /= 2)
    for (const bool broken : {false, true}) {
      const Picture p = unevenPicture(uint32_t(stride + broken), width, height, 2 * stride, broken);
      const Texels after = interpolate(p, uint32_t(stride));
      const Reference reference(p);
      expectPicture(p, after, [&](int x, int y) { return reference.interpolated(x, y, stride); },
                    "stride " + std::to_string(stride));
      const Texels again = interpolate(p, uint32_t(stride));
      EXPECT_EQ(std::memcmp(after.data(), again.data(), after.size() * sizeof(IndirectTexel)), 0);
    }
}

TEST_P(JointBilateralSizes, TheFilterIsThatOfTheReference) {
  const auto [width, height] = GetParam();
  for (const int size : {1, 3, 5, 7})
    for (const bool broken : {false, true}) {
      const Picture p = unevenPicture(uint32_t(size + broken), width, height, 1, broken);
      const Texels after = filter(p, uint32_t(size));
      const Reference reference(p);
      expectPicture(p, after, [&](int x, int y) { return reference.filtered(x, y, size / 2); },
                    "size " + std::to_string(size));
    }
}

TEST_P(JointBilateralSizes, LookUpsAreThoseOfTheReference) {
  const auto [width, height] = GetParam();
  for (const bool broken : {false, true}) {
    const Picture p = unevenPicture(7 + broken, width, height, 1, broken);
    const std::vector<Query> queries = randomQueries(p, 7);
    ASSERT_FALSE(queries.empty());
    const Texels found = lookUp(p, queries);
    const Reference reference(p);
    size_t unsure = 0;
    for (size_t k = 0; k < queries.size(); ++k) {
      const Query& q = queries[k];
      const auto expected = reference.lookedUp(q.place.x, q.place.y, {q.posR, decodedNormal(q.normal), q.object});
      unsure += expected.unsure;
      if (!expected.unsure) expectLight(found[k], expected, std::to_string(k));
    }
    EXPECT_LE(unsure, queries.size() / 100);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, JointBilateralSizes,
                         testing::Values(Size{37, 23}, Size{1, 1}, Size{64, 33}, Size{3, 90}), nameOfSize);

TEST(JointBilateral, ConstantsAreKeptToTheLastBit) {
  const glm::vec3 diffuse(1.0f / 3.0f, 0.1f, 7.7e5f), glossy(1e-7f, 0.7f, 3.3f);
  for (const uint32_t seed : {1u, 2u, 3u}) {
    Picture p = randomPicture(seed, 61, 47);
    lightGrid(p, 16, [&](int, int) { return sampledLight(diffuse, glossy); });
    p.light = interpolate(p, 8, 1);
    size_t lit = 0;
    const auto expectConstant = [&](const Texels& light, const char* what) {
      for (size_t i = 0; i < light.size(); ++i) {
        if (!seesSurface(p.sites[i]) || light[i].state == shared::kIndirectNone) continue;  // all parents see the sky
        EXPECT_EQ(light[i].diffuse, diffuse) << what << i;
        EXPECT_EQ(light[i].glossy, glossy) << what << i;
        ++lit;
      }
    };
    expectConstant(p.light, "interpolated ");
    EXPECT_GT(lit, p.pixels() * 3 / 4);
    eachPixel(p, [&](int, int, GatherSite&, IndirectTexel& l) { l.diffuse = diffuse, l.glossy = glossy; });
    for (const uint32_t size : {3u, 7u}) expectConstant(filter(p, size), "filtered ");
    for (const IndirectTexel& l : lookUp(p, randomQueries(p, seed))) {
      EXPECT_EQ(l.diffuse, diffuse);
      EXPECT_EQ(l.glossy, glossy);
    }
  }
}

/// A plane in two halves that meet at x = 19, with other light on each; `part` makes them other surfaces.
template <class Part>
void expectUnmixed(const char* what, Part part) {
  SCOPED_TRACE(what);
  const auto lightOf = [](int x) { return x < 19 ? glm::vec3(1.0f, 2.0f, 3.0f) : glm::vec3(40.0f, 50.0f, 60.0f); };
  Picture p = planePicture(40, 24);
  lightGrid(p, 8, [&](int x, int) { return sampledLight(lightOf(x), 2.0f * lightOf(x)); });
  eachPixel(p, [&](int x, int, GatherSite& s, IndirectTexel&) {
    if (x >= 19) part(s);
  });
  p.light = interpolate(p, 4, 1);
  const auto expectSteps = [&](const Texels& light, const char* step) {
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 40; ++x) {
        EXPECT_EQ(light[p.at(x, y)].diffuse, lightOf(x)) << step << " at " << x << ", " << y;
        EXPECT_EQ(light[p.at(x, y)].glossy, 2.0f * lightOf(x)) << step << " at " << x << ", " << y;
      }
  };
  expectSteps(p.light, "interpolated");
  expectSteps(filter(p, 7), "filtered");
  const std::vector<Query> queries = randomQueries(p, 3);
  const Texels found = lookUp(p, queries);
  for (size_t k = 0; k < queries.size(); ++k) {
    EXPECT_EQ(found[k].diffuse, lightOf(int(queries[k].column))) << "looked up at " << queries[k].place.x;
  }
}

TEST(JointBilateral, StepsAtEdgesStayUnmixed) {
  expectUnmixed("another object", [](GatherSite& s) { s.object = 1; });
  expectUnmixed("another normal", [](GatherSite& s) {  // a wall that stands on the plane
    s.normal = gpu::octEncode({1, 0, 0});
    s.posR = {0.19f, s.posR.y, s.posR.x - 1.19f};
  });
  expectUnmixed("another depth", [](GatherSite& s) { s.posR.z -= 1.0f; });
}

TEST(JointBilateral, ALinearRampOnAPlaneIsReproduced) {
  Picture p = planePicture(49, 33);  // whole cells of 16 pixels
  const auto ramp = [](int x, int y) {
    return glm::vec3(0.01f * float(x), 0.02f * float(y), 0.1f + 0.03f * float(x + y));
  };
  lightGrid(p, 16, [&](int x, int y) { return sampledLight(ramp(x, y), 3.0f * ramp(x, y)); });
  const Texels light = interpolate(p, 8, 1);
  for (int y = 0; y < 33; ++y)
    for (int x = 0; x < 49; ++x)
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(light[p.at(x, y)].diffuse[c], ramp(x, y)[c], 1e-5) << x << ", " << y;
        EXPECT_NEAR(light[p.at(x, y)].glossy[c], 3.0f * ramp(x, y)[c], 3e-5) << x << ", " << y;
      }
}

/// Seen from near by, far from render space's origin: neighbours are 0.2 mm apart, and their coordinates err by as much.
TEST(JointBilateral, APlaneFarFromTheOriginIsOnePlane) {
  Picture p = planePicture(33, 33);
  std::mt19937 random(5);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(1.0, 2.0, 3.0)), across = glm::normalize(glm::dvec3(2.0, -1.0, 0.0));
  eachPixel(p, [&](int x, int y, GatherSite& s, IndirectTexel& l) {
    s.posR = glm::vec3(1e4 * normal + 2e-4 * (double(x) * across + double(y) * glm::cross(normal, across)));
    s.normal = gpu::octEncode(glm::vec3(normal));
    l = randomLight(random);
  });
  const auto varianceOf = [](const Texels& light) {
    double sum = 0.0, squares = 0.0;
    for (const IndirectTexel& l : light) sum += l.diffuse.g, squares += double(l.diffuse.g) * l.diffuse.g;
    return squares / double(light.size()) - sum * sum / double(light.size() * light.size());
  };
  EXPECT_LT(varianceOf(filter(p, 7)), 0.05 * varianceOf(p.light));  // means of 49, and fewer at the borders
}

TEST(JointBilateral, WhatHasNoParentOfItsOwnIsGuessedAndGuessesWeighNothing) {
  Picture p = planePicture(33, 33);
  lightGrid(p, 16, [](int, int) { return sampledLight(glm::vec3(2.0f), glm::vec3(5.0f)); });
  eachPixel(p, [](int x, int y, GatherSite& s, IndirectTexel&) { s.object = x > 3 && x < 13 && y > 3 && y < 13; });
  p.light = interpolate(p, 8, 1);
  eachPixel(p, [](int x, int y, GatherSite& s, IndirectTexel& l) {
    if (s.object == 1) {
      EXPECT_EQ(l.count, shared::kCountGuessed) << x << ", " << y;
      EXPECT_EQ(l.diffuse, glm::vec3(2.0f)) << "not black";
      EXPECT_EQ(l.glossy, glm::vec3(5.0f));
      EXPECT_EQ(l.state, shared::kIndirectInterpolated);
    } else {
      EXPECT_GE(l.count, shared::kCountFar);
    }
  });
  p.light[p.at(8, 8)] = sampledLight(glm::vec3(9.0f), glm::vec3(7.0f));
  const Texels filtered = filter(p, 7);
  EXPECT_EQ(filtered[p.at(8, 8)].diffuse, glm::vec3(9.0f));
  EXPECT_EQ(filtered[p.at(6, 10)].diffuse, glm::vec3(9.0f)) << "what is known replaces guesses";
  EXPECT_EQ(filtered[p.at(6, 10)].glossy, glm::vec3(7.0f));
  EXPECT_EQ(filtered[p.at(4, 4)].diffuse, glm::vec3(2.0f)) << "a guess stays where nothing is known";
  const GatherSite& s = p.sites[p.at(8, 8)];
  const Texels found = lookUp(p, {{{9.2f, 8.5f}, s.posR, s.normal, 1, 8}, {{4.5f, 4.5f}, s.posR, s.normal, 1, 8}});
  EXPECT_EQ(found[0].diffuse, glm::vec3(9.0f));
  EXPECT_EQ(found[1].diffuse, glm::vec3(2.0f)) << "a guess is looked up where nothing else is";
  const Texels refined = interpolate(p, 4, 1);
  EXPECT_EQ(refined[p.at(8, 10)].diffuse, glm::vec3(9.0f)) << "one gather on the object is enough for those around";
}

TEST(JointBilateral, ASurfaceBesideTheCellLightsWhatHasNoParentInIt) {
  Picture p = planePicture(33, 33);
  lightGrid(p, 16, [](int x, int) { return sampledLight(glm::vec3(float(1 + x))); });
  eachPixel(p, [](int x, int y, GatherSite& s, IndirectTexel&) { s.object = x >= 24 || (x == 8 && y == 8); });
  p.light = interpolate(p, 8);
  EXPECT_EQ(p.light[p.at(8, 8)].count, shared::kCountFar);
  EXPECT_EQ(p.light[p.at(8, 8)].diffuse, glm::vec3(33.0f));
  EXPECT_EQ(p.light[p.at(24, 8)].count, 0.0f);
}

TEST(JointBilateral, WhatIsBrightButHardlyFitsMakesNothingNegative) {
  Picture p = planePicture(8, 8);
  eachPixel(p, [](int x, int y, GatherSite& s, IndirectTexel& l) {
    l = sampledLight(glm::vec3(x + y == 0 ? 1.1e6f : 0.0f));
    l.count = x + y == 0 ? 1.0f : 3000.0f;
    if (x + y == 0) s.normal = gpu::octEncode(glm::normalize(glm::vec3(1.0f, 0.0f, 0.49f)));  // weighs 4e-6
  });
  const Texels light = filter(p, 7);
  for (size_t i = 1; i < p.pixels(); ++i) EXPECT_GE(light[i].diffuse.x, 0.0f) << i;
  EXPECT_LT(light[p.at(1, 0)].diffuse.x, 1.0f);
}

TEST(JointBilateral, LightThatIsNoNumberNeverSpreads) {
  const auto finite = [](const IndirectTexel& l) { return Reference::usable(l); };
  for (const uint32_t seed : {1u, 2u}) {
    Picture p = unevenPicture(seed, 61, 47, 16, true);
    const Texels before = p.light;
    p.light = interpolate(p, 8, 1);
    size_t broken = 0;
    for (size_t i = 0; i < p.pixels(); ++i) {
      const bool own = !finite(before[i]);
      broken += own;
      EXPECT_TRUE(own || finite(p.light[i])) << i;
    }
    EXPECT_GT(broken, 10u);
    const Texels filtered = filter(p, 7);
    for (size_t i = 0; i < p.pixels(); ++i)
      EXPECT_TRUE(!seesSurface(p.sites[i]) || finite(filtered[i])) << i;
    for (const IndirectTexel& l : lookUp(p, randomQueries(p, seed))) EXPECT_TRUE(finite(l));
  }
}

}  // namespace
}  // namespace limn::test
