#include "renderer/film/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace limn {
namespace {

struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<float> values;
  RadianceView view() const { return {width, height, values}; }
};

Picture constant(uint32_t width, uint32_t height, float value) {
  return {width, height, std::vector<float>(size_t(width) * height * 3, value)};
}

Picture withNoise(const Picture& truth, double deviation, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, deviation);
  Picture picture = truth;
  for (float& v : picture.values) v = float(v + noise(random));
  return picture;
}

Picture gradient(uint32_t side) {
  Picture picture = constant(side, side, 0.0f);
  for (size_t i = 0; i < picture.values.size(); ++i) picture.values[i] = 0.5f + float(i) / float(picture.values.size());
  return picture;
}

TEST(Compare, ConstantPicturesHaveClosedForms) {
  const Picture a = constant(8, 8, 3.0f), r = constant(8, 8, 2.0f);
  const ErrorMetrics metrics = compareImages(a.view(), {r.view(), {}, {}}).value();
  EXPECT_NEAR(metrics.relMse, 1.0 / (4.0 + 0.01 * 4.0), 1e-12);
  EXPECT_NEAR(metrics.relMseAll, metrics.relMse, 1e-12);
  EXPECT_NEAR(metrics.rmse, 1.0, 1e-12);
  EXPECT_NEAR(metrics.mape.value(), 1.0 / (2.0 + 0.01 * 2.0), 1e-12);
  EXPECT_NEAR(metrics.psnr, 10.0 * std::log10(4.0), 1e-12);
  EXPECT_EQ(metrics.nonFinite, 0u);
}

TEST(Compare, TheDenominatorUsesTheMeanOfAllPixelsAndChannels) {
  Picture r = constant(2, 1, 0.0f), a = constant(2, 1, 0.0f);
  r.values = {1, 2, 3, 4, 5, 9};
  a.values = {1, 2, 3, 4, 5, 6};
  const ErrorMetrics metrics = compareImages(a.view(), {r.view(), {}, {}}).value();
  EXPECT_NEAR(metrics.relMseAll, 9.0 / (81.0 + 0.01 * 16.0) / 6.0, 1e-12);
}

TEST(Compare, EqualPicturesHaveNoErrorEvenWhenBlack) {
  const Picture black = constant(4, 4, 0.0f);
  const ErrorMetrics metrics = compareImages(black.view(), {black.view(), {}, {}}).value();
  EXPECT_EQ(metrics.relMse, 0.0);
  EXPECT_EQ(metrics.mape.value(), 0.0);
  EXPECT_TRUE(std::isinf(metrics.psnr));
}

TEST(Compare, RelMseDoesNotDependOnTheUnit) {
  const Picture r = gradient(32), a = withNoise(r, 0.1, 3);
  Picture r8 = r, a8 = a;
  for (float& v : r8.values) v *= 8.0f;
  for (float& v : a8.values) v *= 8.0f;
  const double here = compareImages(a.view(), {r.view(), {}, {}})->relMse;
  EXPECT_NEAR(compareImages(a8.view(), {r8.view(), {}, {}})->relMse, here, 1e-12 * here);
}

TEST(Compare, ExactlyAThousandthIsDiscarded) {
  // 100 x 100 x 3 = 30000 values: 30 fireflies vanish, the 31st stays.
  const Picture r = constant(100, 100, 1.0f);
  Picture a = constant(100, 100, 1.5f);
  const double base = 0.25 / 1.01, firefly = 999.0 * 999.0 / 1.01;
  for (size_t i = 0; i < 30; ++i) a.values[i * 7] = 1000.0f;
  ErrorMetrics metrics = compareImages(a.view(), {r.view(), {}, {}}).value();
  EXPECT_NEAR(metrics.relMse, base, 1e-9);
  EXPECT_NEAR(metrics.relMseAll, (29970.0 * base + 30.0 * firefly) / 30000.0, 1e-6);
  a.values[29999] = 1000.0f;
  metrics = compareImages(a.view(), {r.view(), {}, {}}).value();
  EXPECT_NEAR(metrics.relMse, (29969.0 * base + firefly) / 29970.0, 1e-6);
}

TEST(Compare, AFewNonFiniteValuesAreCountedAndDiscarded) {
  const Picture r = constant(100, 100, 1.0f);
  Picture a = constant(100, 100, 2.0f);
  a.values[5] = std::numeric_limits<float>::quiet_NaN();
  a.values[6] = -std::numeric_limits<float>::infinity();
  const ErrorMetrics metrics = compareImages(a.view(), {r.view(), {}, {}}).value();
  EXPECT_EQ(metrics.nonFinite, 2u);
  EXPECT_NEAR(metrics.relMse, 1.0 / 1.01, 1e-9);
  EXPECT_TRUE(std::isinf(metrics.relMseAll));
  EXPECT_TRUE(std::isinf(metrics.rmse));
}

TEST(Compare, SizesAndReferencesAreChecked) {
  const Picture a = constant(4, 4, 1.0f), other = constant(4, 5, 1.0f);
  EXPECT_EQ(compareImages(a.view(), {other.view(), {}, {}}).error().code, "size");
  EXPECT_EQ(compareImages(a.view(), {a.view(), a.view(), other.view()}).error().code, "size");
  Picture broken = a;
  broken.values[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(compareImages(a.view(), {broken.view(), {}, {}}).error().code, "bad-image");
  EXPECT_EQ(compareLow(a.view(), {a.view(), a.view(), broken.view()}).error().code, "bad-image");
}

TEST(Compare, HalvesRemoveTheReferencesOwnNoise) {
  const double own = 0.05, reference = 0.2;
  const Picture truth = gradient(256);
  const Picture h0 = withNoise(truth, reference, 11), h1 = withNoise(truth, reference, 12);
  const Picture a = withNoise(truth, own, 13);
  Picture mean = truth;
  for (size_t i = 0; i < mean.values.size(); ++i) mean.values[i] = 0.5f * (h0.values[i] + h1.values[i]);

  const ErrorMetrics plain = compareImages(a.view(), {mean.view(), {}, {}}).value();
  const ErrorMetrics halves = compareImages(a.view(), {mean.view(), h0.view(), h1.view()}).value();
  // The plain mean square is own² + reference²/2; the product's is own², with a standard deviation of
  // sqrt((own² + reference²)² + own⁴)/sqrt(N), N = 196608, that is 1e-4.
  EXPECT_NEAR(plain.rmse * plain.rmse, own * own + reference * reference / 2.0, 5e-4);
  EXPECT_NEAR(halves.rmse * halves.rmse, own * own, 5e-4);
  EXPECT_FALSE(halves.mape.has_value());
}

TEST(Compare, ThePictureOfTheTruthHasNoErrorAgainstHalves) {
  const Picture truth = gradient(256);
  const Picture h0 = withNoise(truth, 0.3, 21), h1 = withNoise(truth, 0.3, 22);
  const ErrorMetrics metrics = compareImages(truth.view(), {truth.view(), h0.view(), h1.view()}).value();
  // sd of the mean: 0.09 / (r² near 1) / sqrt(196608) = 2e-4, a few times that for the dark end.
  EXPECT_NEAR(metrics.relMseAll, 0.0, 2e-3);
}

TEST(Compare, TrimmingKeepsAtLeastOneValueAndGoesByMagnitude) {
  EXPECT_EQ(trimmedMean({4.0}, 0.9), 4.0);
  EXPECT_EQ(trimmedMean({1.0, -100.0, 3.0, 2.0}, 0.25), 2.0);
  EXPECT_EQ(trimmedMean({1.0, 2.0, 3.0, 6.0}, 0.0), 3.0);
}

TEST(Compare, BlocksAverageAndTheLastOnesMayBeSmaller) {
  Picture picture = constant(5, 3, 0.0f);
  for (uint32_t y = 0; y < 3; ++y)
    for (uint32_t x = 0; x < 5; ++x)
      for (uint32_t c = 0; c < 3; ++c) picture.values[(y * 5 + x) * 3 + c] = float(100 * c + 10 * y + x);
  const RadianceImage low = averageBlocks(picture.view(), 2);
  ASSERT_EQ(low.width, 3u);
  ASSERT_EQ(low.height, 2u);
  EXPECT_FLOAT_EQ(low.values[0], (0 + 1 + 10 + 11) / 4.0f);
  EXPECT_FLOAT_EQ(low.values[1], 100 + (0 + 1 + 10 + 11) / 4.0f);
  EXPECT_FLOAT_EQ(low.values[2 * 3], (4 + 14) / 2.0f);
  EXPECT_FLOAT_EQ(low.values[5 * 3], 24.0f);
}

TEST(Compare, LowForgetsNoiseAndKeepsBias) {
  const Picture truth = constant(256, 256, 1.0f);
  const Picture noisy = withNoise(truth, 0.5, 31);
  Picture biased = truth;
  for (float& v : biased.values) v = 1.1f;
  const Reference reference{truth.view(), {}, {}};
  EXPECT_NEAR(compareImages(noisy.view(), reference)->relMseAll, 0.25 / 1.01, 0.01);
  EXPECT_NEAR(compareLow(noisy.view(), reference)->relMseAll, 0.25 / 1.01 / 256.0, 2e-4);
  EXPECT_NEAR(compareLow(biased.view(), reference)->relMseAll, 0.01 / 1.01, 1e-6);
}

double relativeLuminance(const std::array<uint8_t, 3>& color) {
  const double weights[3] = {0.2126, 0.7152, 0.0722};
  double sum = 0.0;
  for (size_t c = 0; c < 3; ++c) {
    const double s = color[c] / 255.0;
    sum += weights[c] * (s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
  }
  return sum;
}

TEST(Heatmap, LuminanceRisesAllTheWay) {
  double before = -1.0;
  for (int i = 0; i <= 64; ++i) {
    const double luminance = relativeLuminance(heatColor(i / 64.0));
    EXPECT_GT(luminance, before) << "step " << i;
    before = luminance;
  }
  EXPECT_LT(relativeLuminance(heatColor(0.0)), 0.005);
  EXPECT_GT(before, 0.8);
}

TEST(Heatmap, LargerErrorsAreLighterAndBothEndsAreClamped) {
  const std::vector<double> quotients = {0, 0, 0, 1e-4, 1e-4, 1e-4, 1e-2, 1e-2, 1e-2, -1, -1, -1, 10, 10, 10,
                                         std::numeric_limits<double>::infinity(), 0, 0};
  const std::vector<uint8_t> rgba = errorHeatmap(3, 2, quotients);
  ASSERT_EQ(rgba.size(), 24u);
  const auto color = [&](size_t p) { return std::array<uint8_t, 3>{rgba[p * 4], rgba[p * 4 + 1], rgba[p * 4 + 2]}; };
  EXPECT_EQ(color(0), color(1));
  EXPECT_LT(relativeLuminance(color(1)), relativeLuminance(color(2)));
  EXPECT_LT(relativeLuminance(color(2)), relativeLuminance(color(3)));
  EXPECT_LT(relativeLuminance(color(3)), relativeLuminance(color(4)));
  EXPECT_EQ(color(4), color(5));
  EXPECT_EQ(rgba[3], 255);
}

}  // namespace
}  // namespace limn
