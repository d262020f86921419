// The error that audit pixels tell of made pictures, whose truth, bias and noise are known.
#include "renderer/techniques/audit_estimate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "renderer/techniques/technique.hpp"

namespace limn {
namespace {

constexpr uint32_t kSide = 16;  // [tile]
constexpr int kSeeds = 40;

/// A picture whose truth varies from pixel to pixel, shown with a bias and noise, audited with noisy samples.
struct Made {
  double bias = 1.0;          ///< shown over true
  double shownNoise = 0.0;    ///< standard deviation over the truth
  double auditNoise = 1.0;    ///< of one sample, over the truth
  float samples = 4.0f;       ///< of each half

  std::vector<shared::AuditRecord> records(uint32_t sets, int seed) const {
    std::mt19937 engine(uint32_t(seed) * 7919u + 1u);
    std::lognormal_distribution<float> truths(0.0f, 0.5f);
    std::vector<shared::AuditRecord> made;
    for (uint32_t i = 0; i < kSide * kSide * sets; ++i) {
      const glm::vec3 truth(truths(engine), truths(engine), truths(engine));
      const auto noisy = [&](double mean, double deviation) {  // never negative, as radiance
        const double shape = mean * mean / std::max(deviation * deviation, 1e-12);
        return truth * float(std::gamma_distribution<double>(shape, mean / shape)(engine));
      };
      const double ofHalf = auditNoise / std::sqrt(double(samples));
      const glm::vec3 shown = noisy(bias, shownNoise), even = noisy(1.0, ofHalf), odd = noisy(1.0, ofHalf);
      const double deviation = auditNoise * glm::dot(truth, glm::vec3(0.2126f, 0.7152f, 0.0722f));
      std::chi_squared_distribution<double> squares(2.0 * double(samples) - 1.0);
      made.push_back({shown, 8.0f, even, samples, odd, samples, float(deviation * deviation * squares(engine))});
    }
    return made;
  }

  /// relMSE = mean(error² / (r² + 0.01·mean(r)²)); the error is the same share of each pixel.
  double relMse() const {
    const double share = (bias - 1.0) * (bias - 1.0) + shownNoise * shownNoise;
    const double meanSquare = std::exp(0.25);  // mean² of the truths, which are log-normal
    double weight = 0.0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
      const double z = (i + 0.5) / kSteps * 12.0 - 6.0, r = std::exp(0.5 * z);
      const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
      weight += density * 12.0 / kSteps * r * r / (r * r + 0.01 * meanSquare);
    }
    return share * weight;
  }
};

struct Outcome {
  double mean = 0.0;  ///< of the estimates
  int held = 0;       ///< intervals that hold the truth
};

Outcome audit(const Made& made, uint32_t sets) {
  Outcome outcome;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const FilmError error = estimateFromAudit(made.records(sets, seed), kSide, kSide);
    outcome.mean += error.relMse / kSeeds;
    outcome.held += error.low <= made.relMse() && made.relMse() <= error.high;
  }
  return outcome;
}

TEST(AuditEstimate, BiasAndNoiseOfThePictureCount) {
  for (const Made& made : {Made{1.5, 0.0}, Made{0.3, 0.0}, Made{1.0, 0.4}, Made{4.0, 0.0}, Made{1.2, 0.2}}) {
    const Outcome outcome = audit(made, 2);
    // Between two denominators of which one is too large and the other too small; noise of 40 % is the worst.
    EXPECT_NEAR(std::log(outcome.mean / made.relMse()), 0.0, std::log(1.4)) << made.bias << ", " << made.shownNoise;
    EXPECT_GE(outcome.held, kSeeds * 9 / 10) << made.bias << ", " << made.shownNoise;
  }
}

TEST(AuditEstimate, NoiseOfTheAuditDoesNotCountAndWidensTheInterval) {
  const Made quiet{1.05, 0.0, 0.2}, noisy{1.05, 0.0, 2.0};
  EXPECT_NEAR(audit(quiet, 4).mean / quiet.relMse(), 1.0, 0.1);
  const FilmError narrow = estimateFromAudit(quiet.records(4, 1), kSide, kSide);
  const FilmError wide = estimateFromAudit(noisy.records(4, 1), kSide, kSide);
  EXPECT_GT(wide.high - wide.low, 10.0 * (narrow.high - narrow.low));
  EXPECT_GE(audit(noisy, 4).held, kSeeds * 9 / 10);
}

TEST(AuditEstimate, ErrorOfAFewTilesIsHeld) {
  int held = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Made good{1.0, 0.0}, bad{3.0, 0.0};
    auto records = good.records(2, seed);
    const auto wrong = bad.records(2, seed);
    double truth = 0.0;
    for (size_t i = 0; i < records.size(); ++i)
      if (i % 32 == 5) records[i] = wrong[i], truth += bad.relMse() / double(records.size());
    const FilmError error = estimateFromAudit(records, kSide, kSide);
    held += error.low <= truth && truth <= error.high;
  }
  EXPECT_GE(held, kSeeds * 9 / 10);
}

TEST(AuditEstimate, IsUnknownWithoutEnoughOfThePicture) {
  EXPECT_TRUE(std::isinf(estimateFromAudit({}, kSide, kSide).high));
  auto records = Made{}.records(1, 0);
  for (size_t i = kLeastTiles - 1; i < records.size(); ++i) records[i].oddCount = 0.0f;
  const FilmError error = estimateFromAudit(records, kSide, kSide);
  EXPECT_TRUE(std::isinf(error.relMse));
  EXPECT_TRUE(std::isinf(error.high));
}

/// With one pixel a tile, the largest errors that are left out may be all that is known of a tile, in one way of two.
TEST(AuditEstimate, IsKnownWhereWholeTilesAreLeftOut) {
  const Made noisy{1.0, 0.8, 1.0};
  for (int seed = 0; seed < kSeeds; ++seed)  // one set of four times as many tiles
    EXPECT_TRUE(std::isfinite(estimateFromAudit(noisy.records(4, seed), 2 * kSide, 2 * kSide).high)) << seed;
}

TEST(AuditEstimate, GoodPicturesNeedSamplesAndBadOnesNeedPixels) {
  const Made good{1.02, 0.0, 2.0}, bad{1.0, 0.8, 0.3};
  EXPECT_TRUE(noiseOutweighsChoice(good.records(2, 1), kSide, kSide));
  EXPECT_FALSE(noiseOutweighsChoice(bad.records(2, 1), kSide, kSide));
  EXPECT_FALSE(noiseOutweighsChoice({}, kSide, kSide));
}

TEST(AuditEstimate, EveryBiasedTechniqueAnnouncesItsShare) {
  for (const TechniqueInfo& info : techniqueInfos()) {
    const auto of = [](const ParameterInfo& p) { return p.name == "auditShare"; };
    EXPECT_EQ(std::count_if(info.parameters.begin(), info.parameters.end(), of), info.biased ? 1 : 0) << info.name;
  }
}

}  // namespace
}  // namespace limn
