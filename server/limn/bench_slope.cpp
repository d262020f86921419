#include "server/limn/bench_slope.hpp"

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

/// sum[i] over the pictures.
std::vector<double> sumOf(std::span<const RadianceView> pictures) {
  std::vector<double> sum(pictures[0].values.size());
  for (const RadianceView& picture : pictures)
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += picture.values[i];
  return sum;
}

/// relMSE of a picture against the mean of n pictures, of which it is one, as if that mean were the truth. The mean has
/// moved towards the picture: the difference from it has only (n-1)/n of the variance.
double errorAgainstMean(const RadianceView& picture, const std::vector<double>& sum, double n,
                        const std::vector<double>& denominators) {
  std::vector<double> quotients(denominators.size());
  for (size_t i = 0; i < quotients.size(); ++i) {
    const double difference = picture.values[i] - sum[i] / n;
    if (difference != 0.0) quotients[i] = difference * difference / denominators[i] * n / (n - 1.0);
  }
  return trimmedMean(std::move(quotients), kDiscardedShare);
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
  for (const RadianceView& picture : pictures)
    if (const auto checked = relativeSquares(picture, reference); !checked) return checked.error();
  const std::vector<double> denominators = relativeDenominators(reference), sum = sumOf(pictures);
  std::vector<double> between, withoutOne;
  for (const RadianceView& picture : pictures) between.push_back(errorAgainstMean(picture, sum, n, denominators));
  // The mean of all stays what the differences are taken from: its own doubt is 1/n of theirs.
  SeedSpread spread{meanOf(between), told, 0.0};
  for (size_t left = 0; left < pictures.size(); ++left)
    withoutOne.push_back((n * spread.between - between[left]) / (n * told - estimates[left]));
  spread.deviation = jackknifeDeviation(withoutOne);
  return std::optional(spread);
}

}  // namespace limn::bench
