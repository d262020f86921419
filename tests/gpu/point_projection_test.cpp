#include <cstdio>
#include <cstring>
#include <cmath>
#include <numbers>

#include "tests/gpu/gather_fixture.hpp"

namespace limn::test {
namespace {

constexpr double kPi = std::numbers::pi;
const std::vector<glm::vec3> kWhiteBox(6, glm::vec3(1.0f));
constexpr glm::vec3 kLight(4.0f, 2.0f, 1.0f);

void expectFinite(const std::vector<shared::IndirectTexel>& texels, float most) {
  for (const shared::IndirectTexel& t : texels)
    for (int k = 0; k < 3; ++k) {
      EXPECT_TRUE(std::isfinite(t.diffuse[k]) && t.diffuse[k] >= 0.0f && t.diffuse[k] <= most) << t.diffuse[k];
      EXPECT_TRUE(std::isfinite(t.glossy[k]) && t.glossy[k] >= 0.0f) << t.glossy[k];
    }
}

/// Sites over the floor of a box, off its middle.
void spreadSites(Gatherer& g, float half, float height, uint32_t count = 64) {
  g.sites.clear();
  for (uint32_t i = 0; i < count; ++i)
    g.sites.push_back(g.site({half * (float(i % 8) / 4.0f - 0.875f), height, half * (float(i / 8 % 8) / 4.0f - 0.875f)}));
}

double meanGreen(const std::vector<shared::IndirectTexel>& texels) {
  double sum = 0.0;
  for (const auto& t : texels) sum += t.diffuse.g;
  return sum / double(texels.size());
}

/// All around is as bright: no more may arrive, and little less.
TEST(PointProjection, WhiteFurnaceInABoxAndASphere) {
  Gatherer box(boxPoints(1.0f, 104, kWhiteBox), 512, 24.0);
  spreadSites(box, 1.0f, -1.0f);
  Gatherer sphere(spherePoints({0, 0, 0}, 1.0f, 65536, glm::vec3(1.0f)), 512, 4 * kPi);
  spreadSites(sphere, 0.5f, 0.0f);
  for (Gatherer* g : {&box, &sphere}) {
    const auto light = g->gather();
    for (const auto& t : light) {
      EXPECT_LE(t.diffuse.g, 1.0005f);
      EXPECT_GE(t.diffuse.g, 0.80f);
      EXPECT_EQ(t.count, 1.0f);
      EXPECT_EQ(t.state, shared::kIndirectSampled);
    }
    EXPECT_GT(meanGreen(light), 0.98);
  }
}

/// Irradiance / pi at the middle of the floor from a parallel square of side 2w at height h, radiance 1.
double squareOverhead(double w, double h) {
  const double a = w / h, s = std::sqrt(1.0 + a * a);
  return 4.0 * a / (kPi * s) * std::atan(a / s);
}

/// Splats widen what they show by less than a texel, whose width on the square's plane eq. 2 tells; nothing is lost.
TEST(PointProjection, ParallelSquareHasItsFormFactor) {
  for (const float w : {0.25f, 0.5f, 1.0f, 2.0f}) {
    Gatherer g(parallelogram({-w, 1.0f, -w}, {2 * w, 0, 0}, {0, 0, 2 * w}, 256, kLight), 512, 4.0 * w * w);
    const auto light = g.gather(16)[0];
    const double texel = std::sqrt(2.0) / 32.0 * std::pow(1.0 + w, 1.5);
    const double least = squareOverhead(w, 1.0), most = squareOverhead(w + texel, 1.0);
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(light.diffuse[k], 0.99 * least * kLight[k]) << w;
      EXPECT_LE(light.diffuse[k], most * kLight[k]) << w;
    }
    EXPECT_EQ(light.count, 16.0f);
  }
}

/// Light from the half of the sphere x > 0 is half of all.
TEST(PointProjection, HalfAHemisphere) {
  auto points = spherePoints({0, 0, 0}, 1.0f, 65536, glm::vec3(1.0f));
  for (LitPoint& p : points) p.front = p.back = p.posR.x > 0.0f ? kLight : glm::vec3(0.0f);
  Gatherer g(points, 512, 4 * kPi);
  const auto light = g.gather(16)[0];
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(light.diffuse[k], 0.5f * kLight[k], 0.04f * kLight[k]);
}

/// A dark square hides a bright one of twice its size at twice its height, but for holes.
TEST(PointProjection, WhatIsInFrontHides) {
  auto points = parallelogram({-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, 128, kLight);
  append(points, parallelogram({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, 64, glm::vec3(0.0f)));
  Gatherer g(points, 512, 20.0);
  const double open = squareOverhead(1.0, 1.0);
  EXPECT_LT(g.gather(16)[0].diffuse.b, 0.06 * open);
  EXPECT_LT(g.gather(1, kBruteForce)[0].diffuse.b, 0.06 * open);
}

/// The side of a point that faces the site is the one that shines.
TEST(PointProjection, SidesAreToldApart) {
  auto points = parallelogram({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, 128, glm::vec3(0.0f));
  const bool frontIsSeen = points[0].normal.y < 0.0f;
  for (LitPoint& p : points) (frontIsSeen ? p.front : p.back) = glm::vec3(1.0f);
  Gatherer g(points, 128, 4.0);
  EXPECT_GT(g.gather(4)[0].diffuse.g, 0.99 * squareOverhead(1.0, 1.0));
  for (LitPoint& p : points) std::swap(p.front, p.back);
  Gatherer other(points, 128, 4.0);
  EXPECT_EQ(other.gather(4)[0].diffuse.g, 0.0f);
}

std::vector<glm::vec3> colouredBox() { return {{4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {2, 2, 2}, {0, 0, 4}, {1, 0, 1}}; }

constexpr glm::dvec3 kBallCenter(0.2, -0.3, 0.1);
constexpr double kBallRadius = 0.4;

/// Radiance from direction d in a box of coloured faces with a grey ball in it.
glm::dvec3 roomRadiance(const glm::dvec3& p, const glm::dvec3& d) {
  const glm::dvec3 toBall = kBallCenter - p;
  const double along = glm::dot(toBall, d), off2 = glm::dot(toBall, toBall) - along * along;
  if (along > 0.0 && off2 < kBallRadius * kBallRadius) return glm::dvec3(0.25);
  double nearest = 1e9;
  int face = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double t = ((d[axis] > 0.0 ? 1.0 : -1.0) - p[axis]) / d[axis];
    if (d[axis] != 0.0 && t < nearest) {
      nearest = t;
      face = 2 * axis + (d[axis] > 0.0);
    }
  }
  return colouredBox()[size_t(face)];
}

/// Irradiance / pi on the floor by cosine-weighted strata.
glm::dvec3 roomLight(const glm::dvec3& p) {
  constexpr int kSide = 96;
  glm::dvec3 sum(0.0);
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const double r2 = (i + 0.5) / kSide, r = std::sqrt(r2), phi = 2 * kPi * (j + 0.5) / kSide;
      sum += roomRadiance(p, {r * std::cos(phi), std::sqrt(1.0 - r2), r * std::sin(phi)});
    }
  return sum / double(kSide * kSide);
}

/// Root of the mean square over all sites, relative to that of the truth.
double relativeError(const std::vector<shared::IndirectTexel>& light, const std::vector<glm::dvec3>& truth) {
  double off = 0.0, all = 0.0;
  for (size_t i = 0; i < truth.size(); ++i) {
    const glm::dvec3 d = glm::dvec3(light[i].diffuse) - truth[i];
    off += glm::dot(d, d);
    all += glm::dot(truth[i], truth[i]);
  }
  return std::sqrt(off / all);
}

Gatherer ballRoom(uint32_t row) {
  auto room = boxPoints(1.0f, row, colouredBox());
  const double areaOfPoint = 24.0 / (6.0 * row * row), ballArea = 4 * kPi * kBallRadius * kBallRadius;
  auto ball = spherePoints(kBallCenter, float(kBallRadius), uint32_t(ballArea / areaOfPoint), glm::vec3(0.25f));
  for (LitPoint& p : ball) p.normal = -p.normal;
  append(room, ball);
  return Gatherer(room, 512, 24.0 + ballArea);
}

TEST(PointProjection, RoundsAverageToTheTruth) {
  Gatherer g = ballRoom(104);
  spreadSites(g, 1.0f, -1.0f);
  std::vector<glm::dvec3> truth;
  for (const auto& site : g.sites) truth.push_back(roomLight(site.posR));
  const double one = relativeError(g.gather(1), truth), mean = relativeError(g.gather(32), truth);
  const double all = relativeError(g.gather(1, kBruteForce), truth);
  const double random = relativeError(g.gather(1, {GatherVariant::atRandom}), truth);
  double uniform[3];
  for (uint32_t side = 1; side <= 3; ++side)
    uniform[side - 1] = relativeError(g.gather(1, {GatherVariant::byImportance, side}), truth);
  EXPECT_LT(one, 0.05);
  EXPECT_LT(mean, one);
  EXPECT_LT(mean, 0.045);
  EXPECT_LT(one, random);                              // [IPP fig. 9]
  for (const double error : uniform) EXPECT_LT(one, error);  // [IPP fig. 7]
  EXPECT_LT(all, 0.1);
}

/// Share of light from everywhere that GGX microfacets reflect straight up once, all of it at each: by midpoints.
double glossyAlbedo(double alpha) {
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosI = (i + 0.5) / kSteps, cos2H = (1.0 + cosI) / 2.0, a2 = alpha * alpha;
    const double d = a2 / (kPi * std::pow(cos2H * (a2 - 1.0) + 1.0, 2));
    const double lambda = 0.5 * (std::sqrt(1.0 + a2 * (1.0 / (cosI * cosI) - 1.0)) - 1.0);
    sum += d / (1.0 + lambda) / 4.0 * 2.0 * kPi / kSteps;
  }
  return sum;
}

TEST(PointProjection, RoughGlossyLobesInTheFurnace) {
  for (const float roughness : {0.5f, 0.7f, 1.0f}) {
    Material metal;
    metal.baseColor = glm::vec4(1.0f);
    metal.metallic = 1.0f;
    metal.roughness = roughness;
    Gatherer g(spherePoints({0, 0, 0}, 1.0f, 65536, glm::vec3(1.0f)), 512, 4 * kPi, 1.0f, &metal, {});
    const auto light = g.gather(4)[0];
    EXPECT_NEAR(light.glossy.g, glossyAlbedo(roughness * roughness), 0.02) << roughness;
    EXPECT_NEAR(light.diffuse.g, 1.0f, 0.02f);
  }
}

/// Light from straight below, sent straight back by a lobe: E D / 4. [IPP §3.2, glossy to glossy]
TEST(PointProjection, LobesOfPointsShineTowardsTheSite) {
  const auto points = parallelogram({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, 64, glm::vec3(0.125f));
  shared::PointLobes lobes{};
  lobes.reflectance = 0x80808080u;  // 1 in packRgbe
  lobes.alpha = 0.5f;
  lobes.normal = gpu::octEncode({0.0f, -1.0f, 0.0f});
  lobes.lobe[1] = {gpu::octEncode({0.0f, -1.0f, 0.0f}), 0x80808080u};
  Gatherer g(points, 64, 1.0, 1.0f, nullptr, std::vector<shared::PointLobes>(4096, lobes));
  const auto texels = g.microBuffers(kBruteForce);
  const float expected = 0.125f + float(1.0 / (kPi * 0.25) / 4.0);
  EXPECT_EQ(texels[16 * 32 + 16].w, 1.0f);
  EXPECT_NEAR(texels[16 * 32 + 16].g, expected, 0.01f * expected);
  EXPECT_EQ(texels[0].w, 0.0f);
  EXPECT_NEAR(g.microBuffers()[16 * 32 + 16].g, expected, 0.01f * expected);
}

/// A normal map tilts the points by 30 degrees: light from 60 degrees is mirrored to the site, E D G / 4 c².
TEST(PointProjection, LobesOfPointsTurnWithTheShadingNormal) {
  const auto points = parallelogram({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, 64, glm::vec3(0.125f));
  const float angle = float(kPi) / 6.0f, c = std::cos(angle);
  shared::PointLobes lobes{};
  lobes.reflectance = 0x80808080u;
  lobes.alpha = 0.5f;
  lobes.lobe[0] = {gpu::octEncode({std::sin(2.0f * angle), -std::cos(2.0f * angle), 0.0f}), 0x80808080u};
  for (const float side : {1.0f, -1.0f}) {  // the site sees the front, then the back
    lobes.normal = gpu::octEncode(side * glm::vec3(std::sin(angle), -c, 0.0f));
    auto turned = points;
    for (LitPoint& p : turned) {
      p.normal *= side;
      if (side < 0.0f) std::swap(p.front, p.back);
    }
    Gatherer g(turned, 64, 1.0, 1.0f, nullptr, std::vector<shared::PointLobes>(4096, lobes));
    const float shadowing = c / std::sqrt(0.25f + 0.75f * c * c);  // height-correlated Smith at two equal angles
    const float expected = 0.125f + shadowing / (float(kPi) * 0.25f * 4.0f * c * c);
    EXPECT_NEAR(g.microBuffers(kBruteForce)[16 * 32 + 16].g, expected, 0.03f * expected) << side;
  }
}

TEST(PointProjection, SameSeedSameBits) {
  Gatherer g(boxPoints(1.0f, 52, colouredBox()), 256, 24.0);
  spreadSites(g, 1.0f, -1.0f);
  const auto a = g.gather(2), b = g.gather(2), wide = g.gather(2, {GatherVariant::byImportance, 0, 32});
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0);
  g.push.seed = 2;
  EXPECT_NE(std::memcmp(a.data(), g.gather(2).data(), a.size() * sizeof(a[0])), 0);
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i].diffuse.g, wide[i].diffuse.g, 0.05f);
}

TEST(PointProjection, SitesWithoutASurfaceStayDark) {
  Gatherer g(boxPoints(1.0f, 26, kWhiteBox), 64, 24.0);
  g.sites.assign(2, g.site({0, 0, 0}));
  g.sites[0].triangle = shared::kNoIndex;
  const auto light = g.gather();
  EXPECT_EQ(light[0].diffuse, glm::vec3(0.0f));
  EXPECT_GT(light[1].diffuse.g, 0.8f);
}

/// All points of some clusters of a closed white box: light from the room on the front, none from outside.
TEST(PointProjection, AtPointsBothSides) {
  Gatherer g(boxPoints(1.0f, 52, kWhiteBox), 256, 24.0);
  std::vector<uint32_t> entries;
  for (uint32_t point = 0; point < 16384; point += 61) entries.insert(entries.end(), {2 * point, 2 * point + 1});
  const auto light = g.gatherAtPoints(entries);
  double sum = 0.0;
  for (size_t i = 0; i < entries.size(); i += 2) {
    const shared::PointLight& p = light[entries[i] / 2];
    EXPECT_LE(p.indirectFront.g, 1.0005f);
    EXPECT_EQ(p.indirectBack, glm::vec3(0.0f));
    sum += p.indirectFront.g;
  }
  EXPECT_GT(sum / double(entries.size() / 2), 0.92);
  EXPECT_EQ(light[1].indirectFront, glm::vec3(0.0f));  // not asked for
}

TEST(PointProjection, EveryScaleGivesTheSame) {
  for (const float scale : {1e-3f, 1.0f, 1e6f}) {
    Gatherer g(boxPoints(scale, 52, kWhiteBox), 256, 24.0 * scale * scale, scale);
    spreadSites(g, scale, -scale);
    const auto light = g.gather();
    expectFinite(light, 1.0005f);
    EXPECT_GT(meanGreen(light), 0.9) << scale;
  }
}

/// Points on the site, in its plane, a single triangle's worth, a wall that it touches.
TEST(PointProjection, HardCasesStayBounded) {
  std::vector<LitPoint> same(512, LitPoint{{0, 0, 0}, {0, 1, 0}, glm::vec3(1.0f), glm::vec3(1.0f)});
  expectFinite(Gatherer(same, 64, 1.0).gather(4), 0.0f);
  for (LitPoint& p : same) p.posR.y = 1e-7f;
  expectFinite(Gatherer(same, 64, 1.0).gather(4), 1.0005f);
  expectFinite(Gatherer(parallelogram({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 32, glm::vec3(1.0f)), 64, 4.0).gather(4), 0.0f);
  expectFinite(Gatherer({LitPoint{{0.1f, 0.5f, 0}, {0, -1, 0}, glm::vec3(1.0f)}}, 1, 1.0).gather(4), 1.0005f);

  Gatherer wall(parallelogram({0, -1, -1}, {0, 2, 0}, {0, 0, 2}, 128, glm::vec3(1.0f)), 128, 4.0);
  wall.sites.clear();
  for (const float x : {0.0f, 1e-7f, 1e-5f, 1e-3f, 0.1f}) wall.sites.push_back(wall.site({x, 0, 0}));
  const auto light = wall.gather(8);
  expectFinite(light, 0.6f);  // a quarter of the sphere of directions, half of the light
  EXPECT_NEAR(light[4].diffuse.g, 0.5f, 0.08f);
}

}  // namespace
}  // namespace limn::test
