// The benchmark's arithmetic on made-up numbers whose answer is known.
#include "server/limn/bench_statistics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "server/limn/bench_growth.hpp"
#include "server/limn/bench_page.hpp"
#include "server/limn/bench_plots.hpp"

namespace limn::bench {
namespace {

using When = TimeToError::When;

TEST(BenchStatistics, MeanDeviationAndMedian) {
  const std::vector<double> values = {1.0, 2.0, 3.0, 6.0};
  EXPECT_DOUBLE_EQ(meanOf(values), 3.0);
  EXPECT_DOUBLE_EQ(deviationOf(values), std::sqrt(14.0 / 3.0));
  EXPECT_DOUBLE_EQ(medianOf({9.0, 1.0, 5.0}), 5.0);
  EXPECT_DOUBLE_EQ(medianOf(values), 2.5);
  EXPECT_TRUE(std::isnan(medianOf({})));
  EXPECT_EQ(deviationOf(std::vector<double>{4.0}), 0.0);
}

TEST(BenchStatistics, TimeToErrorIsExactOnAPowerLaw) {
  // error = 0.08 / t, so 0.01 is reached at 8 s and 0.003 at 26.67 s.
  std::vector<TimedError> curve;
  for (const double t : {1.0, 3.0, 10.0, 100.0}) curve.push_back({t, 0.08 / t});
  const TimeToError hundredth = timeToError(curve, 0.01), three = timeToError(curve, 0.003);
  EXPECT_EQ(hundredth.when, When::at);
  EXPECT_NEAR(hundredth.seconds, 8.0, 1e-12);
  EXPECT_NEAR(three.seconds, 0.08 / 0.003, 1e-9);
}

TEST(BenchStatistics, TimeToErrorSaysWhenItCannotTell) {
  const std::vector<TimedError> curve = {{0.5, 0.05}, {1.0, 0.02}, {2.0, 0.03}, {4.0, 0.01}};
  EXPECT_EQ(timeToError(curve, 0.1).when, When::atOrBefore);
  EXPECT_DOUBLE_EQ(timeToError(curve, 0.1).seconds, 0.5);
  EXPECT_EQ(timeToError(curve, 0.001).when, When::never);
  EXPECT_DOUBLE_EQ(timeToError(curve, 0.001).seconds, 4.0);
  EXPECT_NEAR(timeToError(curve, 0.02).seconds, 1.0, 1e-12);  // the first time, though it rises again
  EXPECT_EQ(timeToError({}, 0.1).when, When::never);
}

TEST(BenchStatistics, FitFindsTheExponentAndItsUncertainty) {
  std::vector<Sample> samples;
  for (const double x : {1.0, 2.0, 5.0, 40.0}) samples.push_back({x, 3.0 * std::pow(x, -1.25)});
  const std::optional<PowerFit> exact = fitPower(samples);
  ASSERT_TRUE(exact);
  EXPECT_NEAR(exact->exponent, -1.25, 1e-12);
  EXPECT_NEAR(exact->factor, 3.0, 1e-12);
  EXPECT_NEAR(exact->exponentDeviation, 0.0, 1e-12);

  // ln y = {0, 1, 0} over ln x = {0, 1, 2}: slope 0, residual sum 2/3, sum of squares of x 2.
  const double e = std::exp(1.0);
  const std::optional<PowerFit> bent = fitPower(std::vector<Sample>{{1.0, 1.0}, {e, e}, {e * e, 1.0}});
  ASSERT_TRUE(bent);
  EXPECT_NEAR(bent->exponent, 0.0, 1e-12);
  EXPECT_NEAR(bent->exponentDeviation, std::sqrt(1.0 / 3.0), 1e-12);
}

TEST(BenchStatistics, FitNeedsTwoDifferentPlacesAndPositiveNumbers) {
  EXPECT_FALSE(fitPower(std::vector<Sample>{{2.0, 1.0}, {2.0, 3.0}}));
  EXPECT_FALSE(fitPower(std::vector<Sample>{{1.0, 1.0}, {0.0, 2.0}, {3.0, 0.0}, {4.0, -1.0}, {5.0, INFINITY}}));
  EXPECT_FALSE(fitPower({}));
}

/// A picture that is 1 everywhere in truth, seen with a constant error and Gaussian noise.
RadianceImage noisyPicture(uint32_t seed, double bias, double deviation, uint32_t side = 64) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(bias, deviation);
  RadianceImage picture{side, side, {}};
  for (size_t i = 0; i < size_t(side) * side * 3; ++i) picture.values.push_back(float(1.0 + noise(random)));
  return picture;
}

TEST(BenchStatistics, SplitTellsNoiseFromBias) {
  const double bias = 0.1, deviation = 0.2, denominator = 1.01;
  const RadianceImage truth = noisyPicture(0, 0.0, 0.0);
  std::vector<RadianceImage> pictures;
  std::vector<RadianceView> views;
  for (uint32_t seed = 1; seed <= 4; ++seed) pictures.push_back(noisyPicture(seed, bias, deviation));
  for (const RadianceImage& picture : pictures) views.push_back(picture.view());
  const Result<std::optional<ErrorParts>> split = splitError(views, {truth.view(), {}, {}});
  ASSERT_TRUE(split && *split);
  const ErrorParts& parts = **split;
  // 12,288 values, 4 pictures: the variance is known to 1 %, the bias to 2 %; the cut takes under 1.5 %.
  EXPECT_NEAR(parts.noise, deviation * deviation / denominator, 0.04 * 0.04);
  EXPECT_NEAR(parts.biasSquared, bias * bias / denominator, 0.0006);
  EXPECT_NEAR(parts.total, parts.noise + parts.biasSquared, 1e-9);
  EXPECT_LT(parts.biasDeviation, 0.0005);
  EXPECT_GT(parts.biasDeviation, 0.0);
}

TEST(BenchStatistics, SplitOfAnUnbiasedPictureHasNoBiasWithinItsUncertainty) {
  const RadianceImage half0 = noisyPicture(101, 0.0, 0.1), half1 = noisyPicture(102, 0.0, 0.1);
  RadianceImage mean = half0;
  for (size_t i = 0; i < mean.values.size(); ++i) mean.values[i] = 0.5f * (half0.values[i] + half1.values[i]);
  const RadianceImage a = noisyPicture(1, 0.0, 0.2), b = noisyPicture(2, 0.0, 0.2);
  const std::vector<RadianceView> views = {a.view(), b.view()};
  // The reference itself is noisy: only its halves make that harmless.
  const auto split = splitError(views, {mean.view(), half0.view(), half1.view()});
  ASSERT_TRUE(split && *split);
  EXPECT_LT(std::abs((*split)->biasSquared), 4.0 * (*split)->biasDeviation);
  const auto naive = splitError(views, {mean.view(), {}, {}});
  ASSERT_TRUE(naive && *naive);
  EXPECT_NEAR((*naive)->biasSquared, 0.005, 0.001);  // the reference's own variance, taken for bias
}

TEST(BenchStatistics, SplitNeedsTwoPicturesOfTheReferencesSize) {
  const RadianceImage one = noisyPicture(1, 0.0, 0.1), other = noisyPicture(2, 0.0, 0.1, 32);
  const std::vector<RadianceView> single = {one.view()}, mixed = {one.view(), other.view()};
  const auto split = splitError(single, {one.view(), {}, {}});
  ASSERT_TRUE(split.ok());
  EXPECT_FALSE(*split);
  const auto refused = splitError(mixed, {one.view(), {}, {}});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, "size");
}

TEST(BenchStatistics, CalibrationCountsWhatCanBeJudged) {
  const std::vector<EstimateCheck> checks = {{1.0, 0.8, 1.2, 1.1},  // held, ratio 0.909
                                             {2.0, 1.8, 2.2, 1.0},  // not held, ratio 2
                                             {3.0, 1.0, 5.0, 2.0},  // held, ratio 1.5
                                             {INFINITY, 0.0, INFINITY, 1.0},
                                             {1.0, 0.5, 1.5, 0.0}};
  const Calibration result = calibrate(checks);
  EXPECT_EQ(result.count, 3u);
  EXPECT_DOUBLE_EQ(result.heldShare, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(result.medianRatio, 1.5);
  EXPECT_EQ(calibrate({}).count, 0u);
}

TEST(BenchResults, OnlyErrorsWellOverTheReferencesNoiseJudgeTheEstimate) {
  SceneResult scene;
  scene.referenceNoise = 0.01;
  bench::Run run;
  run.technique = "made-up";
  for (const double truth : {0.2, 0.051, 0.049}) {
    Checkpoint checkpoint;
    checkpoint.relMse = checkpoint.relMseAll = truth;
    checkpoint.estimate = 2.0 * truth;
    checkpoint.low = 0.9 * truth;
    checkpoint.high = 3.0 * truth;
    run.checkpoints.push_back(checkpoint);
  }
  scene.runs.push_back(run);
  const std::vector<TechniqueCalibration> calibrations = calibrateAll({scene});
  ASSERT_EQ(calibrations.size(), 1u);
  EXPECT_EQ(calibrations[0].trimmed.count, 2u);
  EXPECT_EQ(calibrations[0].leftOut, 1u);
  EXPECT_DOUBLE_EQ(calibrations[0].trimmed.heldShare, 1.0);
  EXPECT_DOUBLE_EQ(calibrations[0].trimmed.medianRatio, 2.0);
}

TEST(BenchResults, ACurveLeavesCoarsePicturesOutOfItsSlope) {
  Curve curve;
  for (const double samples : {0.5, 2.0, 8.0, 32.0, 128.0}) {
    CurvePoint point;
    point.seconds = point.samples = samples;
    point.gatheredShare = std::min(1.0, samples);
    // Under four samples the curve is anything; from there on it is 1/n.
    point.relMse = point.relMseAll = samples < 4.0 ? 5.0 : 1.0 / samples;
    curve.points.push_back(point);
  }
  finishCurve(curve);
  ASSERT_TRUE(curve.slope);
  EXPECT_NEAR(curve.slope->exponent, -1.0, 1e-12);
  ASSERT_EQ(curve.times.size(), std::size(kErrorLevels));
  EXPECT_NEAR(curve.times[1].seconds, 1.0 / 0.03, 1e-9);
  EXPECT_EQ(curve.times[4].when, When::never);
}

TEST(BenchPictures, MissingPixelsTakeTheCornerOfTheirSmallestCellWithSamples) {
  RadianceImage picture{8, 4, std::vector<float>(8 * 4 * 3, 0.0f)};
  std::vector<float> samples(8 * 4, 0.0f);
  const auto put = [&](uint32_t x, uint32_t y, float value) {
    samples[y * 8 + x] = 1.0f;
    for (size_t c = 0; c < 3; ++c) picture.values[(y * 8 + x) * 3 + c] = value;
  };
  put(0, 0, 8.0f);
  put(4, 0, 4.0f);
  put(6, 2, 2.0f);
  fillMissing(picture, samples);
  const auto at = [&](uint32_t x, uint32_t y) { return picture.values[(y * 8 + x) * 3]; };
  EXPECT_EQ(at(3, 3), 8.0f);
  EXPECT_EQ(at(5, 3), 4.0f);
  EXPECT_EQ(at(7, 3), 2.0f);
  EXPECT_EQ(at(4, 0), 4.0f);
}

TEST(BenchPictures, Base64AsInRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(BenchPlots, TitlesCannotLeaveTheirQuotes) {
  const Plot plot{"name", "it's", "x", "y", {{"a'b", {{1.0, 2.0}}}}};
  const std::string script = gnuplotScript(plot, "out");
  EXPECT_THAT(script, ::testing::HasSubstr("'it''s'"));
  EXPECT_THAT(script, ::testing::HasSubstr("'a''b'"));
  EXPECT_THAT(script, ::testing::HasSubstr("1 2\nEOD"));
}

TEST(BenchGrowth, MadeScenesHaveTheSizesThatWereAsked) {
  for (const uint32_t triangles : {2u, 10'000u, 99'458u}) {
    const LoadedScene made = growthScene(triangles, 7);
    EXPECT_NEAR(double(made.report.triangles), triangles, 0.02 * triangles + 1.0);
    EXPECT_EQ(made.scene.lights.size(), 7u);
    double power = 0.0;
    for (const Light& light : made.scene.lights) power += light.intensity;
    EXPECT_NEAR(power, 60.0, 1e-4);
  }
}

}  // namespace
}  // namespace limn::bench
