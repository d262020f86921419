#include "server/limn/bench_slope.hpp"

#include <array>
#include <cmath>

#include "server/limn/bench_statistics.hpp"

namespace limn::bench {
namespace {

/// Standard error of a statistic of n seeds: sqrt((n-1)/n * sum of squares of its n values without one seed each).
double jackknifeDeviation(std::span<const double> withoutOne) {
  const double n = double(withoutOne.size());
  return deviationOf(withoutOne) * (n - 1.0) / std::sqrt(n);
}

/// Means over seeds, without seed `left` when it is one of them.
std::vector<double> meansWithout(std::span<const std::vector<double>> ofSeed, size_t left) {
  std::vector<double> means(ofSeed[0].size());
  for (size_t i = 0; i < means.size(); ++i) {
    std::vector<double> values;
    for (size_t seed = 0; seed < ofSeed.size(); ++seed)
      if (seed != left) values.push_back(ofSeed[seed][i]);
    means[i] = meanOf(values);
  }
  return means;
}

std::optional<double> exponentOf(std::span<const double> x, const std::vector<double>& y) {
  std::vector<Sample> samples;
  for (size_t i = 0; i < x.size(); ++i) samples.push_back({x[i], y[i]});
  const std::optional<PowerFit> fit = fitPower(samples);
  return fit ? std::optional(fit->exponent) : std::nullopt;
}

/// Means of all pictures but one, which are dealt to two halves in turn.
std::array<RadianceImage, 2> halvesOfOthers(std::span<const RadianceView> pictures, size_t own) {
  const size_t values = pictures[own].values.size();
  std::array<std::vector<double>, 2> sums = {std::vector<double>(values), std::vector<double>(values)};
  std::array<double, 2> counts = {};
  size_t half = 0;
  for (size_t other = 0; other < pictures.size(); ++other) {
    if (other == own) continue;
    for (size_t i = 0; i < values; ++i) sums[half][i] += pictures[other].values[i];
    ++counts[half];
    half = 1 - half;
  }
  std::array<RadianceImage, 2> halves;
  for (size_t h = 0; h < 2; ++h) {
    halves[h] = {pictures[own].width, pictures[own].height, {}};
    for (const double sum : sums[h]) halves[h].values.push_back(float(sum / counts[h]));
  }
  return halves;
}

}  // namespace

std::vector<RadianceImage> blockMeans(std::span<const RunningMean> run, uint64_t samples) {
  std::vector<RadianceImage> blocks;
  const RunningMean* before = nullptr;
  for (const RunningMean& mean : run) {
    if (mean.samples % samples != 0) continue;
    RadianceImage block = mean.picture;
    if (before)
      for (size_t i = 0; i < block.values.size(); ++i)
        block.values[i] = float((double(mean.samples) * mean.picture.values[i] -
                                 double(before->samples) * before->picture.values[i]) / double(samples));
    blocks.push_back(std::move(block));
    before = &mean;
  }
  return blocks;
}

std::optional<Slope> slopeOfSeeds(std::span<const double> x, std::span<const std::vector<double>> ofSeed) {
  if (ofSeed.size() < 2) return {};
  const std::optional<double> exponent = exponentOf(x, meansWithout(ofSeed, ofSeed.size()));
  if (!exponent) return {};
  std::vector<double> withoutOne;
  for (size_t left = 0; left < ofSeed.size(); ++left)
    if (const std::optional<double> other = exponentOf(x, meansWithout(ofSeed, left))) withoutOne.push_back(*other);
  return Slope{*exponent, jackknifeDeviation(withoutOne)};
}

SlopeVerdict judgeSlope(const Slope& slope) {
  const double allowed = kSlopeTolerance + slope.deviation;
  if (slope.exponent < -1.0 - allowed) return SlopeVerdict::steeper;
  return slope.exponent > -1.0 + allowed ? SlopeVerdict::flatter : SlopeVerdict::met;
}

const char* verdictName(SlopeVerdict verdict) {
  switch (verdict) {
    case SlopeVerdict::met: return "met";
    case SlopeVerdict::steeper: return "steeper";
    case SlopeVerdict::flatter: return "flatter";
  }
  return "";
}

Result<std::optional<SeedSpread>> spreadOfSeeds(std::span<const RadianceView> pictures,
                                                std::span<const double> estimates, const Reference& reference) {
  const double n = double(pictures.size()), told = meanOf(estimates);
  if (pictures.size() < 3 || !(told > 0.0) || !std::isfinite(told)) return std::optional<SeedSpread>();
  // Against two halves of the others, a bright path of one picture is in one factor alone: its square counts in its own
  // picture, where it may be cut off, and in no other.
  std::vector<double> between, withoutOne;
  for (size_t seed = 0; seed < pictures.size(); ++seed) {
    const std::array<RadianceImage, 2> others = halvesOfOthers(pictures, seed);
    const Result<ErrorMetrics> metrics =
        compareImages(pictures[seed], {reference.mean, others[0].view(), others[1].view()});
    if (!metrics) return metrics.error();
    between.push_back(metrics->relMse);
  }
  SeedSpread spread{meanOf(between), told, 0.0};
  for (size_t left = 0; left < pictures.size(); ++left)
    withoutOne.push_back((n * spread.between - between[left]) / (n * told - estimates[left]));
  spread.deviation = jackknifeDeviation(withoutOne);
  return std::optional(spread);
}

}  // namespace limn::bench
