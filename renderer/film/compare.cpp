#include "renderer/film/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace limn {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDenominatorShare = 0.01;  // of the squared mean: keeps black pixels from deciding alone
constexpr uint32_t kLowBlock = 16;          // [pixel]

std::string sizeText(const RadianceView& view) {
  return std::to_string(view.width) + "x" + std::to_string(view.height);
}

double meanOf(std::span<const float> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

Result<void> check(const RadianceView& picture, const Reference& reference) {
  for (const std::optional<RadianceView>& view : {std::optional(reference.mean), reference.half0, reference.half1}) {
    if (!view) continue;
    if (picture.width != view->width || picture.height != view->height)
      return Error{"size", sizeText(picture) + " against a reference of " + sizeText(*view), ""};
    if (!std::all_of(view->values.begin(), view->values.end(), [](float v) { return std::isfinite(v); }))
      return Error{"bad-image", "the reference holds NaN or infinity", ""};
  }
  if (picture.values.empty()) return Error{"bad-image", "the picture is empty", ""};
  return {};
}

/// (a−r)², or its estimate from the halves; infinity for a value that is not finite.
double squareAt(const RadianceView& picture, const Reference& reference, size_t i) {
  const double a = picture.values[i];
  if (!std::isfinite(a)) return kInfinity;
  if (reference.half0 && reference.half1) return (a - reference.half0->values[i]) * (a - reference.half1->values[i]);
  const double difference = a - reference.mean.values[i];
  return difference * difference;
}

double quotient(double numerator, double denominator) { return numerator == 0.0 ? 0.0 : numerator / denominator; }

double meanAbsoluteShare(const RadianceView& picture, const RadianceView& reference) {
  const double floor = kDenominatorShare * meanOf(reference.values);
  double sum = 0.0;
  for (size_t i = 0; i < picture.values.size(); ++i) {
    const double a = picture.values[i], r = reference.values[i];
    sum += std::isfinite(a) ? quotient(std::abs(a - r), std::abs(r) + floor) : kInfinity;
  }
  return sum / double(picture.values.size());
}

}  // namespace

Result<RadianceView> radianceOf(const FilmImage& image, const std::string& place) {
  const FilmLayer* beauty = image.find("beauty");
  if (!beauty || beauty->channels != 3) return Error{"bad-image", "has no R, G and B channels", place};
  return RadianceView{image.width, image.height, beauty->data};
}

Result<std::vector<double>> relativeSquares(const RadianceView& picture, const Reference& reference) {
  if (Result<void> checked = check(picture, reference); !checked) return checked.error();
  std::vector<double> quotients = relativeDenominators(reference);
  for (size_t i = 0; i < quotients.size(); ++i) quotients[i] = quotient(squareAt(picture, reference, i), quotients[i]);
  return quotients;
}

std::vector<double> relativeDenominators(const Reference& reference) {
  const double mean = meanOf(reference.mean.values);
  std::vector<double> denominators;
  denominators.reserve(reference.mean.values.size());
  for (const double r : reference.mean.values) denominators.push_back(r * r + kDenominatorShare * mean * mean);
  return denominators;
}

double trimmedMean(std::vector<double> values, double discardedShare) {
  const size_t discarded = std::min(size_t(std::floor(discardedShare * double(values.size()))), values.size() - 1);
  const auto kept = values.end() - std::ptrdiff_t(discarded);
  if (discarded > 0)
    std::nth_element(values.begin(), kept, values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return std::accumulate(values.begin(), kept, 0.0) / double(kept - values.begin());
}

Result<ErrorMetrics> compareImages(const RadianceView& picture, const Reference& reference) {
  const Result<std::vector<double>> quotients = relativeSquares(picture, reference);
  if (!quotients) return quotients.error();

  ErrorMetrics metrics;
  metrics.relMse = trimmedMean(*quotients, kDiscardedShare);
  metrics.relMseAll = trimmedMean(*quotients, 0.0);
  double squares = 0.0;
  for (size_t i = 0; i < picture.values.size(); ++i) {
    squares += squareAt(picture, reference, i);
    metrics.nonFinite += std::isfinite(picture.values[i]) ? 0 : 1;
  }
  const double mse = std::max(0.0, squares / double(picture.values.size()));
  const double peak = *std::max_element(reference.mean.values.begin(), reference.mean.values.end());
  metrics.rmse = std::sqrt(mse);
  metrics.psnr = mse == 0.0 ? kInfinity : 10.0 * std::log10(peak * peak / mse);
  if (!reference.half0 || !reference.half1) metrics.mape = meanAbsoluteShare(picture, reference.mean);
  return metrics;
}

RadianceImage imageOf(const RadianceView& view) {
  return {view.width, view.height, {view.values.begin(), view.values.end()}};
}

RadianceImage averageBlocks(const RadianceView& image, uint32_t side) {
  RadianceImage low{(image.width + side - 1) / side, (image.height + side - 1) / side, {}};
  low.values.reserve(size_t(low.width) * low.height * 3);
  for (uint32_t blockY = 0; blockY < low.height; ++blockY)
    for (uint32_t blockX = 0; blockX < low.width; ++blockX) {
      const uint32_t endX = std::min(image.width, (blockX + 1) * side);
      const uint32_t endY = std::min(image.height, (blockY + 1) * side);
      double sum[3] = {};
      for (uint32_t y = blockY * side; y < endY; ++y)
        for (uint32_t x = blockX * side; x < endX; ++x)
          for (size_t c = 0; c < 3; ++c) sum[c] += image.values[(size_t(y) * image.width + x) * 3 + c];
      const double count = double(endX - blockX * side) * double(endY - blockY * side);
      for (const double channel : sum) low.values.push_back(float(channel / count));
    }
  return low;
}

Result<ErrorMetrics> compareLow(const RadianceView& picture, const Reference& reference) {
  if (Result<void> checked = check(picture, reference); !checked) return checked.error();
  const RadianceImage low = averageBlocks(picture, kLowBlock), mean = averageBlocks(reference.mean, kLowBlock);
  if (!reference.half0 || !reference.half1) return compareImages(low.view(), {mean.view(), {}, {}});
  const RadianceImage half0 = averageBlocks(*reference.half0, kLowBlock);
  const RadianceImage half1 = averageBlocks(*reference.half1, kLowBlock);
  return compareImages(low.view(), {mean.view(), half0.view(), half1.view()});
}

}  // namespace limn
