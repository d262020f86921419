#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <random>

#include "tests/gpu/allocation.spv.hpp"
#include "tests/gpu/kernel.hpp"
#include "tests/gpu/micro_buffer.spv.hpp"

namespace limn::test {
namespace {

constexpr double kPi = std::numbers::pi;

struct MicroTexel {
  glm::vec3 dir;
  float solidAngle;
  glm::vec2 found;
};

TEST(MicroBuffer, TexelsFillTheHemisphereAndAreFoundAgain) {
  for (uint32_t size = 8; size <= 32; ++size) {
    const auto texels = runKernel<MicroTexel>(micro_bufferSpirv, {}, size, size * size, groupsFor(size * size));
    double solidAngle = 0.0, cosine = 0.0;
    for (uint32_t i = 0; i < texels.size(); ++i) {
      const MicroTexel& t = texels[i];
      EXPECT_NEAR(glm::length(t.dir), 1.0f, 1e-5f);
      EXPECT_GE(t.dir.z, 0.0f);
      EXPECT_NEAR(t.found.x * float(size), float(i % size) + 0.5f, 1e-3f);
      EXPECT_NEAR(t.found.y * float(size), float(i / size) + 0.5f, 1e-3f);
      solidAngle += t.solidAngle;
      cosine += t.solidAngle * t.dir.z;
    }
    if (size % 2 == 1) continue;  // the middle row of texels lies across the octahedron's edges
    EXPECT_NEAR(solidAngle, 2 * kPi, 1e-4 * 2 * kPi) << size;
    EXPECT_NEAR(cosine, kPi, 4e-4 * kPi) << size;
  }
}

/// Equation 2 with the paper's axes: the pole is its y, ours z, and its z is our y. [IPP eq. 2]
TEST(MicroBuffer, TheNormalIsInTheMiddleAndTheHorizonIsTheRim) {
  const uint32_t size = 32;
  const auto texels = runKernel<MicroTexel>(micro_bufferSpirv, {}, size, size * size, groupsFor(size * size));
  EXPECT_GT(texels[16 * 32 + 16].dir.z, 0.99f);
  for (uint32_t i = 0; i < size; ++i) EXPECT_LT(texels[i].dir.z, 0.06f);
  EXPECT_GT(texels[0].dir.x, 0.99f);            // (0, 0): +x
  EXPECT_GT(texels[size - 1].dir.y, 0.99f);     // (1, 0): +y
  EXPECT_LT(texels[size * size - 1].dir.x, -0.99f);
}

struct AllocationPush {
  uint32_t clusters, samples, seed;
};

/// Counts of all clusters, case after case.
std::vector<glm::vec2> allocate(const std::vector<float>& importance, AllocationPush push) {
  const vk::Buffer in = inputOf(importance);
  const auto cases = uint32_t(importance.size() / push.clusters);
  return runKernel<glm::vec2>(allocationSpirv, {vk::storage(0, in)}, push, importance.size(), cases);
}

TEST(CarryLoop, GivesExactlyTheSamplesInProportion) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (const uint32_t clusters : {1u, 64u, 512u, 1024u}) {
    std::vector<float> importance;
    const auto addCase = [&](auto value) {
      for (uint32_t k = 0; k < clusters; ++k) importance.push_back(float(value(k)));
    };
    addCase([](uint32_t) { return 1.0; });
    addCase([](uint32_t) { return 0.0; });
    addCase([&](uint32_t) { return unit(random); });
    addCase([&](uint32_t) { return std::pow(unit(random), 40.0f) * 1e9f; });
    addCase([](uint32_t k) { return k == 0 ? 6.0 : 0.0; });
    addCase([&](uint32_t k) { return k + 1 == clusters ? 6.0 : 1e-12; });
    addCase([](uint32_t k) { return k % 7 == 3 ? 1e-20 : 0.0; });
    for (const uint32_t samples : {0u, 1u, 100u, 2048u, 2046u}) {
      const auto counts = allocate(importance, {clusters, samples, 5});
      for (size_t first = 0; first < counts.size(); first += clusters) {
        double sum = 0.0, expected = 0.0;
        for (size_t k = first; k < first + clusters; ++k) {
          EXPECT_GE(counts[k].x, 0.0f);
          sum += counts[k].x;
          expected += counts[k].y;
          EXPECT_LT(std::abs(sum - expected), 1.0 + 1e-3) << "what is carried over is less than a sample";
        }
        EXPECT_EQ(sum, samples) << "case " << first / clusters << " of " << clusters << " clusters";
      }
    }
  }
}

TEST(CarryLoop, SeedsDiffer) {
  const std::vector<float> importance(64, 1.0f);
  EXPECT_NE(allocate(importance, {64, 100, 1}), allocate(importance, {64, 100, 2}));
}

}  // namespace
}  // namespace limn::test
