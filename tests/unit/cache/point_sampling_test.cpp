#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>

#include "renderer/base/clock.hpp"
#include "renderer/cache/block_metric.hpp"
#include "renderer/cache/block_samples.hpp"
#include "renderer/cache/point_sampling.hpp"
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

TEST(PointSampling, DISABLED_Speed) {
  for (const uint32_t n : {262144u, 1048576u}) {
    const Corners corners = ball(128);
    const double start = nowSeconds();
    const std::vector<BlockSite> sites = sampleBlock(corners, countClassOf(n), 5);
    std::cout << sites.size() << " points in " << nowSeconds() - start << " s\n";
    const double middle = nowSeconds();
    std::cout << relativeRadius(corners, sites) << " in " << nowSeconds() - middle << " s\n";
  }
}

}  // namespace
}  // namespace limn::test
