// How many samples of direct light the passes of point projection take.
#include <gtest/gtest.h>

#include "tests/support/scene_builder.hpp"
#include "tests/support/technique_pictures.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kPasses = 6;
const Parameters kFewPoints{{"points", 16384.0}, {"auditShare", 0.0}};

float samplesAfterPasses(const Scene& scene, uint32_t samplesAskedFor = 0) {
  TestSession session(scene, pointProjection(48, 32, 2, samplesAskedFor, kFewPoints));
  session.run(kPasses);
  EXPECT_EQ(session.status().steps, kPasses);
  return session.status().meanSamples;
}

/// A floor in the sun, which fills the view: every sample finds the same.
Scene evenFloor() {
  SceneBuilder b;
  b.quad(b.diffuse(glm::vec3(0.5f)), {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50});
  b.directionalLight({0, -1, 0}, glm::vec3(1.0f), 3.0f);
  b.look({0, 3, 1}, {0, 0, 0}, 0.5f);
  return b.scene;
}

TEST(PointProjectionSamples, MoreAPassWhileTheyAreNoisy) {
  EXPECT_EQ(samplesAfterPasses(cornellLike().scene), 2.0f + 4.0f * (kPasses - 2));
}

TEST(PointProjectionSamples, OneAPassWhereThereIsNoNoise) { EXPECT_EQ(samplesAfterPasses(evenFloor()), float(kPasses)); }

TEST(PointProjectionSamples, OneAPassWhereTheirNumberIsAskedFor) {
  EXPECT_EQ(samplesAfterPasses(cornellLike().scene, 2 * kPasses), float(kPasses));
}

TEST(PointProjectionSamples, NoneOverTheLimit) {
  SessionConfig config = pointProjection(48, 32, 2, 0, kFewPoints);
  config.parameters.emplace_back("maxSamples", 9.0);
  TestSession session(cornellLike().scene, config);
  session.run(kPasses);
  EXPECT_EQ(session.status().meanSamples, 9.0f);  // 1 + 1 + 4 + 3
  EXPECT_EQ(session.status().steps, 4u);
}

}  // namespace
}  // namespace limn::test
