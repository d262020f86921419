#include "tests/support/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace limn::test {
namespace {

/// Upper regularised incomplete gamma function: the series below its knee, the continued fraction above.
/// [Abramowitz and Stegun 6.5.29, 6.5.31]
double upperGamma(double a, double x) {
  if (!(x > 0.0)) return 1.0;
  const double scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (double n = a + 1.0; std::abs(term) > 1e-16 * std::abs(sum); n += 1.0) sum += term *= x / n;
    return 1.0 - scale * sum;
  }
  constexpr double kTiny = 1e-300;
  double b = x + 1.0 - a, c = 1.0 / kTiny, d = 1.0 / b, h = d;
  for (int i = 1; i < 100000; ++i) {
    const double an = -i * (i - a);
    b += 2.0;
    d = an * d + b;
    d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
    c = b + an / c;
    if (std::abs(c) < kTiny) c = kTiny;
    h *= d * c;
    if (std::abs(d * c - 1.0) < 1e-15) break;
  }
  return scale * h;
}

}  // namespace

double chiSquareTail(double statistic, double dof) { return upperGamma(dof * 0.5, statistic * 0.5); }

double normalTails(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

GoodnessOfFit chiSquare(std::span<const double> counts, std::span<const double> expected) {
  std::vector<size_t> order(counts.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });

  GoodnessOfFit fit;
  double count = 0.0, expectation = 0.0, worst = -1.0;
  uint32_t bins = 0;
  const auto close = [&](size_t bin) {
    const double part = (count - expectation) * (count - expectation) / expectation;
    fit.statistic += part;
    ++bins;
    if (part > worst) {
      worst = part;
      fit.worst =
          "bin " + std::to_string(bin) + " counts " + std::to_string(count) + " for " + std::to_string(expectation);
    }
    count = expectation = 0.0;
  };
  for (const size_t i : order) {
    count += counts[i];
    expectation += expected[i];
    if (expectation >= 5.0) close(i);
  }
  // What is left expects under 5 in all: a Poisson count that much above it does not happen.
  if (expectation < 5.0 && count > expectation + 12.0 * std::sqrt(expectation + 1.0)) {
    fit.worst = std::to_string(count) + " where " + std::to_string(expectation) + " are expected";
    return fit;
  }
  fit.dof = bins > 1 ? bins - 1 : 1;
  fit.p = chiSquareTail(fit.statistic, fit.dof);
  return fit;
}

}  // namespace limn::test
