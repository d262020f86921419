#include <algorithm>

#include "shaders/shared/gather_shared.h"
#include "shaders/shared/relight_shared.h"
#include "tests/gpu/point_light_fixture.hpp"

namespace limn::test {
namespace {

glm::vec3 unpackRgbe(uint32_t p) {
  return glm::vec3(p & 255u, (p >> 8) & 255u, (p >> 16) & 255u) * std::exp2(float(p >> 24) - 127.0f - 8.0f);
}
glm::vec3 octDecode(uint32_t packed) {
  const glm::vec2 e = glm::unpackSnorm2x16(packed);
  glm::vec3 v(e.x, e.y, 1.0f - std::abs(e.x) - std::abs(e.y));
  if (v.z < 0.0f) {
    const glm::vec2 folded = 1.0f - glm::abs(glm::vec2(v.y, v.x));
    v.x = v.x >= 0.0f ? folded.x : -folded.x;
    v.y = v.y >= 0.0f ? folded.y : -folded.y;
  }
  return glm::normalize(v);
}

SceneBuilder floorOf(const Material& material) {
  SceneBuilder b;
  addFloor(b, b.material(material));
  return b;
}
Material lambert(const glm::vec3& albedo) {
  Material m;
  m.baseColor = glm::vec4(albedo, 1.0f);
  m.metallic = m.specular = 0.0f;
  return m;
}

/// Radiance of the two sides of a point of `material` when this light arrives everywhere.
std::pair<glm::vec4, glm::vec4> composed(const Material& material, const shared::PointLight& light) {
  LitPoints lit(floorOf(material));
  lit.relight(1);  // lobes know whether they are there
  lit.write(std::vector<shared::PointLight>(SquarePoints::count(), light));
  const auto radiance = lit.compose().radiance();
  for (size_t i = 2; i < radiance.size(); ++i) EXPECT_EQ(radiance[i], radiance[i & 1]);
  return {radiance[0], radiance[1]};
}

constexpr shared::PointLight kArriving{{1, 2, 4}, {0.5f, 0.25f, 0}, {3, 0, 1}, {0, 0.75f, 2}};
const glm::vec3 kFront = kArriving.directFront + kArriving.indirectFront;
const glm::vec3 kBack = kArriving.directBack + kArriving.indirectBack;

void expectNear(const glm::vec4& measured, const glm::vec3& expected, float w, float tolerance = 1e-5f) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(measured[k], expected[k], tolerance);
  EXPECT_EQ(measured.w, w);
}

TEST(PointRadiance, DiffuseAlbedoTimesAllThatArrives) {
  const glm::vec3 albedo(0.5f, 0.4f, 0.3f);
  const auto [front, back] = composed(lambert(albedo), kArriving);
  expectNear(front, albedo * kFront, 0.0f);
  expectNear(back, albedo * kBack, 0.0f);
}

/// Mean over the cosine-weighted hemisphere of what GGX of `alpha` reflects of light from everywhere.
float meanAlbedo(double alpha, double f0) {
  const auto at = [&](double cosine) { return Ggx{alpha}.albedo(cosine, [&](double c) { return schlick(c, f0); }, 100); };
  return float(quadrature(16, [&](double u, double) { return at(std::sqrt(u)); }));
}

TEST(PointRadiance, PlainDielectricsLoseNoEnergyToTheirSpecularLayer) {
  Material m = lambert(glm::vec3(0.5f));
  m.specular = 1.0f;
  m.roughness = 0.3f;
  const auto [front, back] = composed(m, kArriving);
  const float specular = meanAlbedo(0.09, 0.04);
  const float forFits = 0.004f;  // what bsdf.glsl keeps back, so that errors of its fits add no light
  expectNear(front, (0.5f * (1.0f - specular - forFits) + specular) * kFront, 0.0f, 2e-3f);
}

TEST(PointRadiance, GlassReflectsFresnelsMean) {
  for (const float ior : {1.0f, 1.02f, 1.1f, 1.33f, 1.5f, 1.8f}) {
    Material m = lambert(glm::vec3(0.0f));
    m.transmission = m.specular = m.thickness = 1.0f;
    m.roughness = 0.0f;
    m.ior = ior;
    const double mean = quadrature(1000, [&](double u, double) { return fresnel(std::sqrt(u), ior); });
    expectNear(composed(m, kArriving).first, kFront * float(mean), 0.0f, 0.002f * kFront.b);
  }
}

TEST(PointRadiance, UnlitSurfacesShowTheirColour) {
  Material m = lambert({0.2f, 0.9f, 0.4f});
  m.unlit = true;
  const auto [front, back] = composed(m, kArriving);
  expectNear(front, {0.2f, 0.9f, 0.4f}, 0.0f);
  expectNear(back, {0.2f, 0.9f, 0.4f}, 0.0f);
}

TEST(PointRadiance, MetalsKeepDirectLightForTheirLobes) {
  Material m;
  m.baseColor = {0.9f, 0.6f, 0.3f, 1.0f};
  m.roughness = 0.6f;
  const auto [front, back] = composed(m, kArriving);
  const glm::vec3 mean(meanAlbedo(0.36, 0.9), meanAlbedo(0.36, 0.6), meanAlbedo(0.36, 0.3));
  expectNear(front, mean * kArriving.indirectFront, 1.0f, 0.01f);
  expectNear(back, mean * kArriving.indirectBack, 1.0f, 0.01f);
}

TEST(PointRadiance, WhatPassesThroughLeavesOnTheOtherSide) {
  Material m = lambert({0.5f, 0.4f, 0.3f});
  m.transmission = 0.75f;
  const auto [front, back] = composed(m, kArriving);
  expectNear(front, glm::vec3(m.baseColor) * (0.25f * kFront + 0.75f * kBack), 0.0f);
  expectNear(back, glm::vec3(m.baseColor) * (0.25f * kBack + 0.75f * kFront), 0.0f);
}

/// The points behind have it already, by shadow rays.
TEST(PointRadiance, DirectLightThatPassesAPaneIsNotSentOnAgain) {
  for (const float roughness : {0.0f, 0.5f}) {
    Material m = lambert({0.5f, 0.4f, 0.3f});
    m.transmission = 0.75f;
    m.roughness = roughness;
    const glm::vec3 through = roughness == 0.0f ? kArriving.indirectBack : kBack;
    expectNear(composed(m, kArriving).first, glm::vec3(m.baseColor) * (0.25f * kFront + 0.75f * through), 0.0f);
  }
}

TEST(PointRadiance, NoMaterialSendsOutMoreThanArrives) {
  const shared::PointLight furnace{glm::vec3(0.5f), glm::vec3(0.5f), glm::vec3(0.5f), glm::vec3(0.5f)};
  for (const float roughness : {0.0f, 0.2f, 0.5f, 1.0f})
    for (const float transmission : {0.0f, 0.5f, 1.0f})
      for (const float clearcoat : {0.0f, 1.0f}) {
        Material m;
        m.metallic = 0.0f;
        m.roughness = roughness;
        m.transmission = transmission;
        m.clearcoat = clearcoat;
        m.thickness = 1.0f;  // no pane
        const glm::vec4 out = composed(m, furnace).first;
        EXPECT_LT(out.r, 1.06f) << roughness << " " << transmission << " " << clearcoat;
        EXPECT_GT(out.r, 0.9f) << roughness << " " << transmission << " " << clearcoat;
      }
}

SceneBuilder metalFloor(float roughness) {
  SceneBuilder b;
  addFloor(b, b.metal({0.9f, 0.6f, 0.3f}, roughness));
  return b;
}

TEST(PointLobes, PunctualLightsOwnALobeEach) {
  SceneBuilder b = metalFloor(0.6f);
  const glm::dvec3 source(0.3, 1.5, -0.2);
  b.pointLight(source, {1.0f, 0.5f, 0.25f}, 5.0f);
  b.directionalLight({0.0f, 1.0f, 0.0f}, glm::vec3(1.0f), 2.0f);
  b.quad(b.diffuse(glm::vec3(0.0f)), {0.0f, 0.5f, 5.0f}, {9.0f, 0.5f, 5.0f}, {9.0f, 0.5f, -5.0f}, {0.0f, 0.5f, -5.0f});
  const auto lobes = LitPoints(b).relight(1).relight(1, 1).lobes();
  const SquarePoints floor = floorPoints();
  uint32_t lit = 0;
  for (uint32_t i = 0; i < lobes.size(); ++i) {
    EXPECT_NEAR(lobes[i].alpha, 0.36f, 1e-5f);
    EXPECT_NEAR(unpackRgbe(lobes[i].reflectance).r, 0.9f, 0.004f);
    const glm::dvec3 p = floor.position(i), way = glm::normalize(source - p);
    const glm::vec3 irradiance = unpackRgbe(lobes[i].lobe[0].irradiance);
    const bool shadowed = p.x + way.x * (0.5 / way.y) > 0.0;
    const double expected = shadowed ? 0.0 : kPi * pointLightOn(p, floor.normal(), source, 5.0);
    EXPECT_NEAR(irradiance.r, expected, expected / 256) << i;
    EXPECT_NEAR(irradiance.g, 0.5 * expected, expected / 256) << i;
    if (!shadowed) {
      EXPECT_GT(glm::dot(octDecode(lobes[i].lobe[0].dirToLight), glm::vec3(way)), 1.0f - 1e-6f);
      ++lit;
    }
    EXPECT_NEAR(unpackRgbe(lobes[i].lobe[1].irradiance).g, 2.0, 0.01);
    EXPECT_LT(octDecode(lobes[i].lobe[1].dirToLight).y, -0.99999f);
    for (const uint32_t k : {2u, 3u}) EXPECT_EQ(lobes[i].lobe[k].irradiance, 0u);
  }
  EXPECT_GT(lit, 20u);
  EXPECT_LT(lit, 230u);
}

double lobeSum(const std::vector<shared::PointLobes>& lobes, uint32_t first, uint32_t end) {
  double sum = 0.0;
  for (const auto& l : lobes)
    for (uint32_t k = first; k < end; ++k) sum += unpackRgbe(l.lobe[k].irradiance).g;
  return sum / double(lobes.size());
}

/// Mean over points and passes of what the lobes carry, and of the irradiance that they should.
struct LobeEnergy {
  double lobes = 0.0, irradiance = 0.0;
};
LobeEnergy lobeEnergy(const SceneBuilder& b, uint32_t samples) {
  LitPoints lit(b);
  LobeEnergy e;
  const uint32_t passes = 32;
  for (uint32_t i = 0; i < passes; ++i) e.lobes += lobeSum(lit.relight(samples, i * samples).lobes(), 0, 4) / passes;
  const auto light = lit.light();
  for (const auto& l : light) e.irradiance += kPi * (l.directFront.g + l.directBack.g) / double(light.size());
  return e;
}

TEST(PointLobes, LampsFillTheLobesThatAreLeft) {
  SceneBuilder b = metalFloor(0.5f);
  b.quad(b.emitter({4.0f, 2.0f, 1.0f}), {-0.4f, 0.8f, -0.4f}, {0.4f, 0.8f, -0.4f}, {0.4f, 0.8f, 0.4f},
         {-0.4f, 0.8f, 0.4f});
  b.scene.environment.radiance = glm::vec3(0.3f);
  b.pointLight({0.6f, 0.7f, 0.1f}, glm::vec3(1.0f), 1.0f);
  for (const uint32_t samples : {1u, 2u, 8u}) {
    const LobeEnergy e = lobeEnergy(b, samples);
    EXPECT_NEAR(e.lobes, e.irradiance, 0.02 * e.irradiance) << samples;
  }
}

TEST(PointLobes, ManyLightsShareTheLastLobe) {
  SceneBuilder b = metalFloor(0.5f);
  for (int i = 0; i < 7; ++i) b.pointLight({0.2f * float(i) - 0.6f, 1.0f, 0.0f}, glm::vec3(1.0f), 0.2f + float(i % 3));
  const LobeEnergy e = lobeEnergy(b, 2);
  EXPECT_NEAR(e.lobes, e.irradiance, 0.02 * e.irradiance);
}

TEST(PointLobes, NarrowLobesAreWidenedToTheLimitOfSplats) {
  SceneBuilder b = metalFloor(0.05f);
  b.pointLight({0.3f, 1.5f, -0.2f}, glm::vec3(1.0f), 5.0f);
  for (const auto& l : LitPoints(b).relight(1).lobes()) EXPECT_EQ(l.alpha, shared::kSplatAlpha);
}

/// The floor of a metal whose normal map tilts everything towards +x, its sines and cosines being 0.6 and 0.8.
TEST(PointLobes, KeepTheNormalThatTheMapGives) {
  SceneBuilder b = metalFloor(0.5f);
  b.pointLight({0.3f, 1.5f, -0.2f}, glm::vec3(1.0f), 5.0f);
  for (const auto& l : LitPoints(b).relight(1).lobes())
    EXPECT_GT(glm::dot(octDecode(l.normal), glm::vec3(0, 1, 0)), 1.0f - 1e-6f);

  Image map;
  map.width = map.height = 1;
  map.rgba8 = {204, 128, 230, 255};
  b.scene.images = {map};
  b.scene.materials[0].normalTexture.image = 0;
  Primitive& floor = b.scene.meshes[0].primitives[0];
  floor.uv0.assign(floor.positions.size(), glm::vec2(0.5f));
  floor.tangents.assign(floor.positions.size(), glm::vec4(1, 0, 0, 1));
  for (const auto& l : LitPoints(b).relight(1).lobes())
    EXPECT_GT(glm::dot(octDecode(l.normal), glm::vec3(0.6f, 0.8f, 0.0f)), 0.9999f);
}

TEST(PointLobes, AreLeftOutWhereNothingIsGlossy) {
  SceneBuilder b = floorOf(lambert(glm::vec3(0.5f)));
  EXPECT_FALSE(hasGlossySources(b.scene));
  b.scene.materials[0].specular = 1.0f;
  EXPECT_FALSE(hasGlossySources(b.scene));  // glTF's plain dielectric reflects 0.04
  const LitPoints lit(b);
  EXPECT_FALSE(lit.cache().hasLobes());
  EXPECT_EQ(lit.cache().lobes().size(), sizeof(shared::PointLobes));

  b.scene.materials[0].ior = 2.4f;
  EXPECT_TRUE(hasGlossySources(b.scene));
  b.scene.materials[0].unlit = true;
  EXPECT_FALSE(hasGlossySources(b.scene));
  b.scene.materials[0] = Material{};
  EXPECT_TRUE(hasGlossySources(b.scene));
}

TEST(PointLobes, PointsThatAreNotGlossyHaveNone) {
  SceneBuilder b = floorOf(lambert(glm::vec3(0.5f)));
  b.box(b.metal(glm::vec3(0.9f), 0.5f), {2, 0, 2}, {3, 1, 3});
  b.pointLight({0.3f, 1.5f, -0.2f}, glm::vec3(1.0f), 5.0f);
  LitPoints lit(b);
  EXPECT_TRUE(lit.cache().hasLobes());
  for (const auto& l : lit.relight(1).lobes()) EXPECT_EQ(l.alpha, 0.0f);
  for (const glm::vec4& r : lit.compose().radiance()) EXPECT_EQ(r.w, 0.0f);
}

}  // namespace
}  // namespace limn::test
