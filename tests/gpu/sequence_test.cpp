#include <glm/glm.hpp>
#include <set>

#include "tests/gpu/kernel.hpp"
#include "tests/gpu/sequence.spv.hpp"
#include "tests/support/statistics.hpp"

namespace limn::test {
namespace {

struct SequencePush {
  uint32_t pixels, samples, pairs, seed;
};

struct Points {
  SequencePush shape;
  std::vector<glm::vec2> values;
  glm::vec2 at(uint32_t pixel, uint32_t sample, uint32_t pair) const {
    return values[(size_t(pixel) * shape.samples + sample) * shape.pairs + pair];
  }
};

Points draw(const SequencePush& shape) {
  const size_t paths = size_t(shape.pixels) * shape.samples;
  return {shape, runKernel<glm::vec2>(sequenceSpirv, {}, shape, paths * shape.pairs, groupsFor(paths))};
}

/// Every box of 2^-a x 2^-b with a + b = log2 n holds one of the n points from `first`.
void expectNet(const Points& points, uint32_t pixel, uint32_t pair, uint32_t first, uint32_t log2n) {
  for (uint32_t a = 0; a <= log2n; ++a) {
    std::set<uint32_t> boxes;
    for (uint32_t i = 0; i < 1u << log2n; ++i) {
      const glm::vec2 p = points.at(pixel, first + i, pair);
      boxes.insert(uint32_t(p.x * float(1u << a)) << (log2n - a) | uint32_t(p.y * float(1u << (log2n - a))));
    }
    EXPECT_EQ(boxes.size(), size_t(1) << log2n)
        << "pixel " << pixel << ", pair " << pair << ", first " << first << ", a " << a;
  }
}

TEST(Sequence, EveryPairIsAZeroTwoSequence) {
  const Points points = draw({5, 512, 6, 42});
  for (const glm::vec2& p : points.values) ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
  for (uint32_t pixel = 0; pixel < 5; ++pixel)
    for (uint32_t pair = 0; pair < 6; ++pair) {
      for (uint32_t first = 0; first < 64; first += 16) expectNet(points, pixel, pair, first, 4);
      for (uint32_t first = 0; first < 512; first += 64) expectNet(points, pixel, pair, first, 6);
      for (uint32_t first = 0; first < 512; first += 256) expectNet(points, pixel, pair, first, 8);
    }
}

/// Over pixels everything is uniform, and no two coordinates of a path know of each other.
TEST(Sequence, PixelsSamplesAndPairsAreIndependent) {
  constexpr uint32_t kPixels = 1u << 15, kSide = 16;
  const Points points = draw({kPixels, 2, 3, 7});
  const auto coordinate = [&](uint32_t pixel, uint32_t k) { return points.at(pixel, k / 6, k % 6 / 2)[int(k % 2)]; };
  for (uint32_t j = 0; j < 12; ++j)
    for (uint32_t k = j + 1; k < 12; ++k) {
      // The two samples of a pair are stratified against each other on purpose.
      if (k == j + 6) continue;
      std::vector<double> counts(kSide * kSide, 0.0);
      for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
        counts[uint32_t(coordinate(pixel, j) * kSide) * kSide + uint32_t(coordinate(pixel, k) * kSide)] += 1;
      const GoodnessOfFit fit =
          chiSquare(counts, std::vector<double>(kSide * kSide, double(kPixels) / (kSide * kSide)));
      EXPECT_GT(fit.p, 0.01 / 60) << "coordinates " << j << " and " << k << ", " << fit.worst;
    }
}

TEST(Sequence, SeedsDiffer) {
  const Points a = draw({4, 16, 2, 1}), b = draw({4, 16, 2, 2});
  int equal = 0;
  for (size_t i = 0; i < a.values.size(); ++i) equal += a.values[i] == b.values[i];
  EXPECT_LE(equal, 1);
}

}  // namespace
}  // namespace limn::test
