#include "tests/analytic/analytic.hpp"

namespace limn::test {
namespace {

uint32_t glass(SceneBuilder& b, float ior, float thickness) {
  Material m;
  m.metallic = 0;
  m.roughness = 0;
  m.transmission = 1;
  m.ior = ior;
  m.thickness = thickness;
  return b.material(m);
}

TEST(Transmission, ClearShapesVanishInAFurnace) {
  for (int shape = 0; shape < 3; ++shape) {
    SCOPED_TRACE(shape);
    SceneBuilder b;
    b.scene.environment.radiance = glm::vec3(1.0f);
    if (shape == 0) b.box(glass(b, 1.5f, 1), {-1, -0.2f, -1}, {1, 0.2f, 1});
    if (shape == 1) b.sphere(glass(b, 1.5f, 1), {0, 0, 0}, 1, 32);
    if (shape == 2) floorOf(b, glass(b, 1.5f, 0), 3);  // thin-walled
    b.look({0, 2, 1.5}, {0, 0, 0}, 0.6f);
    expectMean(render(b), 1.0, 2e-3);
  }
}

/// Behind a single face that absorbs, the medium has no end: of a furnace nothing comes through, on no way of finding it.
TEST(Transmission, AnOpenMediumSwallowsTheSky) {
  for (const float roughness : {0.0f, 0.4f}) {
    SceneBuilder b;
    const uint32_t water = glass(b, 1.5f, 1);
    b.scene.materials[water].roughness = roughness;
    b.scene.materials[water].attenuationColor = glm::vec3(0.5f);
    b.scene.materials[water].attenuationDistance = 1.0f;
    b.scene.environment.radiance = glm::vec3(1.0f);
    floorOf(b, water, 3);
    lookParallel(b, {0, 1, 0}, {0, 0, 0}, 1e-3f);
    expectMean(render(b), fresnel(1.0, 1.5), 0.04, roughness > 0.0f ? 0.1 : 0.0);  // rough faces reflect by other angles too
  }
}

/// Fresnel's reflectance never passes 1, whatever colour an extension multiplies it by.
TEST(Transmission, StrongSpecularColourSendsBackNoMoreThanArrives) {
  SceneBuilder b;
  const uint32_t material = glass(b, 1.5f, 1);
  b.scene.materials[material].specularColor = glm::vec3(40.0f);
  b.scene.environment.radiance = glm::vec3(1.0f);
  b.box(material, {-1, -0.2f, -1}, {1, 0.2f, 1});
  b.look({0, 2, 1.5}, {0, 0, 0}, 0.6f);
  expectMean(render(b), 1.0, 2e-3);
}

/// Straight through a slab; reflections go to and fro between its faces. [Beer-Lambert, Fresnel at normal incidence]
TEST(Transmission, SlabAbsorbsByItsThickness) {
  for (const float ior : {1.0f, 1.5f}) {
    constexpr double kThickness = 0.8, kSigma = 1.3;
    SceneBuilder b;
    const uint32_t material = glass(b, ior, 1);
    b.scene.materials[material].attenuationColor = glm::vec3(float(std::exp(-kSigma * 0.5)));
    b.scene.materials[material].attenuationDistance = 0.5f;
    b.scene.environment.radiance = glm::vec3(1.0f);
    b.box(material, {-5, 0, -5}, {5, float(kThickness), 5});
    lookParallel(b, {0, 3, 0}, {0, 0, 0}, 0.1f, {0, 0, 1});
    const double r = std::pow((ior - 1.0) / (ior + 1.0), 2), t = 1 - r, a = std::exp(-kSigma * kThickness);
    RenderOptions options;
    options.samples = 512;
    expectMean(render(b, options), r + t * t * a / (1 - r * a), 5e-3);
  }
}

/// The lamp is in the glass with the eye's ray: what light sampling finds is dimmed like what the path finds.
TEST(Transmission, LampInsideAnAbsorbingBody) {
  constexpr double kSigma = 2.0, kAlbedo = 0.5, kHeight = 0.6;
  SceneBuilder b;
  const uint32_t body = glass(b, 1.0f, 1);
  b.scene.materials[body].attenuationColor = glm::vec3(float(std::exp(-kSigma)));
  b.scene.materials[body].attenuationDistance = 1.0f;
  b.box(body, {-5, -1, -5}, {5, 2, 5});
  floorOf(b, b.diffuse(glm::vec3(float(kAlbedo))), 4);
  b.pointLight({0, float(kHeight), 0}, glm::vec3(1.0f), 3.0f);
  lookParallel(b, {0.02, 4, 0}, {0.0, 0, 0}, 1e-3f, {0, 0, 1});
  const double path = 2.0 * std::sqrt(1 + 0.005 * 0.005);  // from the body's face down to the floor
  expectMean(render(b), kAlbedo / kPi * 3.0 / (kHeight * kHeight) * std::exp(-kSigma * (kHeight + path)), 5e-3);
}

TEST(Alpha, BlendMixesWithWhatIsBehind) {
  for (const float alpha : {0.0f, 0.25f, 0.5f, 1.0f}) {
    SceneBuilder b;
    Material veil;
    veil.unlit = true;
    veil.baseColor = {2.0f, 2.0f, 2.0f, alpha};
    veil.alphaMode = AlphaMode::blend;
    floorOf(b, b.material(veil), 2);
    b.quad(b.emitter(glm::vec3(5.0f)), {-9, -1, 9}, {9, -1, 9}, {9, -1, -9}, {-9, -1, -9});
    lookParallel(b, {0, 1, 0}, {0, 0, 0}, 0.5f, {0, 0, 1});
    expectMean(render(b), alpha * 2.0 + (1 - alpha) * 5.0, 0.01);
  }
}

TEST(Alpha, BlendLetsItsShareOfLightPass) {
  SceneBuilder b;
  floorOf(b, b.diffuse(glm::vec3(0.6f)), 3);
  const uint32_t veil = b.diffuse(glm::vec3(0.0f));
  b.scene.materials[veil].alphaMode = AlphaMode::blend;
  b.scene.materials[veil].baseColor.a = 0.3f;
  b.quad(veil, {-3, 0.5f, 3}, {3, 0.5f, 3}, {3, 0.5f, -3}, {-3, 0.5f, -3});
  b.pointLight({0, 1, 0}, glm::vec3(1.0f), 2.0f);
  lookParallel(b, {0.5, 0.2, 0}, {0, 0, 0}, 1e-3f);
  expectMean(render(b), 0.7 * 0.6 / kPi * 2.0, 0.01);
}

TEST(Alpha, MaskIsThereOrNot) {
  for (const float alpha : {0.39f, 0.41f}) {
    SceneBuilder b;
    Material veil;
    veil.unlit = true;
    veil.baseColor = {2.0f, 2.0f, 2.0f, alpha};
    veil.alphaMode = AlphaMode::mask;
    veil.alphaCutoff = 0.4f;
    floorOf(b, b.material(veil), 2);
    b.quad(b.emitter(glm::vec3(5.0f)), {-9, -1, 9}, {9, -1, 9}, {9, -1, -9}, {-9, -1, -9});
    lookParallel(b, {0, 1, 0}, {0, 0, 0}, 0.5f, {0, 0, 1});
    expectMean(render(b), alpha < 0.4f ? 5.0 : 2.0, 1e-4);
  }
}

TEST(Unlit, ShowsItsColourInAnyLight) {
  SceneBuilder b;
  Material m;
  m.unlit = true;
  m.baseColor = {0.3f, 0.3f, 0.3f, 1.0f};
  floorOf(b, b.material(m), 5);
  b.scene.environment.radiance = glm::vec3(4.0f);
  b.pointLight({0, 1, 0}, glm::vec3(1.0f), 50.0f);
  b.look({0, 2, 1}, {0, 0, 0}, 0.5f);
  expectMean(render(b), 0.3, 1e-4);
}

/// Small steps in space and far from the origin leave the furnace white.
TEST(Scale, ClosedBoxShinesAlikeAtAnySizeAndPlace) {
  for (const double scale : {1e-3, 1.0, 1e4})
    for (const double away : {0.0, 1e3}) {
      SCOPED_TRACE("scale " + std::to_string(scale) + ", " + std::to_string(away) + " sizes away");
      SceneBuilder b;
      const uint32_t walls = b.diffuse(glm::vec3(0.5f));
      b.scene.materials[walls].emission = glm::vec3(1.0f);
      const uint32_t node = b.box(walls, {-1, -1, -1}, {1, 1, 1});
      const glm::dvec3 place = scale * away * glm::dvec3(1, 0.3, -0.7);
      b.scene.nodes[node].parentFromLocal.translation = place;
      b.scene.nodes[node].parentFromLocal.scale = glm::dvec3(scale);
      b.look(place + scale * glm::dvec3(0.3, 0.2, 0.8), place + scale * glm::dvec3(0, 0, -1), 1.3f);
      b.scene.view.lens.znear = float(1e-4 * scale);
      expectMean(render(b), 2.0, 5e-3);
    }
}

}  // namespace
}  // namespace limn::test
