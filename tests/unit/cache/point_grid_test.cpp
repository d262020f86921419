#include <gtest/gtest.h>

#include <random>
#include <set>

#include "renderer/cache/point_grid.hpp"
#include "renderer/gpu/packing.hpp"

namespace limn::test {
namespace {

/// Random points on the faces of a cube with corners 0 and `size`, normals outwards.
std::vector<shared::SurfacePoint> cubePoints(size_t count, float size) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit;
  std::uniform_int_distribution<int> axis(0, 2);
  std::vector<shared::SurfacePoint> points(count);
  for (shared::SurfacePoint& p : points) {
    p.posR = {unit(random), unit(random), unit(random)};
    const int a = axis(random);
    glm::vec3 normal(0.0f);
    normal[a] = p.posR[a] < 0.5f ? -1.0f : 1.0f;
    p.posR[a] = p.posR[a] < 0.5f ? 0.0f : 1.0f;
    p.posR *= size;
    p.normal = gpu::octEncode(normal);
  }
  return points;
}

/// The points that a look-up meets, as shaders/lib/point_grid.glsl walks; each as often as it is met.
std::multiset<uint32_t> met(const PointGridData& grid, const glm::vec3& posR) {
  const glm::ivec3 base(glm::floor((posR - grid.info.originR) * grid.info.cellsPerM - 0.5f));
  std::multiset<uint32_t> found;
  for (int c = 0; c < 8; ++c) {
    const uint32_t bucket = bucketOf(base + glm::ivec3(c & 1, c >> 1 & 1, c >> 2), grid.info.bucketMask);
    for (uint32_t e = grid.starts[bucket]; e < grid.starts[bucket + 1]; ++e) found.insert(grid.entries[e]);
  }
  return found;
}

TEST(PointGrid, LookUpMeetsEveryPointInReachOnce) {
  for (const float size : {1e-6f, 1.0f, 1e6f}) {
    constexpr uint32_t kSize = 64, kSlots = 16;
    const std::vector<shared::SurfacePoint> points = cubePoints(64 * kSize, size);
    const PointGridData grid =
        buildPointGrid({points, kSize, kSlots, 6.0 * double(size) * size / double(points.size())});
    ASSERT_EQ(grid.entries.size(), points.size() / kSize * kSlots);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(-0.2f, 1.2f);
    size_t inReach = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      const glm::vec3 at = glm::vec3(unit(random), unit(random), unit(random)) * size;
      const std::multiset<uint32_t> found = met(grid, at);
      for (uint32_t i = 0; i < points.size(); ++i) {
        const bool near = i % kSize < kSlots && glm::distance(points[i].posR, at) < 0.9999f * grid.info.radius;
        if (near)
          ASSERT_EQ(found.count(i), 1u) << "point " << i << " of a box of " << size;
        else
          ASSERT_LE(found.count(i), i % kSize < kSlots ? 1u : 0u);
        inReach += near;
      }
    }
    EXPECT_GT(inReach, 1000u);
  }
}

TEST(PointGrid, LowerSlotsComeFirst) {
  const std::vector<shared::SurfacePoint> points = cubePoints(4096, 1.0f);
  const PointGridData grid = buildPointGrid({points, 64, 64, 6.0 / 4096.0});
  for (size_t b = 0; b + 1 < grid.starts.size(); ++b)
    for (uint32_t e = grid.starts[b] + 1; e < grid.starts[b + 1]; ++e)
      EXPECT_LE(grid.entries[e - 1] % 64, grid.entries[e] % 64);
}

TEST(PointGrid, EightNeighboursAreInEightBuckets) {
  for (const uint32_t mask : {7u, 63u, 4095u})
    for (int x = -3; x < 3; ++x)
      for (int y = -3; y < 3; ++y)
        for (int z = -3; z < 3; ++z) {
          std::set<uint32_t> buckets;
          for (int c = 0; c < 8; ++c) buckets.insert(bucketOf({x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)}, mask));
          ASSERT_EQ(buckets.size(), 8u);
          ASSERT_LE(*buckets.rbegin(), mask);
        }
}

TEST(PointGrid, WeightsFallSmoothly) {
  const glm::vec3 up(0.0f, 1.0f, 0.0f);
  EXPECT_FLOAT_EQ(pointWeight(glm::vec3(0.0f), up, 1.0f, 2.0f), 1.0f);
  float last = 1.0f;
  for (float x = 0.1f; x < 2.0f; x += 0.1f) {
    const float w = pointWeight({x, 0.0f, 0.0f}, up, 1.0f, 2.0f);
    EXPECT_LT(w, last);
    EXPECT_GT(w, last - 0.15f);
    last = w;
  }
  EXPECT_EQ(pointWeight({2.0f, 0.0f, 0.0f}, up, 1.0f, 2.0f), 0.0f);
  EXPECT_EQ(pointWeight({0.0f, 0.8f, 0.0f}, up, 1.0f, 2.0f), 0.0f);   // another plane
  EXPECT_EQ(pointWeight({0.1f, 0.0f, 0.0f}, up, -0.5f, 2.0f), 0.0f);  // turned away
}

TEST(PointGrid, EmptyAndCoincident) {
  const PointGridData none = buildPointGrid({{}, 0, 0, 0.0});
  EXPECT_TRUE(none.entries.empty());
  EXPECT_TRUE(met(none, glm::vec3(1.0f)).empty());
  const std::vector<shared::SurfacePoint> points(128, {glm::vec3(3.0f), 0});
  const PointGridData one = buildPointGrid({points, 16, 4, 0.0});
  EXPECT_EQ(met(one, glm::vec3(3.0f)).size(), 32u);
}

}  // namespace
}  // namespace limn::test
