// Slope and spread over seeds, on made-up pictures whose answer is known.
#include "server/limn/bench_slope.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "server/limn/bench_figures.hpp"
#include "server/limn/bench_page_parts.hpp"
#include "server/limn/bench_plots.hpp"

namespace limn::bench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr uint32_t kSide = 32;

RadianceImage flat(float value) { return {kSide, kSide, std::vector<float>(size_t(kSide) * kSide * 3, value)}; }

/// Mean of n samples around 1 whose standard deviation is `deviation`.
RadianceImage meanOfSamples(std::mt19937& random, double deviation, double n) {
  std::normal_distribution<double> noise(1.0, deviation / std::sqrt(n));
  RadianceImage picture = flat(0.0f);
  for (float& value : picture.values) value = float(noise(random));
  return picture;
}

TEST(BenchSlope, BlocksAreTheMeansOfTheirOwnSamples) {
  // Four samples of 1, four of 5, eight of 3: running means 1, 3, (over 16) 3.
  std::vector<RunningMean> run = {{4, flat(1.0f)}, {8, flat(3.0f)}, {12, flat(3.0f)}, {16, flat(3.0f)}};
  const auto valuesOf = [&](uint64_t samples) {
    std::vector<float> values;
    for (const RadianceImage& block : blockMeans(run, samples)) values.push_back(block.values[7]);
    return values;
  };
  EXPECT_THAT(valuesOf(4), ElementsAre(1.0f, 5.0f, 3.0f, 3.0f));
  EXPECT_THAT(valuesOf(8), ElementsAre(3.0f, 3.0f));
  EXPECT_THAT(valuesOf(16), ElementsAre(3.0f));
  EXPECT_TRUE(blockMeans(run, 32).empty());
}

/// relMSE over one bright path of 1000 among the samples of a pixel that is black else: 1/n of it, at any block length.
TEST(BenchSlope, OneBrightPathHasSlopeMinusOneOverBlocks) {
  const uint64_t most = 64, met = 21;
  std::vector<RunningMean> run;
  for (uint64_t n = 4; n <= most; n += 4) run.push_back({n, flat(n > met ? 1000.0f / float(n) : 0.0f)});
  std::vector<double> samples;
  std::vector<std::vector<double>> ofSeed(2);
  for (uint64_t n = 4; n <= most; n *= 2) {
    const std::vector<RadianceImage> blocks = blockMeans(run, n);
    double square = 0.0;
    for (const RadianceImage& block : blocks) square += double(block.values[0]) * block.values[0];
    samples.push_back(double(n));
    for (std::vector<double>& errors : ofSeed) errors.push_back(square / double(blocks.size()));
  }
  const std::optional<Slope> slope = slopeOfSeeds(samples, ofSeed);
  ASSERT_TRUE(slope);
  EXPECT_NEAR(slope->exponent, -1.0, 1e-5);  // running means are of 24 bits
  EXPECT_NEAR(slope->deviation, 0.0, 1e-12);
}

TEST(BenchSlope, SlopeIsThatOfTheMeanOverSeedsWithItsJackknifedError) {
  const std::vector<double> x = {1.0, 4.0};
  const std::vector<std::vector<double>> ofSeed = {{4.0, 1.0}, {8.0, 1.0}, {12.0, 4.0}};
  const auto exponent = [](double first, double last) { return std::log(last / first) / std::log(4.0); };
  const std::optional<Slope> slope = slopeOfSeeds(x, ofSeed);
  ASSERT_TRUE(slope);
  EXPECT_NEAR(slope->exponent, exponent(24.0, 6.0), 1e-12);
  const double without[] = {exponent(20.0, 5.0), exponent(16.0, 5.0), exponent(12.0, 2.0)};
  const double mean = (without[0] + without[1] + without[2]) / 3.0;
  double squares = 0.0;
  for (const double value : without) squares += (value - mean) * (value - mean);
  EXPECT_NEAR(slope->deviation, std::sqrt(squares * 2.0 / 3.0), 1e-12);
  EXPECT_FALSE(slopeOfSeeds(x, std::vector<std::vector<double>>{{4.0, 1.0}}));
  EXPECT_FALSE(slopeOfSeeds(x, std::vector<std::vector<double>>{{4.0, 0.0}, {4.0, 0.0}}));
}

TEST(BenchSlope, VerdictAllowsOneStandardErrorBesideTheTolerance) {
  EXPECT_EQ(judgeSlope({-1.0, 0.0}), SlopeVerdict::met);
  EXPECT_EQ(judgeSlope({-0.94, 0.0}), SlopeVerdict::flatter);
  EXPECT_EQ(judgeSlope({-0.94, 0.02}), SlopeVerdict::met);
  EXPECT_EQ(judgeSlope({-1.2, 0.1}), SlopeVerdict::steeper);
  EXPECT_STREQ(verdictName(SlopeVerdict::steeper), "steeper");
}

TEST(BenchSpread, SeedsThatDifferByWhatTheySayHaveARatioOfOne) {
  std::mt19937 random(1);
  std::vector<RadianceImage> pictures;
  std::vector<RadianceView> views;
  for (int seed = 0; seed < 12; ++seed) pictures.push_back(meanOfSamples(random, 0.8, 16.0));
  for (const RadianceImage& picture : pictures) views.push_back(picture.view());
  const RadianceImage truth = flat(1.0f);
  const double told = 0.8 * 0.8 / 16.0 / 1.01;
  const auto spread = spreadOfSeeds(views, std::vector<double>(views.size(), told), {truth.view(), {}, {}});
  ASSERT_TRUE(spread && *spread);
  // 12 pictures of 3072 values: the variance is known to 1 %, and the cut takes as much.
  EXPECT_NEAR((*spread)->ratio(), 1.0, 0.05);
  EXPECT_GT((*spread)->deviation, 0.001);
  EXPECT_LT((*spread)->deviation, 0.05);
  const auto half = spreadOfSeeds(views, std::vector<double>(views.size(), 2.0 * told), {truth.view(), {}, {}});
  ASSERT_TRUE(half && *half);
  EXPECT_NEAR((*half)->ratio(), 0.5 * (*spread)->ratio(), 1e-12);
}

TEST(BenchSpread, ABrightPathOfOneSeedIsNoSpreadOfTheOthers) {
  std::mt19937 random(2);
  std::vector<RadianceImage> pictures;
  for (int seed = 0; seed < 12; ++seed) pictures.push_back(meanOfSamples(random, 0.8, 16.0));
  std::fill_n(pictures[4].values.begin() + 300, 3, 1000.0f);
  std::vector<RadianceView> views;
  for (const RadianceImage& picture : pictures) views.push_back(picture.view());
  const RadianceImage truth = flat(1.0f);
  const std::vector<double> told(views.size(), 0.8 * 0.8 / 16.0 / 1.01);
  const auto spread = spreadOfSeeds(views, told, {truth.view(), {}, {}});
  ASSERT_TRUE(spread && *spread);
  EXPECT_NEAR((*spread)->ratio(), 1.0, 0.05);
}

TEST(BenchSpread, NeedsThreePicturesOfTheReferencesSizeAndAnEstimate) {
  const RadianceImage one = flat(1.0f), two = flat(2.0f), small{1, 1, {1.0f, 1.0f, 1.0f}};
  const std::vector<RadianceView> pair = {one.view(), two.view()}, three = {one.view(), two.view(), one.view()};
  const auto few = spreadOfSeeds(pair, std::vector<double>{1.0, 1.0}, {one.view(), {}, {}});
  ASSERT_TRUE(few.ok());
  EXPECT_FALSE(*few);
  const auto untold = spreadOfSeeds(three, std::vector<double>{1.0, INFINITY, 1.0}, {one.view(), {}, {}});
  ASSERT_TRUE(untold.ok());
  EXPECT_FALSE(*untold);
  const auto refused = spreadOfSeeds(three, std::vector<double>{1.0, 1.0, 1.0}, {small.view(), {}, {}});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, "size");
}

BenchResults resultsWithConvergence() {
  Convergence convergence{"path-tracing", 8, {}, {}, {}};
  convergence.own = {{{4.0, 0.2, 0.4}, {8.0, 0.15, 0.2}}, Slope{-0.7, 0.02}, Slope{-1.2, 0.03}};
  convergence.independent = Convergence::Fall{{{4.0, 0.2, 0.4}, {8.0, 0.15, 0.3}}, {}, Slope{-1.01, 0.03}};
  convergence.spread = SeedSpread{0.019, 0.02, 0.04};
  SceneResult scene;
  scene.name = "room";
  scene.convergences = {convergence};
  BenchResults results;
  results.scenes = {scene};
  return results;
}

TEST(BenchConvergence, IsOnThePageInTheTablesAndInAPlot) {
  const BenchResults results = resultsWithConvergence();
  const std::string section = convergenceSection(results, "nowhere");
  EXPECT_THAT(section, HasSubstr("<td>room</td><td>path-tracing</td><td>8</td><td>0.4</td><td>0.2</td>"
                                 "<td>-1.010 ± 0.030</td><td>met</td><td>-1.200 ± 0.030</td><td>steeper</td>"
                                 "<td>1.50</td><td>-0.700 ± 0.020</td>"
                                 "<td>0.019</td><td>0.02</td><td>0.95 ± 0.04</td>"));
  EXPECT_EQ(convergenceSection({}, "nowhere"), "");
  EXPECT_THAT(resultsJson(results),
              HasSubstr("\"slopeAll\":{\"exponent\":-1.01,\"deviation\":0.03,\"verdict\":\"met\"}"));
  EXPECT_THAT(resultsJson(results), HasSubstr("\"exponent\":-1.2,\"deviation\":0.03,\"verdict\":\"steeper\""));
  EXPECT_THAT(resultsJson(results), HasSubstr("\"spreadRatio\":0.95"));
  const std::vector<Plot> plots = plotsOf(results);
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_EQ(plots[0].name, "convergence");
  EXPECT_EQ(plots[0].lines[0].points[1].y, 0.2);
}

TEST(BenchFigures, AreTheOnesThatAReadmeQuotes) {
  BenchResults results = resultsWithConvergence();
  results.options.budgets = {{"0.5", 0.5, 0}};
  Curve own, peer;
  own.technique = "path-tracing";
  own.points = {{"0.5", 0.5, 4.0, 4.0, 1.0, 0.0123, 0.02, 0.0, 0.0, {}}};
  peer.technique = "Somebody";
  peer.points = {{"peer", 2.5, 0.0, 0.0, 1.0, 0.5, 0.6, 0.0, 0.0, {}}};
  results.scenes[0].curves = {own, peer};
  results.scenes[0].ablations = {{"path-tracing", {0.25, 10.0}, {0.75, 12.0}}, {"other", {0.5, 1.0}, {0.45, 1.0}}};
  results.calibrations = {{"path-tracing", {110, 0.94, 0.96}, {}, 3}, {"other", {}, {}, 9}};
  results.hardCases = {{"dark box", "", "other", "leak", {0.5, 0.1, false}, {}, {}, {}, true, false, "it leaks"}};
  for (HardFigure HardCell::*figure : {&HardCell::energy, &HardCell::discarded, &HardCell::fireflies})
    results.hardCases[0].*figure = {0.0, 1.0, true};
  results.absent = {"The plots are absent."};
  const std::string text = resultsFigures(results);
  EXPECT_THAT(text, HasSubstr("| scene | technique | 0.5 s |\n|---|---|---|\n| room | path-tracing | 0.012 |\n"));
  EXPECT_THAT(text, HasSubstr("| room | Somebody | 0.5 at 2.5 s |\n"));
  EXPECT_THAT(text, HasSubstr("| room | path-tracing | 8 | -1.010 ± 0.030 | met | -1.200 ± 0.030 | steeper | 1.50 | 0.95 ± 0.04 |\n"));
  EXPECT_THAT(text, HasSubstr("| path-tracing | 110 | 3 | 94 % | 0.96 |\n| other | 0 | 9 | – | – |\n"));
  EXPECT_THAT(text, HasSubstr("0.90 times as long at least (room, other), 3.00 times at most (room, path-tracing)"));
  EXPECT_THAT(text, HasSubstr("0 of 1 cells keep every promise. The largest deviation for its bound: 0.5 of 0.1 leak"));
  EXPECT_THAT(text, HasSubstr("- dark box, other: leak 0.5 of 0.1, it leaks\n"));
  EXPECT_THAT(text, HasSubstr("\nThe plots are absent.\n"));
}

}  // namespace
}  // namespace limn::bench
