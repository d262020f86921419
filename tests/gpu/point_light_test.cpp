#include "tests/gpu/point_light_fixture.hpp"

namespace limn::test {
namespace {

constexpr glm::vec3 kNone3{0.0f};

void expectRelative(const glm::vec3& measured, const glm::dvec3& expected, double tolerance, uint32_t point) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(measured[k], expected[k], tolerance * expected[k]) << "point " << point;
}

/// A black square above the floor, over x > 0.
void addBlocker(SceneBuilder& b, uint32_t material) {
  b.quad(material, {0.0f, 0.5f, 5.0f}, {9.0f, 0.5f, 5.0f}, {9.0f, 0.5f, -5.0f}, {0.0f, 0.5f, -5.0f});
}

SceneBuilder floorUnderSun(uint32_t blocker = 0, const Material& material = {}) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.5f)));
  if (blocker) addBlocker(b, b.material(material));
  b.directionalLight({0.0f, -1.0f, 0.0f}, glm::vec3(1.0f), 3.0f);
  return b;
}

TEST(PointLight, PointLightOverAPlane) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.5f)));
  const glm::vec3 source(0.3f, 1.5f, -0.2f), color(1.0f, 0.5f, 0.25f);
  b.pointLight(source, color, 5.0f);
  LitPoints lit(b);
  const auto light = lit.relight(1).light();
  const SquarePoints floor = floorPoints();
  for (uint32_t i = 0; i < floor.count(); ++i) {
    const double expected = pointLightOn(floor.position(i), floor.normal(), source, 5.0);
    expectRelative(light[i].directFront, glm::dvec3(color) * expected, 1e-5, i);
    EXPECT_EQ(light[i].directBack, kNone3);
  }
  EXPECT_EQ(lit.rays(), floor.count());
  EXPECT_EQ(lit.discarded(), 0u);
}

TEST(PointLight, SunUnderAnAngle) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.5f)));
  b.directionalLight({0.6f, -0.8f, 0.0f}, {1.0f, 2.0f, 4.0f}, 3.0f);
  const auto light = LitPoints(b).relight(2).light();
  for (uint32_t i = 0; i < light.size(); ++i)
    expectRelative(light[i].directFront, glm::dvec3(1.0, 2.0, 4.0) * (3.0 * 0.8 / kPi), 1e-5, i);
}

TEST(PointLight, SpotFadesBetweenItsCones) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.5f)));
  const glm::dvec3 source(0.1, 1.0, 0.2);
  const double inner = 0.35, outer = 0.7;
  b.spotLight(source, {0.0f, -1.0f, 0.0f}, 2.0f, float(inner), float(outer));
  const auto light = LitPoints(b).relight(1).light();
  const SquarePoints floor = floorPoints();
  uint32_t dark = 0, full = 0;
  for (uint32_t i = 0; i < floor.count(); ++i) {
    const glm::dvec3 p = floor.position(i);
    const double cosine = (source.y - p.y) / glm::length(source - p);
    const double ramp = std::clamp((cosine - std::cos(outer)) / (std::cos(inner) - std::cos(outer)), 0.0, 1.0);
    EXPECT_NEAR(light[i].directFront.g, ramp * ramp * pointLightOn(p, floor.normal(), source, 2.0), 1e-5) << i;
    dark += ramp == 0.0;
    full += ramp == 1.0;
  }
  EXPECT_GT(dark, 10u);
  EXPECT_GT(full, 10u);
}

/// Form factor of a point and a parallel rectangle whose corner is above the point, odd in both sides. [Howell, C-3]
double cornerFactor(double a, double b) {
  const double ra = std::sqrt(1.0 + a * a), rb = std::sqrt(1.0 + b * b);
  return (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2.0 * kPi);
}
/// Irradiance / pi on the floor from a lamp of radiance 1 over [-w, w]² at height h.
double lampOn(const glm::dvec3& p, double w, double h) {
  double sum = 0.0;
  for (const double x : {w - p.x, w + p.x})
    for (const double z : {w - p.z, w + p.z}) sum += cornerFactor(x / h, z / h);
  return sum;
}

SceneBuilder floorUnderLamp(float height) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.5f)));
  b.quad(b.emitter({4.0f, 2.0f, 1.0f}), {-0.4f, height, -0.4f}, {0.4f, height, -0.4f}, {0.4f, height, 0.4f},
         {-0.4f, height, 0.4f});
  return b;
}

TEST(PointLight, LampMatchesItsFormFactor) {
  LitPoints lit(floorUnderLamp(0.8f));
  for (uint32_t pass = 0; pass < 16; ++pass) lit.relight(64, 64 * pass);
  const auto light = lit.light();
  double sum = 0.0, expectedSum = 0.0;
  for (uint32_t i = 0; i < light.size(); ++i) {
    const double expected = lampOn(floorPoints().position(i), 0.4, 0.8);
    expectRelative(light[i].directFront, glm::dvec3(4.0, 2.0, 1.0) * expected, 0.02, i);
    EXPECT_EQ(light[i].directBack, kNone3);
    sum += light[i].directFront.b;
    expectedSum += expected;
  }
  EXPECT_NEAR(sum, expectedSum, 1e-3 * expectedSum);
}

TEST(PointLight, AFarLampIsNoLessExact) {
  const auto light = LitPoints(floorUnderLamp(30.0f)).relight(64).light();  // its triangles fill 4e-4 sr each
  for (uint32_t i = 0; i < light.size(); ++i)
    expectRelative(light[i].directFront, glm::dvec3(4.0, 2.0, 1.0) * lampOn(floorPoints().position(i), 0.4, 30.0), 1e-3,
                   i);
}

TEST(PointLight, ALampThatTouchesBlindsNoPoint) {
  const auto once = LitPoints(floorUnderLamp(0.01f)).relight(1).light();
  const auto light = LitPoints(floorUnderLamp(0.01f)).relight(512).light();
  double sum = 0.0, expectedSum = 0.0;
  for (uint32_t i = 0; i < light.size(); ++i) {
    const double expected = lampOn(floorPoints().position(i), 0.4, 0.01);
    EXPECT_LE(once[i].directFront.b, 8.0f) << "more than the lamp's radiance from 2 times 2 pi";
    EXPECT_NEAR(light[i].directFront.b, expected, 0.2) << i;
    sum += light[i].directFront.b;
    expectedSum += expected;
  }
  EXPECT_NEAR(sum, expectedSum, 0.01 * expectedSum);
}

TEST(PointLight, EqualSkyGivesItsRadiance) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.5f)));
  b.scene.environment.radiance = {2.0f, 1.0f, 0.5f};
  const auto light = LitPoints(b).relight(256).light();
  for (uint32_t i = 0; i < light.size(); ++i) {
    expectRelative(light[i].directFront, {2.0, 1.0, 0.5}, 0.02, i);
    expectRelative(light[i].directBack, {2.0, 1.0, 0.5}, 0.02, i);
  }
}

TEST(PointLight, ABlockerCastsAShadow) {
  const auto light = LitPoints(floorUnderSun(1)).relight(1).light();
  for (uint32_t i = 0; i < light.size(); ++i)
    EXPECT_NEAR(light[i].directFront.r, floorPoints().position(i).x > 0.0 ? 0.0 : 3.0 / kPi, 1e-5) << i;
}

TEST(PointLight, SidesAreLitApart) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.5f)));
  b.directionalLight({0.0f, -1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 2.0f);
  b.directionalLight({0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 2.0f);
  const auto light = LitPoints(b).relight(64).light();
  for (uint32_t i = 0; i < light.size(); ++i) {
    expectRelative(light[i].directFront, {2.0 / kPi, 0.0, 0.0}, 0.1, i);
    expectRelative(light[i].directBack, {0.0, 2.0 / kPi, 0.0}, 0.1, i);
  }
}

/// A floor whose normal map leans everywhere by `angle` towards +x.
SceneBuilder leaningFloor(double angle) {
  SceneBuilder b;
  Image image;
  image.width = image.height = 1;
  for (const double v : {std::sin(angle), 0.0, std::cos(angle), 1.0})
    image.rgba8.push_back(uint8_t(std::lround(v * 127.5 + 127.5)));
  b.scene.images.push_back(image);
  const uint32_t material = b.diffuse(glm::vec3(0.5f));
  b.scene.materials[material].normalTexture.image = 0;
  Primitive p;
  p.material = int32_t(material);
  p.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
  p.normals.assign(4, {0.0f, 1.0f, 0.0f});
  p.tangents.assign(4, {1.0f, 0.0f, 0.0f, 1.0f});
  p.uv0 = {{0.0f, 1.0f}, {1.0f, 1.0f}, {1.0f, 0.0f}, {0.0f, 0.0f}};
  p.indices = {0, 1, 2, 0, 2, 3};
  b.mesh(p);
  return b;
}

TEST(PointLight, NormalMapsTiltTheIrradiance) {
  SceneBuilder b = leaningFloor(0.5);
  b.directionalLight({-0.6f, -0.8f, 0.0f}, glm::vec3(1.0f), kPi);
  const auto light = LitPoints(b).relight(1).light();
  const double expected = 0.6 * std::sin(0.5) + 0.8 * std::cos(0.5);
  for (uint32_t i = 0; i < light.size(); ++i) expectRelative(light[i].directFront, glm::dvec3(expected), 0.01, i);
}

TEST(PointLight, NormalMapsLeakNoLightToTheOtherSide) {
  SceneBuilder b = leaningFloor(0.9);
  b.directionalLight({0.95f, -0.3f, 0.0f}, glm::vec3(1.0f), 3.0f);  // on the front, behind the leaning normal
  const auto light = LitPoints(b).relight(1).light();
  for (const shared::PointLight& l : light) {
    EXPECT_EQ(l.directFront, kNone3);
    EXPECT_EQ(l.directBack, kNone3);
  }
}

TEST(PointLight, AlphaDecidesWhetherABlockerIsThere) {
  Material material;
  material.metallic = 0.0f;
  material.alphaMode = AlphaMode::mask;
  material.baseColor.a = 0.2f;
  for (const auto& l : LitPoints(floorUnderSun(1, material)).relight(1).light())
    EXPECT_NEAR(l.directFront.r, 3.0 / kPi, 1e-5);

  material.alphaMode = AlphaMode::blend;
  material.baseColor.a = 0.25f;
  double shaded = 0.0;
  const auto light = LitPoints(floorUnderSun(1, material)).relight(64).light();
  for (uint32_t i = 0; i < light.size(); ++i)
    if (floorPoints().position(i).x > 0.0) shaded += light[i].directFront.r / (light.size() / 2.0);
  EXPECT_NEAR(shaded, 0.75 * 3.0 / kPi, 0.02);  // 8,192 samples: a standard error of 0.005
}

SceneBuilder manyLights() {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.5f)));
  b.quad(b.emitter({4.0f, 2.0f, 1.0f}), {-0.4f, 0.8f, -0.4f}, {0.4f, 0.8f, -0.4f}, {0.4f, 0.8f, 0.4f},
         {-0.4f, 0.8f, 0.4f});
  b.pointLight({0.6f, 0.7f, 0.1f}, glm::vec3(1.0f), 1.0f);
  b.spotLight({-0.8f, 0.8f, 0.5f}, {0.6f, -0.8f, -0.4f}, 2.0f, 0.2f, 0.9f);
  b.scene.environment.radiance = glm::vec3(0.3f);
  return b;
}

TEST(PointLight, PassesAddUpToOneLongPass) {
  const auto whole = LitPoints(manyLights()).relight(96).light();
  const auto parts = LitPoints(manyLights()).relight(1).relight(3, 1).relight(60, 4).relight(32, 64).light();
  for (uint32_t i = 0; i < whole.size(); ++i) {
    expectRelative(parts[i].directFront, whole[i].directFront, 1e-5, i);
    expectRelative(parts[i].directBack, whole[i].directBack, 1e-5, i);
  }
}

TEST(PointLight, TheSameBitsAlways) {
  const auto once = LitPoints(manyLights()).relight(4).light();
  const auto again = LitPoints(manyLights()).relight(4).light();
  const auto inRanges = LitPoints(manyLights()).relight({{0, 5}, 4, 0, 1}).relight({{5, 32}, 4, 0, 1}).light();
  const auto otherSeed = LitPoints(manyLights()).relight(4, 0, 2).light();
  const size_t bytes = once.size() * sizeof(once[0]);
  EXPECT_EQ(std::memcmp(once.data(), again.data(), bytes), 0);
  EXPECT_EQ(std::memcmp(once.data(), inRanges.data(), bytes), 0);
  EXPECT_NE(std::memcmp(once.data(), otherSeed.data(), bytes), 0);
}

TEST(PointLight, SlotsOutsideTheRangeKeepTheirLight) {
  const auto light = LitPoints(floorUnderSun()).relight({{3, 7}, 1, 0, 1}).light();
  for (uint32_t i = 0; i < light.size(); ++i) {
    const uint32_t slot = i % SquarePoints::kLayout.clusterSize;
    EXPECT_EQ(light[i].directFront.r > 0.0f, slot >= 3 && slot < 7) << i;
  }
}

TEST(PointLight, RelightingLeavesIndirectLight) {
  LitPoints lit(floorUnderSun());
  lit.write(std::vector<shared::PointLight>(SquarePoints::count(), {kNone3, kNone3, {1, 2, 3}, {4, 5, 6}}));
  for (const auto& l : lit.relight(1).light()) {
    EXPECT_EQ(l.indirectFront, glm::vec3(1, 2, 3));
    EXPECT_EQ(l.indirectBack, glm::vec3(4, 5, 6));
    EXPECT_NEAR(l.directFront.r, 3.0 / kPi, 1e-5);
  }
}

TEST(PointLight, ThePipelineCutToTheSceneAgreesWithTheGeneralOne) {
  const auto general = LitPoints(manyLights()).relight(16).light();
  const auto tailored = LitPoints(manyLights(), true).relight(16).light();
  for (uint32_t i = 0; i < general.size(); ++i)
    expectRelative(tailored[i].directFront, general[i].directFront, 1e-4, i);
}

TEST(PointLight, InfiniteSamplesAreCountedAndDropped) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.5f)));
  b.pointLight({0.0f, 0.1f, 0.0f}, glm::vec3(1.0f), 3e38f);
  LitPoints lit(b);
  uint32_t dropped = 0;
  for (const auto& l : lit.relight(1).light()) {
    ASSERT_TRUE(std::isfinite(l.directFront.r));
    dropped += l.directFront.r == 0.0f;
  }
  EXPECT_GT(dropped, 10u);
  EXPECT_EQ(lit.discarded(), dropped);
}

TEST(PointLight, NoLightIsBlackAndCostsNoRay) {
  SceneBuilder b;
  addFloor(b, b.diffuse(glm::vec3(0.5f)));
  LitPoints lit(b);
  for (const auto& l : lit.relight(4).light()) EXPECT_EQ(l.directFront + l.directBack, kNone3);
  for (const glm::vec4& r : lit.compose().radiance()) EXPECT_EQ(r, glm::vec4(0.0f));
  EXPECT_EQ(lit.rays(), 0u);
}

}  // namespace
}  // namespace limn::test
