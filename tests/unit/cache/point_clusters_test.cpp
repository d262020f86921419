#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <numeric>
#include <random>

#include "renderer/cache/point_clusters.hpp"
#include "tests/support/processor_time.hpp"

namespace limn::test {
namespace {

using Points = std::vector<glm::vec3>;

/// Points on the walls of a box of the given size.
Points onBox(size_t count, const glm::vec3& size, uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit;
  std::uniform_int_distribution<int> axis(0, 2);
  Points points(count);
  for (glm::vec3& p : points) {
    p = {unit(random), unit(random), unit(random)};
    const int a = axis(random);
    p[a] = p[a] < 0.5f ? 0.0f : 1.0f;
    p *= size;
  }
  return points;
}

Points onSquare(size_t count) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit;
  Points points(count);
  for (glm::vec3& p : points) p = {unit(random), 3.0f, unit(random)};
  return points;
}

/// Length of the diagonal of each cluster's box, mean over the clusters.
double meanDiagonal(const Points& points, const std::vector<uint32_t>& order, uint32_t clusters) {
  const size_t size = order.size() / clusters;
  double sum = 0.0;
  for (uint32_t k = 0; k < clusters; ++k) {
    glm::vec3 low(3e38f), high(-3e38f);
    for (size_t i = k * size; i < (k + 1) * size; ++i)
      low = glm::min(low, points[order[i]]), high = glm::max(high, points[order[i]]);
    sum += glm::distance(low, high);
  }
  return sum / clusters;
}

void expectPermutation(const std::vector<uint32_t>& order, size_t count) {
  std::vector<uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  ASSERT_EQ(sorted.size(), count);
  for (uint32_t i = 0; i < count; ++i) ASSERT_EQ(sorted[i], i);
}

TEST(PointClusters, EveryPointIsInOneClusterAndClustersAreTight) {
  constexpr uint32_t kClusters = 512;
  const Points points = onBox(kClusters * 64, {4.0f, 2.0f, 1.0f});
  const std::vector<uint32_t> order = clusterPoints(points, kClusters);
  expectPermutation(order, points.size());
  // 28 units² of walls: a square cluster of a 512th of it has a diagonal of 0.33.
  EXPECT_LT(meanDiagonal(points, order, kClusters), 0.33 * 1.6);
}

/// A plane is cut along its own axes alone.
TEST(PointClusters, PointsInOnePlaneMakeSquares) {
  constexpr uint32_t kClusters = 256;
  const Points points = onSquare(kClusters * 64);
  const double square = std::sqrt(2.0 / kClusters);
  EXPECT_LT(meanDiagonal(points, clusterPoints(points, kClusters), kClusters), square * 1.2);
}

/// Large groups are halved by counting: the same halves as those of a sort, whatever the distribution.
TEST(PointClusters, HalvesAreThoseOfASort) {
  constexpr size_t kCount = 40000;
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit;
  const std::function<float()> coordinates[] = {
      [&] { return unit(random); },                             // even
      [&] { return std::floor(unit(random) * 8.0f) / 8.0f; },   // many in one place
      [&] { return std::exp2(-40.0f * unit(random)); },         // nearly all in the first bin
      [&] { return 1.0f + std::floor(unit(random) * 3.0f) * 0x1p-23f; },  // three neighbouring floats
  };
  for (const auto& coordinate : coordinates) {
    Points points(kCount, glm::vec3(2.0f));
    for (glm::vec3& p : points) p.y = coordinate();
    const std::vector<uint32_t> order = clusterPoints(points, 2);
    std::vector<uint32_t> sorted(kCount);
    std::iota(sorted.begin(), sorted.end(), 0u);
    std::stable_sort(sorted.begin(), sorted.end(), [&](uint32_t a, uint32_t b) { return points[a].y < points[b].y; });
    for (const size_t half : {size_t(0), kCount / 2}) {
      std::vector<uint32_t> ours(order.begin() + half, order.begin() + half + kCount / 2);
      std::vector<uint32_t> expected(sorted.begin() + half, sorted.begin() + half + kCount / 2);
      std::sort(ours.begin(), ours.end());
      std::sort(expected.begin(), expected.end());
      EXPECT_EQ(ours, expected);
    }
  }
}

TEST(PointClusters, CoincidentPointsAreSharedOut) {
  const Points points(1024, glm::vec3(2.5f));
  const std::vector<uint32_t> order = clusterPoints(points, 64);
  expectPermutation(order, points.size());
  // Told apart by index: cluster k holds the indices from 16 k on.
  for (uint32_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i] / 16, i / 16);
}

TEST(PointClusters, SizesThatAreNoPowersOfTwo) {
  for (const size_t size : {1u, 2u, 3u, 7u, 100u, 333u})
    expectPermutation(clusterPoints(onBox(size * 16, glm::vec3(1.0f)), 16), size * 16);
  EXPECT_TRUE(clusterPoints({}, 512).empty());
}

TEST(PointClusters, ScaleDoesNotMatter) {
  const Points points = onBox(4096, {4.0f, 2.0f, 1.0f});
  for (const float scale : {0x1p-30f, 0x1p20f, 0x1p60f}) {
    Points scaled = points;
    for (glm::vec3& p : scaled) p *= scale;
    EXPECT_EQ(clusterPoints(scaled, 64), clusterPoints(points, 64)) << scale;
  }
}

/// Mean distance from the points of a cluster to the nearest of the first m.
double meanGap(const Points& points, std::span<const uint32_t> cluster, size_t m) {
  double sum = 0.0;
  for (const uint32_t i : cluster) {
    float nearest = std::numeric_limits<float>::infinity();
    for (size_t j = 0; j < m; ++j) nearest = std::min(nearest, glm::distance(points[i], points[cluster[j]]));
    sum += nearest;
  }
  return sum / double(cluster.size());
}

/// The first m of a cluster leave smaller gaps than as many random ones, near those of a grid (0.77).
TEST(PointClusters, FirstPointsAreSpread) {
  constexpr uint32_t kClusters = 16, kSize = 500;
  const Points points = onSquare(kClusters * kSize);
  const std::vector<uint32_t> order = clusterPoints(points, kClusters);
  std::mt19937 random(3);
  for (const size_t m : {2u, 3u, 4u, 7u, 8u, 13u, 16u, 25u, 64u, 100u, 250u}) {
    double ours = 0.0, others = 0.0;
    for (uint32_t k = 0; k < kClusters; ++k) {
      std::vector<uint32_t> cluster(order.begin() + k * kSize, order.begin() + (k + 1) * kSize);
      ours += meanGap(points, cluster, m);
      for (int trial = 0; trial < 8; ++trial) {
        std::shuffle(cluster.begin(), cluster.end(), random);
        others += meanGap(points, cluster, m) / 8.0;
      }
    }
    std::cout << "first " << m << ": gaps " << ours / others << " times those of random ones\n";
    EXPECT_LT(ours, 0.92 * others) << m;
  }
}

/// Processor time of clustering so many points, the least of three runs [s].
double secondsToCluster(uint32_t count) {
  const Points points = onBox(count, {4.0f, 2.0f, 1.0f});
  double best = 1e9;
  for (int i = 0; i < 3; ++i) {
    const double start = processorSeconds();
    (void)clusterPoints(points, count / 512);
    best = std::min(best, processorSeconds() - start);
  }
  return best;
}

TEST(PointClusters, WorkGrowsNearlyLinearly) {
  const double small = secondsToCluster(65536), large = secondsToCluster(262144);
  std::cout << "65,536 points: " << small * 1e3 << " ms, 262,144: " << large * 1e3 << " ms of the processor\n";
  EXPECT_LT(large, 10.0 * small) << "16 would be quadratic";
}

}  // namespace
}  // namespace limn::test
