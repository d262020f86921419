#include "tests/analytic/analytic.hpp"

namespace limn::test {
namespace {

void surround(SceneBuilder& b, float radiance) { b.scene.environment.radiance = glm::vec3(radiance); }

/// A constant image as the environment, which takes the way through the importance table.
void surroundByImage(SceneBuilder& b, uint32_t width, uint32_t height,
                     const std::function<float(uint32_t, uint32_t)>& radiance) {
  Image image;
  image.width = width;
  image.height = height;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      for (int k = 0; k < 4; ++k) image.rgbaF.push_back(radiance(x, y));
  b.scene.environment.image = std::make_shared<const Image>(std::move(image));
  b.scene.environment.radiance = glm::vec3(1.0f);
}

TEST(Furnace, DiffuseQuadShowsItsAlbedo) {
  for (const float albedo : {0.5f, 1.0f}) {
    SceneBuilder b;
    floorOf(b, b.diffuse(glm::vec3(albedo)), 10);
    surround(b, 1);
    b.look({0, 3, 3}, {0, 0, 0}, 0.7f);
    expectMean(render(b), albedo, 2e-3);
  }
}

TEST(Furnace, WhiteMetalShowsTheSingleScatteringAlbedo) {
  for (int step = 0; step <= 10; ++step)
    for (const double cosine : {0.9, 0.2}) {
      SCOPED_TRACE("roughness " + std::to_string(0.1 * step) + ", cosine " + std::to_string(cosine));
      SceneBuilder b;
      floorOf(b, b.metal(glm::vec3(1.0f), 0.1f * float(step)), 10);
      surround(b, 1);
      lookParallel(b, {0, cosine, std::sqrt(1 - cosine * cosine)}, {0, 0, 0}, 0.1f);
      expectMean(render(b), Ggx{double(0.1f * float(step)) * double(0.1f * float(step))}.albedo(cosine), 5e-3);
    }
}

/// What the specular layer lets through and the white one below sends back makes up for all that the former does not
/// reflect, but for the errors of the fits (ggx_albedo.glsl).
TEST(Furnace, WhiteDielectricSendsBackAllThatArrives) {
  for (const float roughness : {0.0f, 0.3f, 0.6f, 1.0f})
    for (const double cosine : {0.95, 0.4, 0.05}) {
      SceneBuilder b;
      Material m;
      m.metallic = 0;
      m.roughness = roughness;
      floorOf(b, b.material(m), 10);
      surround(b, 1);
      lookParallel(b, {0, cosine, std::sqrt(1 - cosine * cosine)}, {0, 0, 0}, 0.1f);
      const Measured mean = measure(render(b));
      EXPECT_LE(mean.mean, 1.0 + 3 * mean.error) << "roughness " << roughness << ", cosine " << cosine;
      EXPECT_GE(mean.mean, 0.985) << "roughness " << roughness << ", cosine " << cosine;
    }
}

TEST(Furnace, ClosedShiningBoxAddsAllBounces) {
  for (const float albedo : {0.0f, 0.5f, 0.9f}) {
    SceneBuilder b;
    const uint32_t walls = b.diffuse(glm::vec3(albedo));
    b.scene.materials[walls].emission = glm::vec3(0.7f);
    b.box(walls, {-1, -1.5f, -2}, {1, 1.5f, 2});
    b.look({0.2, 0.3, 0.9}, {0, -0.4, -1}, 1.2f);
    expectMean(render(b), 0.7 / (1 - albedo), 0.01);
  }
}

TEST(Furnace, PointLightInAClosedSphere) {
  constexpr uint32_t kSegments = 64;
  constexpr double kAlbedo = 0.6, kRadius = 2.0, kIntensity = 3.0;
  SceneBuilder b;
  b.sphere(b.diffuse(glm::vec3(float(kAlbedo))), {0, 0, 0}, float(kRadius), kSegments, true);
  b.pointLight({0, 0, 0}, glm::vec3(1.0f), float(kIntensity));
  b.look({0.5, 0.2, 0.1}, {-1, 0.1, 0.3}, 1.4f);
  // A point of a facet is within half a cell's diagonal of a corner, and never further out than the sphere.
  const double diagonal = kPi / kSegments / std::sqrt(2.0), tessellation = 1 / std::pow(std::cos(diagonal), 2) - 1;
  expectMean(render(b), kAlbedo / kPi * kIntensity / (kRadius * kRadius) / (1 - kAlbedo), 5e-3, 2 * tessellation);
}

TEST(Furnace, ConstantImageIsAConstantEnvironment) {
  SceneBuilder b;
  floorOf(b, b.diffuse(glm::vec3(0.8f)), 10);
  surroundByImage(b, 32, 16, [](uint32_t, uint32_t) { return 2.0f; });
  b.look({0, 3, 3}, {0, 0, 0}, 0.7f);
  expectMean(render(b), 1.6, 2e-3);
}

/// Bilinear in texels whose centres lie at half steps, as environment.glsl filters.
double lookUp(const Image& image, double u, double v) {
  const double s = u * image.width - 0.5, t = v * image.height - 0.5;
  const double x = std::floor(s), y = std::floor(t), fx = s - x, fy = t - y;
  const auto at = [&](double i, double j) {
    const uint32_t column = uint32_t(int(i + image.width) % int(image.width));
    const uint32_t row = uint32_t(std::clamp(int(j), 0, int(image.height) - 1));
    return double(image.rgbaF[(size_t(row) * image.width + column) * 4]);
  };
  return (at(x, y) * (1 - fx) + at(x + 1, y) * fx) * (1 - fy) + (at(x, y + 1) * (1 - fx) + at(x + 1, y + 1) * fx) * fy;
}

/// A sun a thousand times the sky, which fades with height: most of the table's cells are dim beside it.
TEST(Furnace, SunAndSkyLightADiffuseFloor) {
  for (const uint32_t height : {16u, 512u}) {
    SceneBuilder b;
    floorOf(b, b.diffuse(glm::vec3(1.0f)), 10);
    surroundByImage(b, 2 * height, height, [&](uint32_t x, uint32_t y) {
      const bool sun = x / (height / 16) == 20 && y / (height / 16) == 3;
      return sun ? 300.0f : 0.3f + 0.7f * float(y) / float(height);
    });
    b.scene.environment.rotation = 0.5f;
    b.look({0, 3, 3}, {0, 0, 0}, 0.7f);
    const Image& image = *b.scene.environment.image;
    // Over v in [0, 1/2]: the upper hemisphere. theta = pi v.
    const double irradiance = quadrature(2048, [&](double u, double w) {
      const double theta = 0.5 * kPi * w;
      return lookUp(image, u, 0.5 * w) * std::cos(theta) * std::sin(theta) * kPi * kPi;
    });
    RenderOptions options;
    options.samples = 256;
    SCOPED_TRACE(height);
    expectMean(render(b, options), irradiance / kPi, 4e-3);
  }
}

}  // namespace
}  // namespace limn::test
