#include "tests/analytic/analytic.hpp"

namespace limn::test {
namespace {

constexpr double kAlbedo = 0.6;
const glm::dvec3 kUp(0, 1, 0);

/// A grey floor whose origin alone is looked at, from the side.
SceneBuilder floorAtOrigin() {
  SceneBuilder b;
  floorOf(b, b.diffuse(glm::vec3(float(kAlbedo))), 5);
  lookParallel(b, {0.3, 1.0, 0.9}, {0, 0, 0}, 1e-3f);
  return b;
}

/// A rectangle of four corners as the scene and as Lambert's formula see it.
void shine(SceneBuilder& b, uint32_t material, const std::vector<glm::dvec3>& c) {
  b.quad(material, glm::vec3(c[0]), glm::vec3(c[1]), glm::vec3(c[2]), glm::vec3(c[3]));
}

TEST(PunctualLight, PointLightFallsWithTheSquare) {
  for (const glm::dvec3 at : {glm::dvec3(0, 1, 0), glm::dvec3(1.5, 0.4, -1), glm::dvec3(-30, 200, 10)}) {
    SceneBuilder b = floorAtOrigin();
    b.pointLight(glm::vec3(at), glm::vec3(1.0f), 5.0f);
    const double d = glm::length(at);
    expectMean(render(b), kAlbedo / kPi * 5.0 * at.y / (d * d * d), 2e-3);
  }
}

TEST(PunctualLight, RangeCutsSmoothly) {
  for (const double d : {0.5, 1.5, 2.5}) {
    SceneBuilder b = floorAtOrigin();
    b.pointLight({0, float(d), 0}, glm::vec3(1.0f), 5.0f);
    b.scene.lights.back().range = 2.0f;
    const double window = std::clamp(1 - std::pow(d / 2.0, 4), 0.0, 1.0);
    expectMean(render(b), kAlbedo / kPi * 5.0 / (d * d) * window, 2e-3);
  }
}

TEST(PunctualLight, SpotRampIsTheExtensionsOwn) {
  const double inner = 0.3, outer = 0.7;
  for (const double angle : {0.0, 0.25, 0.4, 0.55, 0.68, 0.75}) {
    SceneBuilder b = floorAtOrigin();
    // Straight above the origin, turned away from it by the angle.
    b.spotLight({0, 2, 0}, {float(std::sin(angle)), float(-std::cos(angle)), 0}, 7.0f, float(inner), float(outer));
    const double ramp = std::clamp((std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer)), 0.0, 1.0);
    SCOPED_TRACE(angle);
    expectMean(render(b), kAlbedo / kPi * 7.0 / 4.0 * ramp * ramp, 3e-3);
  }
}

TEST(PunctualLight, DirectionalLightGivesItsIrradiance) {
  for (const glm::dvec3 way : {glm::dvec3(0, -1, 0), glm::dvec3(0.6, -0.3, 0.2), glm::dvec3(-1, -0.05, 0)}) {
    SceneBuilder b = floorAtOrigin();
    b.directionalLight(glm::vec3(way), glm::vec3(1.0f), 2.0f);
    expectMean(render(b), kAlbedo / kPi * 2.0 * -glm::normalize(way).y, 2e-3);
  }
}

TEST(PunctualLight, ManyLightsAddUp) {
  SceneBuilder b = floorAtOrigin();
  double expected = 0.0;
  for (int i = 0; i < 40; ++i) {
    const glm::dvec3 at(0.1 * i - 2, 1 + 0.05 * i, 0.03 * i);
    const double intensity = 0.1 + i % 7;
    b.pointLight(glm::vec3(at), glm::vec3(1.0f), float(intensity));
    expected += kAlbedo / kPi * intensity * at.y / std::pow(glm::length(at), 3);
  }
  RenderOptions options;
  options.samples = 256;
  expectMean(render(b, options), expected, 5e-3);
}

struct AreaCase {
  const char* name;
  std::vector<glm::dvec3> corners;  ///< all above the floor
};

TEST(AreaLight, QuadHasThePolygonsFormFactor) {
  const std::vector<AreaCase> cases{{"Above", {{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}}},
                                    {"Near", {{-1, 0.05, -1}, {1, 0.05, -1}, {1, 0.05, 1}, {-1, 0.05, 1}}},
                                    {"Far", {{20, 30, -1}, {22, 30, -1}, {22, 31, 1}, {20, 31, 1}}},
                                    {"Upright", {{-1, 0, -0.7}, {1, 0, -0.7}, {1, 1, -0.7}, {-1, 1, -0.7}}},
                                    {"Needle", {{-3, 0.5, -0.6}, {3, 0.5, -0.6}, {3, 0.505, -0.6}, {-3, 0.505, -0.6}}}};
  for (const AreaCase& c : cases) {
    SCOPED_TRACE(c.name);
    SceneBuilder b = floorAtOrigin();
    // Seen from far above, past or through no emitter.
    lookParallel(b, {0.0, 0.02, 1.0}, {0, 0, 0}, 1e-4f);
    shine(b, b.emitter(glm::vec3(3.0f)), c.corners);
    RenderOptions options;
    options.samples = 256;
    expectMean(render(b, options), kAlbedo / kPi * 3.0 * polygonIrradiance({0, 0, 0}, kUp, c.corners), 0.01);
  }
}

TEST(AreaLight, BothFacesShine) {
  const std::vector<glm::dvec3> corners{{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}};
  const std::vector<glm::dvec3> turned(corners.rbegin(), corners.rend());
  for (const auto& c : {corners, turned}) {
    SceneBuilder b = floorAtOrigin();
    shine(b, b.emitter(glm::vec3(3.0f)), c);
    expectMean(render(b), kAlbedo / kPi * 3.0 * polygonIrradiance({0, 0, 0}, kUp, corners), 5e-3);
  }
}

TEST(AreaLight, ShinesByItsAlpha) {
  const std::vector<glm::dvec3> corners{{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}};
  const double whole = kAlbedo / kPi * 3.0 * polygonIrradiance({0, 0, 0}, kUp, corners);
  const auto lit = [&](AlphaMode mode) {
    SceneBuilder b = floorAtOrigin();
    const uint32_t lamp = b.emitter(glm::vec3(3.0f));
    b.scene.materials[lamp].alphaMode = mode;
    b.scene.materials[lamp].baseColor.a = 0.3f;
    shine(b, lamp, corners);
    RenderOptions options;
    options.samples = 256;
    return render(b, options);
  };
  expectMean(lit(AlphaMode::blend), 0.3 * whole, 0.01);
  expectMean(lit(AlphaMode::opaque), whole, 5e-3);
  EXPECT_EQ(measure(lit(AlphaMode::mask)).mean, 0.0) << "cut out where alpha is under the cutoff";
}

/// (emission + the layers' light) x what the coat leaves, wherever it is seen from. [KHR_materials_clearcoat]
TEST(AreaLight, ShinesThroughItsCoat) {
  constexpr double kCoat = 0.8;
  const auto through = [](double cosine) { return 1.0 - kCoat * (0.04 + 0.96 * std::pow(1.0 - cosine, 5)); };
  const auto coated = [](SceneBuilder& b) {
    const uint32_t lamp = b.emitter(glm::vec3(3.0f));
    b.scene.materials[lamp].clearcoat = float(kCoat);
    return lamp;
  };
  for (const double angle : {0.2, 1.2}) {
    SceneBuilder b;
    floorOf(b, coated(b), 5);
    lookParallel(b, {std::sin(angle), std::cos(angle), 0}, {0, 0, 0}, 1e-3f);
    expectMean(render(b), 3.0 * through(std::cos(angle)), 1e-4);
  }
  SceneBuilder b = floorAtOrigin();
  lookParallel(b, {0.0, 0.02, 1.0}, {0, 0, 0}, 1e-4f);
  const double half = 1.0, height = 0.3;
  shine(b, coated(b), {{-half, height, -half}, {half, height, -half}, {half, height, half}, {-half, height, half}});
  const double irradiance = quadrature(400, [&](double u, double v) {
    const double x = half * (2 * u - 1), z = half * (2 * v - 1), d2 = x * x + z * z + height * height;
    const double cosine = height / std::sqrt(d2);
    return 4 * half * half * cosine * cosine / d2 * 3.0 * through(cosine);
  });
  RenderOptions options;
  options.samples = 256;
  options.maxBounces = 0;  // the coat mirrors the floor, too
  expectMean(render(b, options), kAlbedo / kPi * irradiance, 0.01);
}

/// Light sampling wins on the rough plate, BSDF sampling on the shiny one; together they must not count light twice.
TEST(AreaLight, GlossyPlateSeesIt) {
  for (const double distance : {0.3, 5.0})
    for (const double roughness : {0.15, 0.4, 1.0}) {
      SCOPED_TRACE("distance " + std::to_string(distance) + ", roughness " + std::to_string(roughness));
      SceneBuilder b;
      floorOf(b, b.metal(glm::vec3(1.0f), float(roughness)), 5);
      const double cosine = 0.8, sine = 0.6;
      lookParallel(b, {-sine, cosine, 0}, {0, 0, 0}, 1e-4f);
      const glm::dvec3 center = distance * glm::dvec3(sine, cosine, 0.1);
      b.emitter(glm::vec3(2.0f));
      shine(b, 1,
            {center + glm::dvec3(-0.2, 0, 0.2), center + glm::dvec3(0.2, 0, 0.2), center + glm::dvec3(0.2, 0, -0.2),
             center + glm::dvec3(-0.2, 0, -0.2)});
      const Ggx ggx{roughness * roughness};
      const double expected = 2.0 * 0.16 * quadrature(800, [&](double u, double v) {
                                const glm::dvec3 to = center + glm::dvec3(0.4 * u - 0.2, 0, 0.4 * v - 0.2);
                                const double d2 = glm::dot(to, to);
                                const glm::dvec3 w = to / std::sqrt(d2);
                                return ggx.brdf({-sine, 0, cosine}, {w.x, w.z, w.y}) * w.y * w.y / d2;
                              });
      RenderOptions options;
      options.samples = 256;
      expectMean(render(b, options), expected, 0.01);
    }
}

/// An emitter whose texture is white in one half: seen, and as a light.
TEST(AreaLight, EmissiveTextureShinesWhereItIsWhite) {
  Image halves;
  halves.width = 2;
  halves.height = 1;
  halves.rgba8 = {255, 255, 255, 255, 0, 0, 0, 255};
  const auto scene = [&](bool seen) {
    SceneBuilder b = floorAtOrigin();
    lookParallel(b, {0.3, 0.5, 0.4}, {0, 0, 0}, 1e-3f);
    const uint32_t material = b.emitter(glm::vec3(4.0f));
    b.scene.images.push_back(halves);
    b.scene.materials[material].emissiveTexture.image = 0;
    b.scene.materials[material].emissiveTexture.nearest = true;
    b.scene.materials[material].emissiveTexture.wrapS = b.scene.materials[material].emissiveTexture.wrapT =
        Wrap::clampToEdge;
    Primitive p;
    p.material = int32_t(material);
    p.positions = {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}};
    p.normals.assign(4, {0, -1, 0});
    p.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    p.indices = {0, 1, 2, 0, 2, 3};
    b.mesh(p);
    if (seen) lookParallel(b, {0, 0.5, 0}, {0, 1, 0}, 0.5f, {0, 0, 1});
    return b;
  };
  expectMean(render(scene(true)), 2.0, 0.01);
  const std::vector<glm::dvec3> white{{-1, 1, -1}, {0, 1, -1}, {0, 1, 1}, {-1, 1, 1}};
  RenderOptions options;
  options.samples = 256;
  expectMean(render(scene(false), options), kAlbedo / kPi * 4.0 * polygonIrradiance({0, 0, 0}, kUp, white), 0.01);
}

TEST(Layers, DirectIsWhatIsLeftWithoutBounces) {
  const SceneBuilder room = cornellLike();
  RenderOptions options;
  options.samples = 16;
  const FilmImage all = render(room, options);
  options.maxBounces = 0;
  const FilmImage none = render(room, options);
  const FilmLayer *beauty = all.find("beauty"), *direct = all.find("direct"), *indirect = all.find("indirect");
  const FilmLayer* alone = none.find("beauty");
  ASSERT_TRUE(beauty && direct && indirect && alone);
  double bounced = 0.0;
  for (size_t i = 0; i < beauty->data.size(); ++i) {
    EXPECT_NEAR(direct->data[i] + indirect->data[i], beauty->data[i], 1e-5f * (1 + beauty->data[i]));
    EXPECT_NEAR(direct->data[i], alone->data[i], 1e-5f * (1 + alone->data[i]));
    bounced += indirect->data[i];
  }
  EXPECT_GT(bounced, 0.0);
}

}  // namespace
}  // namespace limn::test
