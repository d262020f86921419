#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>

#include "renderer/cache/block_metric.hpp"
#include "renderer/cache/block_samples.hpp"
#include "renderer/cache/point_sampling.hpp"
#include "tests/support/processor_time.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/statistics.hpp"

namespace limn::test {
namespace {

using Corners = std::vector<glm::vec3>;

/// All triangles of the nodes' meshes of a scene as one block.
Corners cornersOf(const Scene& scene) {
  Corners corners;
  for (const Mesh& mesh : scene.meshes)
    for (const Primitive& p : mesh.primitives)
      for (const uint32_t i : p.indices) corners.push_back(p.positions[i]);
  return corners;
}

Corners ball(uint32_t segments) {
  SceneBuilder b;
  b.sphere(b.diffuse(glm::vec3(0.5f)), {0.0f, 0.0f, 0.0f}, 1.0f, segments);
  return cornersOf(b.scene);
}

Corners unitSquare(float scale = 1.0f) {
  SceneBuilder b;
  b.quad(b.diffuse(glm::vec3(0.5f)), {0, 0, 0}, {scale, 0, 0}, {scale, scale, 0}, {0, scale, 0});
  return cornersOf(b.scene);
}

glm::dvec3 positionOf(const Corners& corners, const BlockSite& s) {
  const glm::vec3* c = &corners[size_t(s.triangle) * 3];
  const double u = s.barycentrics.x, v = s.barycentrics.y;
  return glm::dvec3(c[0]) * (1.0 - u - v) + glm::dvec3(c[1]) * u + glm::dvec3(c[2]) * v;
}

std::vector<glm::dvec3> positionsOf(const Corners& corners, std::span<const BlockSite> sites) {
  std::vector<glm::dvec3> positions;
  for (const BlockSite& site : sites) positions.push_back(positionOf(corners, site));
  return positions;
}

std::vector<BlockSite> uniformSites(const Corners& corners, uint32_t count) {
  std::vector<double> areas;
  for (size_t t = 0; t < corners.size(); t += 3) areas.push_back(areaOf(std::span(corners).subspan(t, 3)));
  std::mt19937 random(7);
  std::discrete_distribution<uint32_t> pick(areas.begin(), areas.end());
  std::uniform_real_distribution<float> unit;
  std::vector<BlockSite> sites;
  for (uint32_t i = 0; i < count; ++i) {
    const float root = std::sqrt(unit(random)), v = unit(random);
    sites.push_back({pick(random), {root * (1.0f - v), root * v}});
  }
  return sites;
}

struct Spacing {
  double least = std::numeric_limits<double>::infinity(), mean = 0.0;
};

/// Distances to the nearest neighbour, by looking at all pairs.
Spacing spacingOf(const std::vector<glm::dvec3>& points) {
  Spacing s;
  for (size_t i = 0; i < points.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t j = 0; j < points.size(); ++j)
      if (i != j) nearest = std::min(nearest, glm::distance(points[i], points[j]));
    s.least = std::min(s.least, nearest);
    s.mean += nearest / double(points.size());
  }
  return s;
}

void expectSitesOnTriangles(const Corners& corners, std::span<const BlockSite> sites) {
  for (const BlockSite& s : sites) {
    ASSERT_LT(size_t(s.triangle) * 3 + 2, corners.size());
    ASSERT_GT(areaOf(std::span(corners).subspan(size_t(s.triangle) * 3, 3)), 0.0);
    ASSERT_TRUE(s.barycentrics.x >= 0.0f && s.barycentrics.y >= 0.0f && s.barycentrics.x + s.barycentrics.y <= 1.0f);
  }
}

TEST(PointSampling, ClassesHoldTheirCounts) {
  for (uint32_t n = 1; n < 5000; ++n) {
    const CountClass c = countClassOf(n);
    ASSERT_LE(c.least, n);
    ASSERT_GE(c.most, n);
    ASSERT_EQ(countClassOf(c.least), c);
    ASSERT_EQ(countClassOf(c.most), c);
    ASSERT_LE(c.most, c.least * 1.19 + 1.0);
  }
  EXPECT_EQ(countClassOf(0).most, 0u);
}

TEST(PointSampling, GivesTheExactCount) {
  const Corners corners = ball(12);
  for (const uint32_t n : {1u, 2u, 3u, 17u, 1000u, 4096u}) EXPECT_EQ(sampleBlock(corners, {n, n}, 1).size(), n);
  EXPECT_EQ(sampleBlock(corners, {850, 1000}, 1).size(), 1000u);
  EXPECT_TRUE(sampleBlock(corners, {0, 0}, 1).empty());
}

TEST(PointSampling, PointsAreFarApart) {
  for (const Corners& corners : {unitSquare(), ball(24)}) {
    constexpr uint32_t kCount = 4096;
    const std::vector<BlockSite> sites = sampleBlock(corners, {kCount, kCount}, 3);
    expectSitesOnTriangles(corners, sites);
    const Spacing ours = spacingOf(positionsOf(corners, sites)),
                  random = spacingOf(positionsOf(corners, uniformSites(corners, kCount)));
    const double radius = relativeRadius(corners, sites);
    std::cout << "nearest neighbours: least " << ours.least / random.least << " and mean " << ours.mean / random.mean
              << " times those of random points; relative radius " << radius << '\n';
    EXPECT_GT(ours.least, 15.0 * random.least);
    EXPECT_GT(ours.mean, 1.6 * random.mean);
    EXPECT_GE(radius, 0.6);
    const double densest = 2.0 * std::sqrt(areaOf(corners) / (2.0 * std::sqrt(3.0) * kCount));
    EXPECT_NEAR(radius, ours.least / densest, 1e-4);
  }
}

/// Every set that a class holds is as good.
TEST(PointSampling, PrefixesAreFarApartToo) {
  const Corners corners = ball(24);
  const CountClass c = countClassOf(4000);
  const std::vector<BlockSite> sites = sampleBlock(corners, c, 5);
  for (uint32_t n = c.least; n <= c.most; n += (c.most - c.least) / 5)
    EXPECT_GE(relativeRadius(corners, std::span(sites).first(n)), 0.6) << n << " of " << c.most;
}

/// Points of 64 equal parts of the surface: far more even than chance, so the statistic of Pearson's test is far below
/// its mean for random points, which is the number of degrees of freedom.
TEST(PointSampling, EveryPartHasItsShare) {
  constexpr uint32_t kRow = 8, kCount = 4096;
  const Corners square = unitSquare();
  std::vector<double> counts(kRow * kRow, 0.0);
  for (const glm::dvec3& p : positionsOf(square, sampleBlock(square, {kCount, kCount}, 11)))
    counts[std::min(uint32_t(p.x * kRow), kRow - 1) * kRow + std::min(uint32_t(p.y * kRow), kRow - 1)] += 1.0;
  const GoodnessOfFit fit = chiSquare(counts, std::vector<double>(kRow * kRow, double(kCount) / (kRow * kRow)));
  std::cout << "chi square of 64 squares " << fit.statistic << '\n';
  EXPECT_LT(fit.statistic, 0.35 * fit.dof) << fit.worst;
}

/// The faces of a thin plate are faces like others, and triangles of all sizes get points by their area.
TEST(PointSampling, ThinPlatesAndMixedTrianglesHaveTheirShare) {
  SceneBuilder b;
  const uint32_t m = b.diffuse(glm::vec3(0.5f));
  b.box(m, {0, 0, 0}, {1, 1, 0.002f});                    // 2.008 of area in a thin plate
  b.quad(m, {3, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0});  // 1
  b.sphere(m, {6, 0, 0}, 0.4f, 32);                       // about 2
  const Corners corners = cornersOf(b.scene);
  constexpr uint32_t kCount = 8192;
  std::vector<double> counts(4, 0.0), expected(4, 0.0);
  const auto part = [&](size_t t) {
    const glm::vec3* c = &corners[t * 3];
    if (c->x > 5.0f) return size_t(3);
    if (c->x > 2.0f) return size_t(2);
    return size_t(glm::cross(c[1] - c[0], c[2] - c[0]).z > 0.5f);
  };
  for (const BlockSite& site : sampleBlock(corners, {kCount, kCount}, 12)) counts[part(site.triangle)] += 1.0;
  for (size_t t = 0; t * 3 < corners.size(); ++t)
    expected[part(t)] += kCount * areaOf(std::span(corners).subspan(t * 3, 3)) / areaOf(corners);
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(counts[i], expected[i], 0.03 * expected[i]) << "part " << i;
}

TEST(PointSampling, SameArgumentsGiveTheSameBits) {
  // More candidates than one core thins out, so that parts are shared.
  const Corners corners = ball(24);
  const std::vector<BlockSite> first = sampleBlock(corners, {30000, 30000}, 9);
  EXPECT_EQ(first, sampleBlock(corners, {30000, 30000}, 9));
  EXPECT_NE(first, sampleBlock(corners, {30000, 30000}, 10));
  const double radius = relativeRadius(corners, first);
  std::cout << "relative radius of 30,000 points thinned in parts " << radius << '\n';
  EXPECT_GE(radius, 0.6);
}

TEST(PointSampling, ScaleDoesNotMatter) {
  const Corners corners = ball(12);
  const std::vector<BlockSite> sites = sampleBlock(corners, {500, 500}, 2);
  for (const float scale : {0x1p-40f, 0x1p20f, 0x1p50f}) {
    Corners scaled = corners;
    for (glm::vec3& c : scaled) c *= scale;
    EXPECT_EQ(sampleBlock(scaled, {500, 500}, 2), sites) << scale;
    EXPECT_DOUBLE_EQ(relativeRadius(scaled, sites), relativeRadius(corners, sites));
  }
}

TEST(PointSampling, DegenerateTrianglesGetNothing) {
  Corners corners = unitSquare();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const glm::vec3 c : {glm::vec3(5.0f), glm::vec3(5.0f), glm::vec3(5.0f),  // a point
                            glm::vec3(0.0f), glm::vec3(1.0f), glm::vec3(2.0f),  // a line
                            glm::vec3(nan), glm::vec3(1.0f), glm::vec3(2.0f, 0.0f, 0.0f)})
    corners.push_back(c);
  const std::vector<BlockSite> sites = sampleBlock(corners, {1000, 1000}, 2);
  ASSERT_EQ(sites.size(), 1000u);
  for (const BlockSite& site : sites) ASSERT_LT(site.triangle, 2u);
  EXPECT_GE(relativeRadius(corners, sites), 0.6);
  EXPECT_TRUE(sampleBlock(std::span(corners).subspan(6), {10, 10}, 2).empty());
  EXPECT_TRUE(sampleBlock({}, {10, 10}, 2).empty());
}

/// One triangle, a needle, and a thousand sheets in one place: exact counts on the triangles, in good time.
TEST(PointSampling, HardBlocksEndWell) {
  const Corners one{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_GE(relativeRadius(one, sampleBlock(one, {2048, 2048}, 1)), 0.6);

  const Corners needle{{0, 0, 0}, {1, 0, 0}, {1, 1e-9f, 0}};
  const std::vector<BlockSite> onNeedle = sampleBlock(needle, {5000, 5000}, 1);
  EXPECT_EQ(onNeedle.size(), 5000u);
  expectSitesOnTriangles(needle, onNeedle);

  Corners sheets;
  for (int i = 0; i < 1000; ++i) sheets.insert(sheets.end(), one.begin(), one.end());
  const std::vector<BlockSite> onSheets = sampleBlock(sheets, {20000, 20000}, 1);
  EXPECT_EQ(onSheets.size(), 20000u);
  expectSitesOnTriangles(sheets, onSheets);
}

TEST(PointSampling, WorkGrowsNearlyLinearly) {
  const Corners corners = ball(128);
  double seconds[2];
  for (const uint32_t i : {0u, 1u}) {
    const double start = processorSeconds();
    const std::vector<BlockSite> sites = sampleBlock(corners, countClassOf(65536u << 2 * i), 5);
    seconds[i] = processorSeconds() - start;
    std::cout << sites.size() << " points in one block: " << seconds[i] << " s of the processor, relative radius "
              << relativeRadius(corners, sites) << '\n';
  }
  EXPECT_LT(seconds[1], 10.0 * seconds[0]) << "16 would be quadratic";
}

TEST(BlockMetric, TurningAndMovingKeepTheStretch) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const glm::dmat3 shape(glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.3, 2.0, 0.0), glm::dvec3(0.1, 0.2, 0.7));
  for (int i = 0; i < 100; ++i) {
    const glm::dquat q = glm::normalize(glm::dquat(normal(random), normal(random), normal(random), normal(random)));
    EXPECT_EQ(roundedStretch(glm::mat3_cast(q) * shape), roundedStretch(shape));
    EXPECT_EQ(roundedStretch(glm::mat3_cast(q)), glm::dmat3(1.0));
  }
  EXPECT_EQ(roundedStretch(glm::dmat3(1.004)), glm::dmat3(1.0));
  EXPECT_NE(roundedStretch(glm::dmat3(1.012)), glm::dmat3(1.0));
  EXPECT_EQ(roundedStretch(glm::dmat3(0.0)), glm::dmat3(0.0));
}

TEST(BlockMetric, LengthsAreKept) {
  const glm::dmat3 m(glm::dvec3(1.0, 0.2, 0.1), glm::dvec3(-0.3, 2.0, 0.0), glm::dvec3(0.4, 0.2, 5.0));
  const glm::dmat3 u = roundedStretch(m);
  for (const glm::dvec3& v :
       {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 1, 1), glm::dvec3(-1, 2, 0.5)})
    EXPECT_NEAR(glm::length(u * v), glm::length(m * v), 0.015 * glm::length(m * v));
}

TEST(BlockMetric, ShapesForgetTheScale) {
  const glm::dmat3 sheared(glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.3, 2.0, 0.0), glm::dvec3(0.1, 0.2, 0.7));
  for (const double scale : {1e-9, 0.3, 1e9})
    EXPECT_EQ(roundedShape(sheared * scale), roundedShape(sheared)) << scale;
  const auto shapeOf = [](double x, double y, double z) {
    return roundedShape(glm::dmat3(glm::dvec3(x, 0, 0), glm::dvec3(0, y, 0), glm::dvec3(0, 0, z)));
  };
  EXPECT_EQ(shapeOf(1, 1, 1), glm::dmat3(1.0));
  EXPECT_EQ(shapeOf(1.05, 1, 1.07), glm::dmat3(1.0));
  EXPECT_NE(shapeOf(1.25, 1, 1), glm::dmat3(1.0));
  EXPECT_EQ(shapeOf(3, 0, 0), glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0), glm::dvec3(0)));
  EXPECT_EQ(shapeOf(0, 0, 0), glm::dmat3(0.0));
}

TEST(PointSampling, MisplacedShareIsWhatWouldHaveToMove) {
  const Corners corners = ball(12);
  Corners larger = corners;
  for (glm::vec3& c : larger) c *= 3.0f;
  EXPECT_NEAR(misplacedShare(corners, larger), 0.0, 1e-6);
  const Corners pair{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  Corners grown = pair;
  grown[1].x = 3.0f;  // half and half become three quarters and a quarter
  EXPECT_NEAR(misplacedShare(pair, grown), 0.25, 1e-6);
  EXPECT_NEAR(misplacedShare(grown, pair), 0.25, 1e-6);
  EXPECT_EQ(misplacedShare(pair, Corners(6, glm::vec3(0.0f))), 1.0);
}

TEST(ShareOut, AddsUpAndFollowsTheWeights) {
  EXPECT_EQ(shareOut(10, {1.0, 1.0, 1.0}), (std::vector<uint32_t>{4, 3, 3}));
  EXPECT_EQ(shareOut(7, {0.0, 5.0, 0.0}), (std::vector<uint32_t>{0, 7, 0}));
  EXPECT_EQ(shareOut(7, {0.0, 0.0}), (std::vector<uint32_t>{0, 0}));
  EXPECT_TRUE(shareOut(7, {}).empty());
  EXPECT_EQ(shareOut(2, {1.0, 1.5, 1.0, 1.5}), (std::vector<uint32_t>{0, 1, 0, 1}));
}

}  // namespace
}  // namespace limn::test
