// Indirect light that paths bring to points, against closed forms.
#include <gtest/gtest.h>

#include "tests/gpu/point_light_fixture.hpp"
#include "tests/support/statistics.hpp"

namespace limn::test {
namespace {

constexpr double kEmission = 2.0, kAlbedo = 0.5;

/// Every surface shines and reflects alike: the front of each point, which is in the box, sees a geometric series.
SceneBuilder shiningBox() {
  SceneBuilder b;
  Material wall;
  wall.baseColor = glm::vec4(glm::vec3(float(kAlbedo)), 1.0f);
  wall.specular = 0.0f;
  wall.metallic = 0.0f;
  wall.emission = glm::vec3(float(kEmission));
  const uint32_t shining = b.material(wall);
  addFloor(b, shining);
  b.quad(shining, {-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1});
  b.quad(shining, {-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1});
  b.quad(shining, {1, 0, 1}, {-1, 0, 1}, {-1, 2, 1}, {1, 2, 1});
  b.quad(shining, {-1, 0, 1}, {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1});
  b.quad(shining, {1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1});
  return b;
}

struct Mean { double value, deviation; };

Mean frontsOf(const std::vector<shared::PointLight>& light) {
  double sum = 0.0, squares = 0.0;
  const double n = double(light.size());
  for (const shared::PointLight& p : light) sum += p.indirectFront.g, squares += double(p.indirectFront.g) * p.indirectFront.g;
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(squares / n - mean * mean, 0.0) / (n - 1.0))};
}

double series(uint32_t bounces) {
  double sum = 0.0;
  for (uint32_t i = 1; i <= bounces; ++i) sum += std::pow(kAlbedo, i);
  return kEmission * sum;
}

TEST(PointPaths, AShiningBoxGivesTheSeriesOfItsBounces) {
  LitPoints points(shiningBox());
  for (const uint32_t bounces : {1u, 2u, 3u, 8u}) {
    const Mean mean = frontsOf(points.paths({LitPoints::kAll, 32, 0, bounces, bounces}).light());
    EXPECT_NEAR(mean.value, series(bounces), 4.0 * mean.deviation) << bounces;
    EXPECT_LT(mean.deviation, 0.05 * series(bounces));
  }
}

TEST(PointPaths, SharesOfPathsAddUp) {
  LitPoints points(shiningBox());
  const auto once = points.paths({LitPoints::kAll, 8, 0, 3, 5}).light();
  points.paths({LitPoints::kAll, 4, 0, 3, 5});
  const auto twice = points.paths({LitPoints::kAll, 4, 4, 3, 5}).light();
  for (size_t i = 0; i < once.size(); ++i) EXPECT_NEAR(once[i].indirectFront.g, twice[i].indirectFront.g, 1e-5);
}

TEST(PointPaths, DarkSidesAreSoonAskedSeldom) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.8f)));
  LitPoints points(b);  // every path is one ray
  points.paths({LitPoints::kAll, shared::kPathsToBelieveDark, 0, 2, 1});
  const uint64_t before = points.rays();
  EXPECT_EQ(before, uint64_t(SquarePoints::count()) * 2 * shared::kPathsToBelieveDark);
  const auto light = points.paths({LitPoints::kAll, 4, shared::kPathsToBelieveDark, 2, 1}).light();
  for (const shared::PointLight& p : light) EXPECT_EQ(p.indirectFront, glm::vec3(0.0f));
  EXPECT_NEAR(double(points.rays() - before), double(SquarePoints::count()) * 2 * 4 / 4, 0.25 * double(SquarePoints::count()) * 2);
  EXPECT_EQ(points.discarded(), 0u);
}

/// A small bright place that most points do not find by their first paths sends them its light all the same.
TEST(PointPaths, LightThatIsFoundLateIsNotLost) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.0f)));
  b.quad(b.diffuse(glm::vec3(0.8f)), {-0.2f, 1, -0.2f}, {0.2f, 1, -0.2f}, {0.2f, 1, 0.2f}, {-0.2f, 1, 0.2f});
  b.pointLight({0, 0.8f, 0}, glm::vec3(1.0f), 1.0f);
  LitPoints points(b);
  constexpr uint32_t kMany = 256, kPart = shared::kPathsToBelieveDark;
  const Mean once = frontsOf(points.paths({LitPoints::kAll, kMany, 0, 2, 1}).light());
  for (uint32_t taken = 0; taken < kMany; taken += kPart) points.paths({LitPoints::kAll, kPart, taken, 2, 2});
  const Mean parts = frontsOf(points.light());
  EXPECT_GT(once.value, 0.0);
  EXPECT_NEAR(parts.value, once.value, 3.0 * std::hypot(parts.deviation, once.deviation));
  EXPECT_LT(parts.deviation, 0.1 * once.value);
}

TEST(PointPaths, DirectLightIsNotCountedAgain) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.8f)));
  b.quad(b.emitter(glm::vec3(5.0f)), {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});
  LitPoints points(b);
  // What the emitter's faces send directly is direct; they reflect nothing, and nothing else is there.
  for (const shared::PointLight& p : points.paths({LitPoints::kAll, 16, 0, 4, 1}).light())
    EXPECT_LT(p.indirectFront.g, 1e-6f);
}

}  // namespace
}  // namespace limn::test
