#include "server/limn/bench_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace limn::bench {
namespace {

RadianceImage meanPicture(std::span<const RadianceView> pictures) {
  RadianceImage mean{pictures[0].width, pictures[0].height, {}};
  std::vector<double> sum(pictures[0].values.size());
  for (const RadianceView& picture : pictures)
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += picture.values[i];
  for (const double value : sum) mean.values.push_back(float(value / double(pictures.size())));
  return mean;
}

/// Indices of the values that count: without the largest means over seeds.
std::vector<size_t> keptValues(const std::vector<std::vector<double>>& ofSeed) {
  const size_t count = ofSeed[0].size();
  std::vector<double> size(count);
  for (const std::vector<double>& quotients : ofSeed)
    for (size_t i = 0; i < count; ++i) size[i] += std::abs(quotients[i]);
  std::vector<size_t> order(count);
  std::iota(order.begin(), order.end(), size_t(0));
  const size_t kept = std::max<size_t>(1, count - size_t(std::floor(kDiscardedShare * double(count))));
  std::nth_element(order.begin(), order.begin() + std::ptrdiff_t(kept) - 1, order.end(),
                   [&](size_t a, size_t b) { return size[a] < size[b]; });
  order.resize(kept);
  return order;
}

/// Variance between the pictures at value i, over the denominator of relMSE.
double relativeVariance(std::span<const RadianceView> pictures, const RadianceImage& mean, double denominator,
                        size_t i) {
  double squares = 0.0;
  for (const RadianceView& picture : pictures) {
    const double difference = double(picture.values[i]) - double(mean.values[i]);
    squares += difference * difference;
  }
  return squares == 0.0 ? 0.0 : squares / double(pictures.size() - 1) / denominator;
}

}  // namespace

double meanOf(std::span<const double> values) {
  return values.empty() ? 0.0 : std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double deviationOf(std::span<const double> values) {
  if (values.size() < 2) return 0.0;
  const double mean = meanOf(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / double(values.size() - 1));
}

double medianOf(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

TimeToError timeToError(std::span<const TimedError> curve, double error) {
  using When = TimeToError::When;
  if (curve.empty()) return {};
  if (curve[0].error <= error) return {When::atOrBefore, curve[0].seconds};
  for (size_t i = 1; i < curve.size(); ++i) {
    if (curve[i].error > error) continue;
    const TimedError &above = curve[i - 1], &below = curve[i];
    const double share = std::log(above.error / error) / std::log(above.error / below.error);
    return {When::at, above.seconds * std::pow(below.seconds / above.seconds, share)};
  }
  return {When::never, curve.back().seconds};
}

std::optional<PowerFit> fitPower(std::span<const Sample> samples) {
  std::vector<double> x, y;
  for (const Sample& sample : samples) {
    if (!(sample.x > 0.0) || !(sample.y > 0.0) || !std::isfinite(sample.x) || !std::isfinite(sample.y)) continue;
    x.push_back(std::log(sample.x));
    y.push_back(std::log(sample.y));
  }
  const double meanX = meanOf(x), meanY = meanOf(y);
  double xx = 0.0, xy = 0.0, residuals = 0.0;
  for (size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - meanX) * (x[i] - meanX);
    xy += (x[i] - meanX) * (y[i] - meanY);
  }
  if (!(xx > 0.0)) return {};
  PowerFit fit;
  fit.exponent = xy / xx;
  fit.factor = std::exp(meanY - fit.exponent * meanX);
  for (size_t i = 0; i < x.size(); ++i) {
    const double residual = y[i] - meanY - fit.exponent * (x[i] - meanX);
    residuals += residual * residual;
  }
  if (x.size() > 2) fit.exponentDeviation = std::sqrt(residuals / double(x.size() - 2) / xx);
  return fit;
}

Result<std::optional<ErrorParts>> splitError(std::span<const RadianceView> pictures, const Reference& reference) {
  if (pictures.size() < 2) return std::optional<ErrorParts>();
  std::vector<std::vector<double>> ofSeed;
  for (const RadianceView& picture : pictures) {
    Result<std::vector<double>> quotients = relativeSquares(picture, reference);
    if (!quotients) return quotients.error();
    ofSeed.push_back(quotients.take());
  }
  const RadianceImage mean = meanPicture(pictures);
  const Result<std::vector<double>> ofMean = relativeSquares(mean.view(), reference);
  if (!ofMean) return ofMean.error();

  const std::vector<double> denominators = relativeDenominators(reference);
  const double n = double(pictures.size());
  const std::vector<size_t> kept = keptValues(ofSeed);
  ErrorParts parts;
  std::vector<double> biasOfPixel(mean.values.size() / 3);  // channels err together, pixels hardly
  for (const size_t i : kept) {
    for (const std::vector<double>& quotients : ofSeed) parts.total += quotients[i] / n;
    const double noise = relativeVariance(pictures, mean, denominators[i], i);
    parts.noise += noise;
    biasOfPixel[i / 3] += (*ofMean)[i] - noise / n;
  }
  const double count = double(kept.size()), pixels = double(biasOfPixel.size());
  parts.total /= count;
  parts.noise /= count;
  parts.biasSquared = meanOf(biasOfPixel) * pixels / count;
  parts.biasDeviation = deviationOf(biasOfPixel) * std::sqrt(pixels) / count;
  return std::optional(parts);
}

Calibration calibrate(std::span<const EstimateCheck> checks) {
  Calibration result;
  std::vector<double> ratios;
  size_t held = 0;
  for (const EstimateCheck& check : checks) {
    if (!(check.truth > 0.0) || !(check.estimate > 0.0) || !std::isfinite(check.estimate)) continue;
    ratios.push_back(check.estimate / check.truth);
    held += check.low <= check.truth && check.truth <= check.high ? 1 : 0;
  }
  result.count = ratios.size();
  if (ratios.empty()) return result;
  result.heldShare = double(held) / double(result.count);
  result.medianRatio = medianOf(std::move(ratios));
  return result;
}

}  // namespace limn::bench
