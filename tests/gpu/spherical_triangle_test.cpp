// Triangle lights sampled evenly over their solid angle: chi-square over cells whose solid angles have a closed form.
#include <cmath>

#include "renderer/gpu/device_scene.hpp"
#include "tests/gpu/kernel.hpp"
#include "tests/gpu/lights.spv.hpp"
#include "tests/gpu/shaders/lights.h"
#include "tests/support/scene_builder.hpp"
#include "tests/support/statistics.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kDraws = 1u << 17;
constexpr int kSide = 16;              ///< cells along a side of the triangle
constexpr double kLevel = 0.01 / 16;   ///< of one test, so that all of them together err by chance once in 100 seeds
constexpr float kEmission = 2.0f;

/// Solid angle of a triangle. [Van Oosterom and Strackee 1983]
double solidAngle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  a = glm::normalize(a), b = glm::normalize(b), c = glm::normalize(c);
  return std::abs(2 * std::atan2(glm::dot(a, glm::cross(b, c)), 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a)));
}

/// A triangle as seen from a point.
struct Seen {
  const char* name;
  glm::dvec3 from, corner[3];

  glm::dvec3 at(double u, double v) const {
    return corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0]) - from;
  }
  double whole() const { return solidAngle(at(0, 0), at(1, 0), at(0, 1)); }
  /// Barycentrics of what a direction meets.
  glm::dvec2 met(const glm::dvec3& w) const {
    const glm::dvec3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0], n = glm::cross(e1, e2);
    const glm::dvec3 q = from + glm::dot(corner[0] - from, n) / glm::dot(w, n) * w - corner[0];
    return {glm::dot(glm::cross(q, e2), n) / glm::dot(n, n), glm::dot(glm::cross(e1, q), n) / glm::dot(n, n)};
  }
  double distance(const glm::dvec3& w) const {
    const glm::dvec3 n = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    return glm::dot(corner[0] - from, n) / glm::dot(w, n);
  }
};
void PrintTo(const Seen& seen, std::ostream* out) { *out << seen.name; }

/// Cells of a grid in barycentrics: squares, and halves of them along the slanted side.
std::vector<double> expectedCounts(const Seen& seen) {
  std::vector<double> expected(kSide * kSide, 0.0);
  const double step = 1.0 / kSide;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; i + j < kSide; ++j) {
      const double u = i * step, v = j * step;
      double cell = solidAngle(seen.at(u, v), seen.at(u + step, v), seen.at(u, v + step));
      if (i + j < kSide - 1)
        cell += solidAngle(seen.at(u + step, v), seen.at(u + step, v + step), seen.at(u, v + step));
      expected[size_t(i * kSide + j)] = kDraws * cell / seen.whole();
    }
  return expected;
}

size_t cellOf(const glm::dvec2& b) {
  EXPECT_TRUE(b.x > -1e-3 && b.y > -1e-3 && b.x + b.y < 1 + 1e-3) << b.x << " " << b.y;
  const int i = std::clamp(int(b.x * kSide), 0, kSide - 1);
  return size_t(i * kSide + std::clamp(int(b.y * kSide), 0, kSide - 1 - i));
}

void expectFit(const std::vector<double>& counts, const std::vector<double>& expected) {
  const GoodnessOfFit fit = chiSquare(counts, expected);
  EXPECT_GT(fit.p, kLevel) << "chi-square " << fit.statistic << " of " << fit.dof << ", " << fit.worst;
}

std::unique_ptr<gpu::DeviceScene> sceneOf(const Seen& seen) {
  SceneBuilder b;
  Primitive p;
  p.material = int32_t(b.emitter(glm::vec3(kEmission)));
  for (const glm::dvec3& c : seen.corner) p.positions.push_back(glm::vec3(c));
  const glm::dvec3 normal = glm::cross(seen.corner[1] - seen.corner[0], seen.corner[2] - seen.corner[0]);
  p.normals.assign(3, glm::vec3(glm::normalize(normal)));
  p.indices = {0, 1, 2};
  b.mesh(p);
  auto mirror = std::make_unique<gpu::DeviceScene>(SharedDevice::get());
  ChangeSet everything;
  everything.everything = true;
  must(mirror->sync(b.scene, everything));
  return mirror;
}

template <class T>
std::vector<T> draw(const Seen& seen, uint32_t mode) {
  const auto mirror = sceneOf(seen);
  const glm::vec3 fromR(seen.from - mirror->renderOrigin());
  return runKernel<T>(lightsSpirv, mirror->bindings(), shared::LightsPush{fromR, 0, mode, kDraws, 8}, kDraws,
                      groupsFor(kDraws));
}

class SphericalTriangle : public testing::TestWithParam<Seen> {};
INSTANTIATE_TEST_SUITE_P(
    Triangles, SphericalTriangle,
    testing::Values(Seen{"Octant", {0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                    Seen{"Wide", {0.1, -0.2, 0.3}, {{0.3, 1.1, -0.4}, {1.2, 0.7, 0.1}, {-0.5, 1.6, 0.9}}},
                    Seen{"Near", {0, 0, 0.05}, {{-1, -1, 0}, {1.5, -0.8, 0}, {0.1, 1.2, 0}}},
                    Seen{"Slanted", {0.4, 0.1, 0.02}, {{-1, -1, 0}, {1.5, -0.8, 0}, {0.1, 1.2, 0}}},
                    Seen{"Far", {0, 0, 8}, {{-1, -1, 0}, {1.5, -0.8, 0}, {0.1, 1.2, 0}}}),
    [](const auto& seen) { return std::string(seen.param.name); });

TEST_P(SphericalTriangle, DirectionsAreUniformOverTheSolidAngle) {
  const Seen& seen = GetParam();
  std::vector<double> counts(kSide * kSide, 0.0);
  for (const glm::vec4& d : draw<glm::vec4>(seen, shared::kLightsSphericalTriangle)) {
    const glm::dvec3 w(d);
    ASSERT_NEAR(glm::length(w), 1.0, 1e-5);
    ASSERT_NEAR(d.w, seen.whole(), 1e-3 * seen.whole());
    counts[cellOf(seen.met(w))] += 1.0;
  }
  expectFit(counts, expectedCounts(seen));
}

TEST_P(SphericalTriangle, ALightsSamplesFollowTheirPdf) {
  struct Draw {
    glm::vec3 dirW;
    float distance;
    glm::vec3 radiance;
    float pdf;
  };
  const Seen& seen = GetParam();
  std::vector<double> counts(kSide * kSide, 0.0);
  for (const Draw& d : draw<Draw>(seen, shared::kLightsTriangleEvenly)) {
    const glm::dvec3 w(d.dirW);
    ASSERT_NEAR(d.pdf * seen.whole(), 1.0, 1e-3);
    ASSERT_NEAR(d.radiance.g * d.pdf, kEmission, 1e-4);
    ASSERT_NEAR(d.distance, seen.distance(w), 2e-3 * seen.distance(w));
    counts[cellOf(seen.met(w))] += 1.0;
  }
  expectFit(counts, expectedCounts(seen));
}

}  // namespace
}  // namespace limn::test
