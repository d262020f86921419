#include <cmath>
#include <numbers>

#include "renderer/gpu/device_scene.hpp"
#include "shaders/shared/bindings.h"
#include "tests/gpu/kernel.hpp"
#include "tests/gpu/lights.spv.hpp"
#include "tests/gpu/shaders/lights.h"
#include "tests/support/scene_builder.hpp"
#include "tests/support/statistics.hpp"

namespace limn::test {
namespace {

using shared::kEnvironmentColumns, shared::kEnvironmentRows;
constexpr double kLevel = 0.01 / 8;
constexpr uint32_t kDraws = 1u << 18;
constexpr uint32_t kBins = kEnvironmentRows * kEnvironmentColumns;

std::unique_ptr<gpu::DeviceScene> mirrorOf(const SceneBuilder& b) {
  auto mirror = std::make_unique<gpu::DeviceScene>(SharedDevice::get());
  ChangeSet everything;
  everything.everything = true;
  must(mirror->sync(b.scene, everything));
  return mirror;
}

SceneBuilder sky(uint32_t width, uint32_t height, bool hotTexel) {
  SceneBuilder b;
  Image image;
  image.width = width;
  image.height = height;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const bool hot = hotTexel && x == width / 3 && y == height / 4;
      const float value =
          hot ? 2e3f * float(width * height) / 512.0f : 0.1f + float(x) / float(width) + float(y) / float(height);
      for (int k = 0; k < 4; ++k) image.rgbaF.push_back(value);
    }
  b.scene.environment.image = std::make_shared<const Image>(std::move(image));
  b.scene.environment.radiance = glm::vec3(1.0f);
  b.scene.environment.rotation = 0.8f;
  b.quad(b.diffuse(glm::vec3(0.5f)), {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
  return b;
}

void expectFit(const std::vector<double>& counts, const std::vector<double>& expected) {
  const GoodnessOfFit fit = chiSquare(counts, expected);
  EXPECT_GT(fit.p, kLevel) << "chi-square " << fit.statistic << " of " << fit.dof << ", " << fit.worst;
}

struct SkyCase {
  const char* name;
  uint32_t width, height;
  bool hot;
};
void PrintTo(const SkyCase& c, std::ostream* out) { *out << c.name; }
std::string skyName(const testing::TestParamInfo<SkyCase>& info) { return info.param.name; }

class EnvironmentTable : public testing::TestWithParam<SkyCase> {};
INSTANTIATE_TEST_SUITE_P(Skies, EnvironmentTable,
                         testing::Values(SkyCase{"Gradient", 64, 32, false}, SkyCase{"HotTexel", 64, 32, true},
                                         SkyCase{"LargeGradient", 1024, 512, false},
                                         SkyCase{"LargeHotTexel", 1024, 512, true}),
                         skyName);

TEST_P(EnvironmentTable, DirectionsFollowTheirPdf) {
  const auto mirror = mirrorOf(sky(GetParam().width, GetParam().height, GetParam().hot));
  const auto mass =
      runKernel<glm::vec4>(lightsSpirv, mirror->bindings(), shared::LightsPush{{}, 0, shared::kLightsMass, kBins, 0},
                           kBins, groupsFor(kBins));
  double total = 0.0;
  std::vector<double> expected, counts(kBins, 0.0);
  for (const glm::vec4& m : mass) {
    total += m.x;
    expected.push_back(m.x * double(kDraws));
  }
  EXPECT_NEAR(total, 1.0, 1e-3);

  struct Draw {
    glm::vec2 uv;
    float pdf, pdfOfDirection;
    glm::vec3 radiance;
    float y;
  };
  const auto draws =
      runKernel<Draw>(lightsSpirv, mirror->bindings(), shared::LightsPush{{}, 0, shared::kLightsEnvironment, kDraws, 9},
                      kDraws, groupsFor(kDraws));
  uint32_t strangers = 0;
  for (const Draw& d : draws) {
    const uint32_t row = std::min(uint32_t((0.5 - 0.5 * d.y) * kEnvironmentRows), kEnvironmentRows - 1);
    const uint32_t column = std::min(uint32_t(d.uv.x * float(kEnvironmentColumns)), kEnvironmentColumns - 1);
    counts[row * kEnvironmentColumns + column] += 1;
    ASSERT_GT(d.pdf, 0.0f);
    strangers += std::abs(d.pdf - d.pdfOfDirection) > 1e-4f * d.pdf;
    ASSERT_TRUE(std::isfinite(d.radiance.g));
  }
  // Rounding moves a direction at a cell's border next door.
  EXPECT_LT(strangers, kDraws / 500);
  expectFit(counts, expected);
}

/// Lights of very unequal power, most of them with an alias; far away, so that the alias table alone chooses.
TEST(LightChoice, FollowsThePowers) {
  for (const uint32_t count : {7u, 300u}) {
    SceneBuilder b;
    b.quad(b.diffuse(glm::vec3(0.5f)), {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
    double sum = 0.0;
    for (uint32_t i = 0; i < count; ++i) {
      const float power = i % 10 == 0 ? 100.0f : 0.2f + float(i % 5);
      b.directionalLight({float(i), -1, 0}, glm::vec3(1.0f), power);
      sum += power;
    }
    const auto mirror = mirrorOf(b);
    const auto draws =
        runKernel<glm::vec4>(lightsSpirv, mirror->bindings(),
                             shared::LightsPush{{}, 0, shared::kLightsChoose, kDraws, 5}, kDraws, groupsFor(kDraws));
    std::vector<double> counts(count, 0.0), expected, rest(32, 0.0);
    for (uint32_t i = 0; i < count; ++i) {
      expected.push_back(kDraws * double(b.scene.lights[i].intensity) / sum);
      EXPECT_NEAR(mirror->lights()[i].probability, expected[i] / kDraws, 1e-6);
    }
    for (const glm::vec4& d : draws) {
      ASSERT_LT(d.x, float(count));
      ASSERT_EQ(d.y, mirror->lights()[size_t(d.x)].probability);
      ASSERT_TRUE(d.w >= 0 && d.w < 1);
      counts[size_t(d.x)] += 1;
      rest[size_t(d.w * 32)] += 1;
    }
    expectFit(counts, expected);
    expectFit(rest, std::vector<double>(32, kDraws / 32.0));
  }
}

/// Solid angle of a triangle. [Van Oosterom and Strackee 1983]
double solidAngle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  a = glm::normalize(a), b = glm::normalize(b), c = glm::normalize(c);
  return std::abs(2 * std::atan2(glm::dot(a, glm::cross(b, c)), 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a)));
}

TEST(TriangleLight, PointsAreUniformAndTheirPdfIsOverSolidAngle) {
  const glm::dvec3 corner[3] = {{0.3, 1.1, -0.4}, {1.2, 0.7, 0.1}, {-0.5, 1.6, 0.9}};
  SceneBuilder b;
  Primitive p;
  p.material = int32_t(b.emitter(glm::vec3(2.0f)));
  for (const glm::dvec3& c : corner) p.positions.push_back(glm::vec3(c));
  p.normals.assign(3, glm::vec3(glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]))));
  p.indices = {0, 1, 2};
  b.mesh(p);
  const auto mirror = mirrorOf(b);
  const glm::dvec3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0], normal = glm::cross(e1, e2);
  for (const glm::dvec3 from : {glm::dvec3(0.1, -0.2, 0.3), glm::dvec3(-1, 3, 0.5)}) {
    struct Draw {
      glm::vec3 dirW;
      float distance;
      glm::vec3 radiance;
      float pdf;
    };
    const auto draws = runKernel<Draw>(lightsSpirv, mirror->bindings(),
                                       shared::LightsPush{glm::vec3(from), 0, shared::kLightsTriangle, kDraws, 8},
                                       kDraws, groupsFor(kDraws));
    constexpr int kSide = 16;
    std::vector<double> counts(kSide * kSide, 0.0), expected(kSide * kSide, 0.0);
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j + i < kSide; ++j)
        expected[size_t(i * kSide + j)] = double(kDraws) / (kSide * kSide) * (i + j == kSide - 1 ? 1 : 2);
    double sum = 0.0, squares = 0.0;
    for (const Draw& d : draws) {
      const glm::dvec3 w = glm::normalize(glm::dvec3(d.dirW));
      const double t = glm::dot(corner[0] - from, normal) / glm::dot(w, normal);
      const glm::dvec3 q = from + t * w - corner[0];
      const double u = glm::dot(glm::cross(q, e2), normal) / glm::dot(normal, normal);
      const double v = glm::dot(glm::cross(e1, q), normal) / glm::dot(normal, normal);
      ASSERT_TRUE(u > -1e-5 && v > -1e-5 && u + v < 1 + 1e-5);
      const auto index = [](double x) { return std::clamp(int(x * kSide), 0, kSide - 1); };
      const int i = index(u), j = std::min(index(v), kSide - 1 - i);
      counts[size_t(i * kSide + j)] += 1;
      const double area = 0.5 * glm::length(normal),
                   pdf = t * t / (area * std::abs(glm::dot(w, glm::normalize(normal))));
      ASSERT_NEAR(d.pdf, pdf, 1e-4 * pdf);
      ASSERT_NEAR(d.radiance.g, 2.0 / pdf, 2e-4 / pdf);
      ASSERT_NEAR(d.distance, t, 1e-4 * t);
      ASSERT_LT(d.distance, t);
      sum += 1 / d.pdf;
      squares += 1 / (double(d.pdf) * d.pdf);
    }
    expectFit(counts, expected);
    const double mean = sum / kDraws, error = std::sqrt((squares / kDraws - mean * mean) / kDraws);
    EXPECT_NEAR(mean, solidAngle(corner[0] - from, corner[1] - from, corner[2] - from), 3.5 * error);
  }
}

}  // namespace
}  // namespace limn::test
