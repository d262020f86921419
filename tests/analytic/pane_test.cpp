// Light that reaches surfaces through what bends no light: light sampling finds it, and finds it once.
#include "tests/analytic/analytic.hpp"

namespace limn::test {
namespace {

constexpr double kAlbedo = 0.5, kPaneHeight = 0.7;
const glm::vec3 kTint(0.8f, 0.8f, 0.8f);

Material pane(float ior, float thickness) {
  Material m;
  m.metallic = 0;
  m.roughness = 0;
  m.transmission = 1;
  m.baseColor = {kTint, 1.0f};
  m.ior = ior;
  m.thickness = thickness;
  return m;
}
double passes(double cosine) { return kTint.g * (1 - fresnel(cosine, 1.5)); }

void addPane(SceneBuilder& b, float height) {
  b.quad(b.material(pane(1.5f, 0)), {-9, height, 9}, {9, height, 9}, {9, height, -9}, {-9, height, -9});
}

/// A grey floor whose origin is looked at from under the panes above it.
SceneBuilder underPanes(int count = 1) {
  SceneBuilder b;
  floorOf(b, b.diffuse(glm::vec3(float(kAlbedo))), 6);
  for (int i = 0; i < count; ++i) addPane(b, float(kPaneHeight) + 0.1f * float(i));
  lookParallel(b, {0.1, 0.5, 0.05}, {0, 0, 0}, 1e-3f);
  return b;
}

/// No light but what comes straight from the lights.
RenderOptions straight() {
  RenderOptions options;
  options.maxBounces = 0;
  options.samples = 256;
  return options;
}

TEST(Pane, ALampShinesThroughPanes) {
  for (const int count : {1, 3}) {
    const glm::dvec3 lamp(0.6, 1.5, 0.4);
    SceneBuilder b = underPanes(count);
    b.pointLight(glm::vec3(lamp), glm::vec3(1.0f), 7.0f);
    const double d = glm::length(lamp), cosine = lamp.y / d;
    const FilmImage image = render(b, straight());
    expectMean(image, kAlbedo / kPi * 7.0 * cosine / (d * d) * std::pow(passes(cosine), count), 2e-3);
    expectMean(image, kAlbedo / kPi * 7.0 * cosine / (d * d) * std::pow(passes(cosine), count), 2e-3, 0.0, "direct");
  }
}

/// Found by light sampling and by the surface's own rays, the two weighed by the whole distance.
TEST(Pane, ALargeLampShinesThroughAPane) {
  SceneBuilder b = underPanes();
  b.quad(b.emitter(glm::vec3(3.0f)), {-1, 1, 1}, {1, 1, 1}, {1, 1, -1}, {-1, 1, -1});
  const double irradiance = quadrature(600, [](double u, double v) {
    const double x = 2 * u - 1, z = 2 * v - 1, d2 = x * x + 1 + z * z, cosine = 1 / std::sqrt(d2);
    return 4 * 3.0 * cosine * cosine / d2 * passes(cosine);
  });
  expectMean(render(b, straight()), kAlbedo / kPi * irradiance, 5e-3);
}

TEST(Pane, TheSkyShinesThroughAPane) {
  SceneBuilder b;  // wider than underPanes(), for all of the sky is behind it
  floorOf(b, b.diffuse(glm::vec3(float(kAlbedo))), 0.1f);
  b.quad(b.material(pane(1.5f, 0)), {-99, 0.1f, 99}, {99, 0.1f, 99}, {99, 0.1f, -99}, {-99, 0.1f, -99});
  lookParallel(b, {0.01, 0.05, 0}, {0, 0, 0}, 1e-3f);
  b.scene.environment.radiance = glm::vec3(1.0f);
  const double mean = quadrature(1000, [](double u, double) { return passes(std::sqrt(u)); });  // over the cosine's square
  expectMean(render(b, straight()), kAlbedo * mean, 5e-3);
}

TEST(Pane, MediaDimWhatPassesThem) {
  constexpr double kSigma = 1.7, kThickness = 0.3;
  SceneBuilder b;
  floorOf(b, b.diffuse(glm::vec3(float(kAlbedo))), 6);
  Material fog = pane(1.0f, 1.0f);
  fog.baseColor = glm::vec4(1.0f);
  fog.roughness = 0.6f;  // where nothing bends, roughness does nothing
  fog.attenuationColor = glm::vec3(float(std::exp(-kSigma)));
  fog.attenuationDistance = 1.0f;
  b.box(b.material(fog), {-9, 1, -9}, {9, 1 + float(kThickness), 9});
  b.directionalLight({0.6f, -0.8f, 0}, glm::vec3(1.0f), 2.0f);
  lookParallel(b, {0.1, 0.5, 0.05}, {0, 0, 0}, 1e-3f);
  expectMean(render(b, straight()), kAlbedo / kPi * 2.0 * 0.8 * std::exp(-kSigma * kThickness / 0.8), 2e-3);
}

/// Its own rays and light sampling share the lamp, at the last bounce too.
TEST(Pane, ARoughMetalReflectsALampBehindAPane) {
  constexpr float kRoughness = 0.5f;
  const auto room = [](bool covered) {
    SceneBuilder b;
    floorOf(b, b.metal(glm::vec3(1.0f), kRoughness), 6);
    if (covered) b.quad(b.material(pane(1.0f, 0)), {-9, 0.7f, 9}, {9, 0.7f, 9}, {9, 0.7f, -9}, {-9, 0.7f, -9});
    b.quad(b.emitter(glm::vec3(covered ? 3.0f : 3.0f * kTint.g)), {-1, 1, 1}, {1, 1, 1}, {1, 1, -1}, {-1, 1, -1});
    lookParallel(b, {0.5, 0.5, 0.05}, {0, 0, 0}, 1e-3f);
    return b;
  };
  for (const uint32_t bounces : {0u, 1u, 4u}) {
    RenderOptions options = straight();
    options.maxBounces = bounces;
    expectMean(render(room(true), options), measure(render(room(false), options)).mean, 5e-3);
  }
}

TEST(Pane, APaneMayBePartOfASurface) {
  SceneBuilder b = underPanes(0);
  Material half = pane(1.0f, 0);
  half.transmission = 0.5f;
  b.quad(b.material(half), {-9, 1, 9}, {9, 1, 9}, {9, 1, -9}, {-9, 1, -9});
  b.pointLight({0, 2, 0}, glm::vec3(1.0f), 8.0f);
  expectMean(render(b, straight()), kAlbedo / kPi * 8.0 / 4.0 * 0.5 * kTint.g, 2e-3);
}

TEST(Pane, GlassThatBendsLightHidesALamp) {
  Material rough = pane(1.5f, 0), thick = pane(1.5f, 1);
  rough.roughness = 0.3f;
  for (const Material& material : {rough, thick}) {
    SceneBuilder b;
    floorOf(b, b.diffuse(glm::vec3(float(kAlbedo))), 6);
    b.quad(b.material(material), {-9, 1, 9}, {9, 1, 9}, {9, 1, -9}, {-9, 1, -9});
    b.pointLight({0, 2, 0}, glm::vec3(1.0f), 7.0f);
    lookParallel(b, {0.1, 0.5, 0.05}, {0, 0, 0}, 1e-3f);
    EXPECT_EQ(measure(render(b, straight())).mean, 0.0);
  }
}

/// Whatever is on the way: what is behind a pane is seen as light that was scattered once.
TEST(Pane, LayersTellOfTheFirstSurface) {
  SceneBuilder b;
  floorOf(b, b.diffuse(glm::vec3(float(kAlbedo))), 6);
  addPane(b, 1);
  b.pointLight({0, 0.5f, 0}, glm::vec3(1.0f), 1.0f);
  lookParallel(b, {0, 3, 0}, {0, 0, 0}, 1e-3f, {0, 0, 1});
  RenderOptions options = straight();
  options.samples = 1024;
  const FilmImage image = render(b, options);
  expectMean(image, passes(1) * kAlbedo / kPi / 0.25, 0.02, 0.0, "direct");
  EXPECT_NEAR(image.find("depth")->data[0], 2.0f, 1e-3f);
}

}  // namespace
}  // namespace limn::test
