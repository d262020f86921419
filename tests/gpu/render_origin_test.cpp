// Where render space has its origin.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "renderer/gpu/geometry.hpp"

namespace limn::test {
namespace {

Bounds around(const glm::dvec3& center, double radius) {
  const glm::dvec3 half(radius / std::sqrt(3.0));
  return {center - half, center + half};
}

TEST(RenderOrigin, IsZeroForScenesNearZero) {
  for (const double radius : {1e-3, 1.0, 1.9, 7e3}) {
    EXPECT_EQ(gpu::renderOriginOf(around(glm::dvec3(0.0), radius)), glm::dvec3(0.0));
    EXPECT_EQ(gpu::renderOriginOf(around({1.9 * radius, 0.0, -1.9 * radius}, radius)), glm::dvec3(0.0));
  }
  EXPECT_EQ(gpu::renderOriginOf(Bounds{}), glm::dvec3(0.0));
}

// Coordinates of at most five radii are rounded by less than a millionth of a radius.
TEST(RenderOrigin, LiesAFewRadiiFromTheCentreHoweverFarOutThatIs) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const double radius = std::exp2(10.0 * unit(random)), distance = radius * std::exp2(10.0 * unit(random));
    const glm::dvec3 center = distance * glm::dvec3(unit(random), unit(random), unit(random));
    const glm::dvec3 rest = glm::abs(center - gpu::renderOriginOf(around(center, radius)));
    EXPECT_LE(std::max({rest.x, rest.y, rest.z}), 4.0 * radius * (1.0 + 1e-9)) << "radius " << radius << ", distance " << distance;
  }
}

TEST(RenderOrigin, StaysWhileTheSceneMovesALittle) {
  const glm::dvec3 center(1e5, 0.0, -1e5);
  const glm::dvec3 origin = gpu::renderOriginOf(around(center, 7e3));
  EXPECT_NE(origin, glm::dvec3(0.0));
  EXPECT_EQ(gpu::renderOriginOf(around(center + glm::dvec3(300.0), 7e3)), origin);
  EXPECT_EQ(gpu::renderOriginOf(around(center, 7.5e3)), origin);
}

}  // namespace
}  // namespace limn::test
