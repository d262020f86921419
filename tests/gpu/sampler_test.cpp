#include <cmath>
#include <numbers>

#include "tests/gpu/kernel.hpp"
#include "tests/gpu/samplers.spv.hpp"
#include "tests/gpu/shaders/samplers.h"
#include "tests/support/statistics.hpp"

namespace limn::test {
namespace {

using shared::kPhiBins, shared::kThetaBins;
constexpr double kPi = std::numbers::pi;
constexpr uint32_t kPoints = 1u << 17;
constexpr uint32_t kBins = kThetaBins * kPhiBins;
constexpr double kLevel = 0.01 / 16;  ///< of one test, so that all of them together err by chance once in 100 seeds

std::vector<glm::vec4> draw(uint32_t kind, uint32_t seed, glm::vec3 wo = {0, 0, 1}, float alpha = 1.0f) {
  return runKernel<glm::vec4>(samplersSpirv, {}, shared::SamplersPush{wo, alpha, kind, 0, kPoints, seed}, kPoints,
                              groupsFor(kPoints));
}

/// Bin of coordinates in [0, 1]; rounding may touch either end.
size_t binOf(double row, double column) {
  const auto index = [](double v, uint32_t bins) { return size_t(std::clamp(v * bins, 0.0, bins - 1.0)); };
  return index(row, kThetaBins) * kPhiBins + index(column, kPhiBins);
}
double turn(double y, double x) { return std::atan2(y, x) / (2 * kPi) + (y < 0 ? 1.0 : 0.0); }

template <class Bin>
std::vector<double> histogram(const std::vector<glm::vec4>& points, Bin bin) {
  std::vector<double> counts(kBins, 0.0);
  for (const glm::vec4& p : points) counts[bin(glm::dvec4(p))] += 1.0;
  return counts;
}

void expectFit(const std::vector<double>& counts, const std::vector<double>& expected) {
  const GoodnessOfFit fit = chiSquare(counts, expected);
  EXPECT_GT(fit.p, kLevel) << "chi-square " << fit.statistic << " of " << fit.dof << ", " << fit.worst;
}

TEST(Sampler, CosineHemisphereFollowsTheCosine) {
  std::vector<double> expected(kBins);
  for (uint32_t i = 0; i < kBins; ++i) {  // rows of equal steps in z: the mass of one is z1² - z0²
    const double z0 = double(i / kPhiBins) / kThetaBins, z1 = double(i / kPhiBins + 1) / kThetaBins;
    expected[i] = kPoints * (z1 * z1 - z0 * z0) / kPhiBins;
  }
  const auto points = draw(shared::kSamplerCosine, 1);
  for (const glm::vec4& p : points) ASSERT_NEAR(glm::length(glm::dvec3(p)), 1.0, 1e-6);
  expectFit(histogram(points, [](const glm::dvec4& p) { return binOf(p.z, turn(p.y, p.x)); }), expected);
}

TEST(Sampler, SphereIsUniform) {
  const auto points = draw(shared::kSamplerSphere, 2);
  for (const glm::vec4& p : points) ASSERT_NEAR(glm::length(glm::dvec3(p)), 1.0, 1e-6);
  expectFit(histogram(points, [](const glm::dvec4& p) { return binOf(0.5 + 0.5 * p.z, turn(p.y, p.x)); }),
            std::vector<double>(kBins, double(kPoints) / kBins));
}

TEST(Sampler, DiskIsUniform) {
  const auto points = draw(shared::kSamplerDisk, 3);
  expectFit(histogram(points, [](const glm::dvec4& p) { return binOf(p.x * p.x + p.y * p.y, turn(p.y, p.x)); }),
            std::vector<double>(kBins, double(kPoints) / kBins));
}

TEST(Sampler, TriangleIsUniform) {
  constexpr int kSide = 24;
  std::vector<double> counts(kSide * kSide, 0.0), expected(kSide * kSide, 0.0);
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; i + j < kSide; ++j)
      expected[size_t(i * kSide + j)] = double(kPoints) / (kSide * kSide) * (i + j == kSide - 1 ? 1 : 2);
  for (const glm::vec4& p : draw(shared::kSamplerTriangle, 4)) {
    ASSERT_TRUE(p.x >= 0 && p.y >= 0 && p.x + p.y <= 1.000001f);
    counts[size_t(std::min(int(p.x * kSide), kSide - 1) * kSide + std::min(int(p.y * kSide), kSide - 1))] += 1.0;
  }
  expectFit(counts, expected);
}

struct Lobe {
  float alpha, cosine;
};

class VisibleNormals : public testing::TestWithParam<Lobe> {};
INSTANTIATE_TEST_SUITE_P(Lobes, VisibleNormals,
                         testing::Values(Lobe{0.01f, 1.0f}, Lobe{0.01f, 0.5f}, Lobe{0.01f, 0.03f}, Lobe{0.1f, 1.0f},
                                         Lobe{0.1f, 0.5f}, Lobe{0.1f, 0.03f}, Lobe{0.5f, 1.0f}, Lobe{0.5f, 0.5f},
                                         Lobe{0.5f, 0.03f}, Lobe{1.0f, 1.0f}, Lobe{1.0f, 0.5f}, Lobe{1.0f, 0.03f}));

TEST_P(VisibleNormals, FollowTheirDensity) {
  const auto [alpha, cosine] = GetParam();
  const float sine = std::sqrt(1 - cosine * cosine);
  const glm::vec3 wo(sine * std::cos(0.7f), sine * std::sin(0.7f), cosine);
  const auto mass = runKernel<glm::vec4>(samplersSpirv, {},
                                         shared::SamplersPush{wo, alpha, shared::kSamplerVisibleNormal, 1, kBins, 0},
                                         kBins, groupsFor(kBins));
  double total = 0.0;
  std::vector<double> expected;
  for (const glm::vec4& m : mass) {
    total += m.x;
    expected.push_back(m.x * double(kPoints));
  }
  EXPECT_NEAR(total, 1.0, 2e-3);
  const auto counts = histogram(draw(shared::kSamplerVisibleNormal, 5, wo, alpha), [&](const glm::dvec4& h) {
    const glm::dvec3 stretched = glm::normalize(glm::dvec3(h.x / alpha, h.y / alpha, h.z));
    return binOf(stretched.z, turn(h.y, h.x));
  });
  expectFit(counts, expected);
}

}  // namespace
}  // namespace limn::test
