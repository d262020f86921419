// What lies on a surface beside its base: a coat, a normal map, colours of vertices.
#include "tests/analytic/analytic.hpp"

namespace limn::test {
namespace {

/// Fresnel reflectance of a coat of index 1.5 as glTF has it. [Schlick 1994]
double coatFresnel(double cosine) { return 0.04 + 0.96 * std::pow(1 - cosine, 5); }

/// A smooth coat mirrors the white sky, and what it mirrors does not reach the base.
/// [KHR_materials_clearcoat: mix(base, coat, clearcoat · fresnel)]
TEST(Clearcoat, ASmoothCoatMirrorsItsShareAndDimsTheBase) {
  for (const double strength : {0.0, 0.5, 1.0})
    for (const double cosine : {1.0, 0.5}) {
      SCOPED_TRACE("coat " + std::to_string(strength) + " at cosine " + std::to_string(cosine));
      constexpr double kAlbedo = 0.6;
      SceneBuilder b;
      const uint32_t material = b.diffuse(glm::vec3(float(kAlbedo)));
      b.scene.materials[material].clearcoat = float(strength);
      b.scene.materials[material].clearcoatRoughness = 0.0f;
      b.scene.environment.radiance = glm::vec3(1.0f);
      floorOf(b, material, 5);
      lookParallel(b, {2 * std::sqrt(1 - cosine * cosine), 2 * cosine, 0}, {0, 0, 0}, 1e-3f, {0, 0, 1});
      const double share = strength * coatFresnel(cosine);
      RenderOptions options;
      options.samples = 256;
      expectMean(render(b, options), share + (1 - share) * kAlbedo, 5e-3);
    }
}

/// A point light is no mirror image's: of a smooth coat only the dimming of the base is left.
TEST(Clearcoat, UnderAPointLightTheBaseIsDimmed) {
  constexpr double kAlbedo = 0.6, kHeight = 1.5, kIntensity = 4.0;
  SceneBuilder b;
  const uint32_t material = b.diffuse(glm::vec3(float(kAlbedo)));
  b.scene.materials[material].clearcoat = 1.0f;
  b.scene.materials[material].clearcoatRoughness = 0.0f;
  floorOf(b, material, 5);
  b.pointLight({0, float(kHeight), 0}, glm::vec3(1.0f), float(kIntensity));
  lookParallel(b, {2 * std::sin(1.0), 2 * std::cos(1.0), 0}, {0, 0, 0}, 1e-3f, {0, 0, 1});
  expectMean(render(b), (1 - coatFresnel(std::cos(1.0))) * kAlbedo / kPi * kIntensity / (kHeight * kHeight), 5e-3);
}

/// A floor of 4 m whose texture coordinates go from 0 to 1, with tangents along +x.
Primitive mappedFloor(uint32_t material) {
  Primitive p;
  p.material = int32_t(material);
  p.positions = {{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}};
  p.normals.assign(4, {0, 1, 0});
  p.tangents.assign(4, {1, 0, 0, 1});
  p.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  p.indices = {0, 1, 2, 0, 2, 3};
  return p;
}

/// Lambert's cosine is that of the mapped normal, which leans to +x as its scale says.
TEST(NormalMap, TiltsTheCosineOfADirectionalLight) {
  for (const float scale : {1.0f, 0.5f, -1.0f})
    for (const double lean : {-0.5, 0.0, 0.5}) {
      SCOPED_TRACE("scale " + std::to_string(scale) + ", light from " + std::to_string(lean));
      constexpr double kAlbedo = 0.5, kIrradiance = 2.0;
      SceneBuilder b;
      Image map;
      map.name = "lean";
      map.width = map.height = 1;
      map.rgba8 = {204, 128, 230, 255};  // (0.6, 0.004, 0.804)
      b.scene.images = {map};
      const uint32_t material = b.diffuse(glm::vec3(float(kAlbedo)));
      b.scene.materials[material].normalTexture.image = 0;
      b.scene.materials[material].normalScale = scale;
      b.mesh(mappedFloor(material));
      const glm::dvec3 toLight = glm::normalize(glm::dvec3(lean, 1, 0));
      b.directionalLight(-glm::vec3(toLight), glm::vec3(1.0f), float(kIrradiance));
      lookParallel(b, {0, 2, 0}, {0, 0, 0}, 0.5f, {0, 0, 1});
      const auto decoded = [](int texel) { return texel / 255.0 * 2 - 1; };
      // Tangent +x, bitangent cross(normal, tangent) = -z, normal +y.
      const glm::dvec3 n = glm::normalize(glm::dvec3(scale * decoded(204), decoded(230), -scale * decoded(128)));
      expectMean(render(b), kAlbedo / kPi * kIrradiance * std::max(0.0, glm::dot(n, toLight)), 5e-3);
    }
}

/// Colours multiply the base, linear across the triangle: the mean over the square is the mean of the corners'.
TEST(VertexColours, MultiplyTheBaseAndAreLinearAcrossTheTriangle) {
  constexpr double kAlbedo = 0.8, kIrradiance = 3.0;
  SceneBuilder b;
  const uint32_t material = b.diffuse(glm::vec3(float(kAlbedo)));
  Primitive floor = mappedFloor(material);
  floor.colors = {{0.1f, 0.5f, 1, 1}, {0.3f, 0.5f, 1, 1}, {0.9f, 0.5f, 1, 1}, {0.7f, 0.5f, 1, 1}};
  b.mesh(floor);
  b.directionalLight({0, -1, 0}, glm::vec3(1.0f), float(kIrradiance));
  const auto seenAt = [&](double x, double z, float half) {
    lookParallel(b, {x, 2, z}, {x, 0, z}, half, {0, 0, -1});
    return render(b);
  };
  const double white = kAlbedo / kPi * kIrradiance;
  // red(x, z) = 0.5 + 0.05·x − 0.15·z from the corners above.
  using Place = glm::dvec2;
  for (const Place place : {Place(-1.5, -1.2), Place(0, 0), Place(1.2, 0.4), Place(-0.6, 1.7)}) {
    SCOPED_TRACE(std::to_string(place.x) + ", " + std::to_string(place.y));
    const FilmImage image = seenAt(place.x, place.y, 1e-3f);
    const glm::dvec3 color(0.5 + 0.05 * place.x - 0.15 * place.y, 0.5, 1.0);
    const auto& beauty = image.find("beauty")->data;
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(beauty[k], white * color[int(k)], 2e-3 * white) << "channel " << k;
  }
  const glm::dvec3 mean(0.5, 0.5, 1.0);
  expectMean(seenAt(0, 0, 1.9f), white * (0.2126 * mean.r + 0.7152 * mean.g + 0.0722 * mean.b), 5e-3);
}

}  // namespace
}  // namespace limn::test
