// Light by point projection against paths of as many bounces: direct light is the same but for noise, gathered light within
// the bounds stated here, which are those of the technique's bias at the sizes used. Pictures of few pixels ask more of it than
// large ones: corners and contacts, where gathers are worst, are a larger share of them.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scene_builder.hpp"
#include "tests/support/technique_pictures.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kWidth = 48, kHeight = 36;
constexpr uint32_t kPasses = 80;  // by then every pixel was gathered
constexpr uint32_t kSphere = 6;   // mesh of cornellLike()

/// The lamp flush with the ceiling, which is open above it.
SceneBuilder flushLamp() {
  SceneBuilder b = cornellLike();
  b.scene.nodes[1].mesh = b.scene.nodes[7].mesh = kNone;
  const float sides[] = {-1.0f, -0.3f, 0.3f, 1.0f};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const float x = sides[i], z = sides[j], x1 = sides[i + 1], z1 = sides[j + 1];
      b.quad(i == 1 && j == 1 ? 3 : 0, {x, 1, z}, {x1, 1, z}, {x1, 1, z1}, {x, 1, z1});
    }
  return b;
}

SceneBuilder withPointLight() {
  SceneBuilder b = cornellLike();
  b.scene.materials[3].emission = glm::vec3(0.0f);
  b.pointLight({0.0f, 0.7f, 0.2f}, {1.0f, 0.9f, 0.7f}, 6.0f);
  return b;
}

Scene withSphere(SceneBuilder b, float metallic, float roughness, float transmission = 0.0f) {
  Material m;
  m.baseColor = {0.9f, 0.8f, 0.6f, 1.0f};
  m.metallic = metallic;
  m.roughness = roughness;
  m.transmission = transmission;
  m.thickness = transmission;
  b.scene.meshes[kSphere].primitives[0].material = int32_t(b.material(m));
  return b.scene;
}

/// What separates the two techniques; the filter is left out unless told, for it blurs by pixels, of which there are few.
struct Difference {
  Deviation direct;
  double indirect = 0.0, beauty = 0.0;  ///< bias, as relMSE
  double energy = 0.0;                  ///< indirect light over that of paths
  int fireflies = 0;
};

Difference differenceOf(const Scene& scene, uint32_t bounces, uint32_t pathBounces,
                        Parameters more = {{"filterSize", 1.0}}) {
  const PicturePair truth = pairOf(scene, pathTracing(kWidth, kHeight, pathBounces, 512));
  const PicturePair pair = pairOf(scene, pointProjection(kWidth, kHeight, bounces, kPasses, std::move(more)));
  for (const FilmImage* film : {&pair.a, &pair.b}) EXPECT_TRUE(isSound(*film));
  return {deviationOf(pair, truth, "direct"), biasOf(pair, truth, "indirect"), biasOf(pair, truth, "beauty"),
          meanOf(pair.a, "indirect") / meanOf(truth.a, "indirect"), firefliesOf(pair.a, truth.a, 20.0)};
}

void expectAlike(const Difference& d, double indirect, double energy) {
  EXPECT_LT(d.direct.whole, 3.0);
  EXPECT_LT(d.direct.worstTile, 5.0);
  EXPECT_LT(d.indirect, indirect);
  EXPECT_NEAR(d.energy, 1.0, energy);
  EXPECT_EQ(d.fireflies, 0);
}

TEST(PointProjectionLight, AreaLight) {
  expectAlike(differenceOf(flushLamp().scene, 1, 1), 0.005, 0.02);
  expectAlike(differenceOf(flushLamp().scene, 3, 3), 0.005, 0.02);
}

TEST(PointProjectionLight, PointLight) {
  expectAlike(differenceOf(withPointLight().scene, 1, 1), 0.005, 0.03);
  expectAlike(differenceOf(withPointLight().scene, 3, 3), 0.005, 0.03);
}

// Light sampling knows no unlit surfaces: paths that begin at points bring what these send.
TEST(PointProjectionLight, UnlitPanel) {
  SceneBuilder b = flushLamp();
  b.scene.materials[3].emission = glm::vec3(0.0f);
  b.scene.materials[3].unlit = true;
  b.scene.materials[3].baseColor = {9.0f, 9.0f, 9.0f, 1.0f};
  const PicturePair truth = pairOf(b.scene, pathTracing(kWidth, kHeight, 8, 1024));
  const PicturePair pair = pairOf(b.scene, pointProjection(kWidth, kHeight, 8, kPasses));
  // Gathers light the first surface, which see no edges of shadows; what is held here is the energy.
  EXPECT_NEAR(meanOf(pair.a, "beauty") / meanOf(truth.a, "beauty"), 1.0, 0.05);
}

TEST(PointProjectionLight, RoughMetal) {
  const Scene scene = withSphere(flushLamp(), 1.0f, 0.6f);
  expectAlike(differenceOf(scene, 1, 1), 0.007, 0.02);
  expectAlike(differenceOf(scene, 3, 3), 0.007, 0.02);
}

// Rays through sharp lobes make no bounce of gathers: both end where it no longer matters.
TEST(PointProjectionLight, Mirror) { expectAlike(differenceOf(withSphere(flushLamp(), 1.0f, 0.0f), 8, 12), 0.005, 0.02); }

TEST(PointProjectionLight, Glass) { expectAlike(differenceOf(withSphere(flushLamp(), 0.0f, 0.0f, 1.0f), 8, 16), 0.03, 0.02); }

// Direct light is what passed nothing but panes, for either technique; gathers see a pane as a surface that glows. They
// reflect nothing: paths do not find a point light in a mirror. Both end where one bounce more no longer matters.
TEST(PointProjectionLight, PanesBeforeTheLampAndBeforeTheEye) {
  SceneBuilder b = withPointLight();
  Material tinted;
  tinted.metallic = tinted.roughness = 0.0f;
  tinted.transmission = tinted.ior = 1.0f;
  tinted.baseColor = {0.5f, 0.8f, 0.6f, 1.0f};
  const uint32_t pane = b.material(tinted);
  b.quad(pane, {-0.5f, 0.4f, 0.7f}, {0.6f, 0.4f, 0.7f}, {0.6f, 0.4f, -0.4f}, {-0.5f, 0.4f, -0.4f});
  b.quad(pane, {-0.9f, -0.9f, 0.9f}, {0.9f, -0.9f, 0.9f}, {0.9f, 0.2f, 0.9f}, {-0.9f, 0.2f, 0.9f});
  expectAlike(differenceOf(b.scene, 8, 12), 0.01, 0.03);
}

TEST(PointProjectionLight, TheFilterBlursByPixelsWhatNoEdgeTellsApart) {
  const Difference d = differenceOf(withPointLight().scene, 1, 1, {});
  EXPECT_LT(d.indirect, 0.35);
  EXPECT_LT(d.beauty, 0.04);
}

// A lamp 1 cm under the ceiling, which shines up too: splats let through what lies so close behind a surface, and rays correct it.
TEST(PointProjectionLight, AGapNarrowerThanSplatsLeaksNothing) {
  const Difference d = differenceOf(cornellLike().scene, 3, 3);
  EXPECT_NEAR(d.energy, 1.0, 0.03);
  EXPECT_LT(d.beauty, 0.01);
  EXPECT_EQ(d.fireflies, 0);
}

}  // namespace
}  // namespace limn::test
