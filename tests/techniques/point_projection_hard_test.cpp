// Scenes that strain gathers over points: finite, without fireflies, and with no more energy than there is.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scene_builder.hpp"
#include "tests/support/technique_pictures.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kWidth = 48, kHeight = 36, kPasses = 8;

FilmImage points(const Scene& scene, uint32_t bounces = 3, uint32_t passes = kPasses) {
  const FilmImage film = pictureOf(scene, pointProjection(kWidth, kHeight, bounces, passes, {{"points", 16384.0}}));
  EXPECT_TRUE(isSound(film));
  return film;
}
FilmImage paths(const Scene& scene, uint32_t bounces = 3) { return pictureOf(scene, pathTracing(kWidth, kHeight, bounces, 256)); }

/// Mean indirect light over that of paths.
double energyQuotient(const Scene& scene, uint32_t bounces = 3) {
  const FilmImage film = points(scene, bounces), truth = paths(scene, bounces);
  EXPECT_EQ(firefliesOf(film, truth, 20.0), 0);
  return meanOf(film, "indirect") / meanOf(truth, "indirect");
}

SceneBuilder roomWithoutLamp() {
  SceneBuilder b = cornellLike();
  b.scene.materials[3].emission = glm::vec3(0.0f);
  return b;
}

TEST(PointProjectionHard, NothingAtAll) {
  SceneBuilder b;
  b.look({0, 0, 3}, {0, 0, 0}, 0.7f);
  EXPECT_EQ(largestOf(points(b.scene), "beauty"), 0.0);
  b.scene.environment.radiance = glm::vec3(0.25f);
  const FilmImage sky = points(b.scene);
  EXPECT_NEAR(largestOf(sky, "direct"), 0.25, 1e-6);
  EXPECT_NEAR(meanOf(sky, "beauty"), 0.25, 1e-6);
}

TEST(PointProjectionHard, ARoomWithoutLight) {
  EXPECT_EQ(largestOf(points(roomWithoutLamp().scene), "beauty"), 0.0);
}

TEST(PointProjectionHard, OneTriangleLightsNothing) {
  SceneBuilder b;
  Primitive p;
  p.material = int32_t(b.diffuse(glm::vec3(0.8f)));
  p.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  p.normals.assign(3, {0, 0, 1});
  p.indices = {0, 1, 2};
  b.mesh(p);
  b.pointLight({0, 0, 1}, glm::vec3(1.0f), 2.0f);
  b.look({0, 0, 3}, {0, 0, 0}, 0.7f);
  const FilmImage film = points(b.scene);
  EXPECT_GT(meanOf(film, "direct"), 0.05);
  EXPECT_EQ(largestOf(film, "indirect"), 0.0);
}

TEST(PointProjectionHard, PointsInOnePlaneLightNoOthers) {
  SceneBuilder b;
  const uint32_t white = b.diffuse(glm::vec3(0.9f)), red = b.diffuse({0.9f, 0.1f, 0.1f});
  for (int i = -2; i < 2; ++i)
    for (int j = -2; j < 2; ++j) {
      const auto x = float(i), z = float(j);
      b.quad((i + j) % 2 == 0 ? white : red, {x, 0.3f, z + 1}, {x + 1, 0.3f, z + 1}, {x + 1, 0.3f, z}, {x, 0.3f, z});
    }
  b.pointLight({0.3f, 0.8f, 0.2f}, glm::vec3(1.0f), 2.0f);
  b.look({0, 2, 3}, {0, 0.3, 0}, 0.9f);
  const FilmImage film = points(b.scene);
  EXPECT_GT(meanOf(film, "direct"), 0.05);
  EXPECT_LE(largestOf(film, "indirect"), 1e-4 * largestOf(film, "direct"));
}

TEST(PointProjectionHard, SurfacesThatLieInEachOther) {
  SceneBuilder b = roomWithoutLamp();
  b.pointLight({0.0f, 0.7f, 0.3f}, glm::vec3(1.0f), 4.0f);
  b.box(1, {-0.4f, -1.0f, -0.3f}, {0.3f, -0.2f, 0.3f});                       // stands in the other block and on the floor
  b.quad(2, {-1, -1, 1}, {0, -1, 1}, {0, -1, 0}, {-1, -1, 0});                // lies in the floor
  b.box(0, {0.5f, -0.5f, -0.999f}, {0.999f, 0.3f, -0.6f});                    // a millimetre from two walls
  const double quotient = energyQuotient(b.scene);
  EXPECT_GT(quotient, 0.85);
  EXPECT_LT(quotient, 1.1);
}

TEST(PointProjectionHard, AMillionTimesAndAThousandthOfTheSize) {
  SceneBuilder b = roomWithoutLamp();
  const uint32_t light = b.pointLight({0.2f, 0.6f, 0.3f}, glm::vec3(1.0f), 4.0f);
  const FilmImage truth = points(b.scene);
  for (const double factor : {1e6, 1e-3}) {
    Scene scene = b.scene;
    for (Node& node : scene.nodes) {
      node.parentFromLocal.scale *= factor;
      node.parentFromLocal.translation *= factor;
    }
    scene.lights[size_t(scene.nodes[light].light)].intensity *= float(factor * factor);
    scene.view.eye *= factor;
    scene.view.target *= factor;
    scene.view.lens.znear *= float(factor);
    const FilmImage film = points(scene);
      EXPECT_LT(relMseOf(film, {truth, truth}, "indirect"), 0.01) << factor;
    EXPECT_NEAR(meanOf(film, "indirect"), meanOf(truth, "indirect"), 0.02 * meanOf(truth, "indirect")) << factor;
  }
}

TEST(PointProjectionHard, ALightInAClosedBoxStaysInIt) {
  SceneBuilder b = roomWithoutLamp();
  const uint32_t grey = b.diffuse(glm::vec3(0.7f));
  b.box(grey, {-0.3f, 0.1f, 0.2f}, {0.3f, 0.7f, 0.8f});
  b.pointLight({0.05f, 0.45f, 0.5f}, glm::vec3(1.0f), 1.0f);
  const FilmImage outside = points(b.scene);
  EXPECT_EQ(largestOf(outside, "direct"), 0.0);
  b.look({-0.25, 0.15, 0.75}, {0.1, 0.4, 0.4}, 1.2f);
  const FilmImage inside = points(b.scene), truth = paths(b.scene);
  EXPECT_EQ(firefliesOf(inside, truth, 20.0), 0);
  // Between splats of a wall that is near, what lies behind it is seen; rays correct that.
  EXPECT_LT(meanOf(outside, "indirect"), 0.001 * meanOf(inside, "indirect"));
  EXPECT_LT(largestOf(outside, "indirect"), 0.01 * meanOf(inside, "indirect"));
  EXPECT_GT(meanOf(inside, "indirect"), 0.95 * meanOf(truth, "indirect"));
  EXPECT_LT(meanOf(inside, "indirect"), 1.02 * meanOf(truth, "indirect"));
}

TEST(PointProjectionHard, HardlyAnySkyInAClosedRoom) {
  SceneBuilder b;
  b.box(b.diffuse(glm::vec3(0.8f)), {-1, -1, -1}, {1, 1, 1});
  b.scene.environment.radiance = glm::vec3(1.0f);
  b.look({0, 0, 0.9}, {0, 0, -1}, 1.2f);
  const FilmImage film = points(b.scene);
  EXPECT_EQ(largestOf(film, "direct"), 0.0);
  EXPECT_LT(largestOf(film, "beauty"), 0.004);  // of a sky of 1: points at the edges, seen from both sides
}

TEST(PointProjectionHard, AShiningRoomAddsItsBouncesAndNoMore) {
  constexpr double kAlbedo = 0.8, kEmission = 0.2;
  constexpr uint32_t kBounces = 6;
  SceneBuilder b;
  const uint32_t walls = b.diffuse(glm::vec3(float(kAlbedo)));
  b.scene.materials[walls].emission = glm::vec3(float(kEmission));
  b.box(walls, {-1, -1, -1}, {1, 1, 1});
  b.look({0.2, 0.3, 0.9}, {0, -0.1, -1}, 1.2f);
  const FilmImage film = points(b.scene, kBounces, 64);
  double direct = kEmission * (1.0 + kAlbedo), indirect = 0.0;
  for (uint32_t k = 2; k <= kBounces + 1; ++k) indirect += kEmission * std::pow(kAlbedo, k);
  EXPECT_NEAR(meanOf(film, "direct"), direct, 0.01 * direct);
  EXPECT_NEAR(meanOf(film, "indirect"), indirect, 0.01 * indirect);
  EXPECT_LT(largestOf(film, "indirect"), 1.06 * indirect);  // noise of the paths of points
}

}  // namespace
}  // namespace limn::test
