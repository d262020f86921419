// A file that names its environment image: a diffuse floor under a hot sun, against the integral over the image.
#include "renderer/scene/gltf_loader.hpp"
#include "tests/analytic/analytic.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kSunColumn = 20, kSunRow = 5;  // of tests/scenes/scenes_analytic.py
constexpr double kSunRadiance = 5000.0, kAlbedo = 0.5;

double luminance(const float* texel) { return 0.2126 * texel[0] + 0.7152 * texel[1] + 0.0722 * texel[2]; }

/// Irradiance [W/m²] of a floor that sees the upper half of a latitude-longitude image: each texel's radiance times the
/// integral, over the sphere above the horizon, of the cosine and of the hat function by which texels are blended.
/// Columns cover the circle evenly, so that hats of all columns weigh alike.
double irradiance(const Image& image) {
  constexpr int kSteps = 512;  // a row of texels
  const double height = image.height;
  double sum = 0.0;
  for (uint32_t row = 0; row < image.height; ++row) {
    double weight = 0.0;
    for (int i = 0; i < 2 * kSteps; ++i) {
      const double v = row - 0.5 + (i + 0.5) / kSteps;  // [texel] from the top
      const double hat = row == 0 && v < 0.5 ? 1.0 : 1.0 - std::abs(v - row - 0.5);
      const double theta = kPi * v / height;
      if (theta > 0.0 && theta < 0.5 * kPi) weight += hat * std::cos(theta) * std::sin(theta) * kPi / height / kSteps;
    }
    double mean = 0.0;
    for (uint32_t x = 0; x < image.width; ++x)
      mean += luminance(&image.rgbaF[(size_t(row) * image.width + x) * 4]) / image.width;
    sum += 2.0 * kPi * mean * weight;
  }
  return sum;
}

TEST(EnvironmentOfAFile, LightsADiffuseFloorAsItsIntegralSays) {
  auto loaded = must(loadGltf(LIMN_BUILD_DIR "/scenes/analytic-sky.glb"));
  const Image* sky = loaded.scene.environment.image.get();
  ASSERT_NE(sky, nullptr);
  EXPECT_EQ(sky->name, "analytic-sky.hdr");
  EXPECT_NEAR(sky->rgbaF[(size_t(kSunRow) * sky->width + kSunColumn) * 4], kSunRadiance, 0.01 * kSunRadiance);
  EXPECT_EQ(loaded.scene.environment.radiance, glm::vec3(1.0f));
  RenderOptions options;
  options.samples = 256;
  SceneBuilder builder;
  builder.scene = std::move(loaded.scene);
  expectMean(render(builder, options), kAlbedo / kPi * irradiance(*builder.scene.environment.image), 4e-3);
}

}  // namespace
}  // namespace limn::test
