#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace limn::test {

/// Probability that a chi-square variable of `dof` degrees exceeds `statistic`.
double chiSquareTail(double statistic, double dof);
/// Probability that a normal variable is further than |z| from its mean, on either side.
double normalTails(double z);

struct GoodnessOfFit {
  double statistic = 0.0;
  uint32_t dof = 0;
  double p = 0.0;     ///< of a statistic at least as large, if the counts follow the expectations
  std::string worst;  ///< the bin that adds most, for a failed test's output
};

/// Pearson's test of counts against expected counts. Bins that expect under 5 are merged, the rarest first; a count
/// where almost nothing is expected gives p = 0.
GoodnessOfFit chiSquare(std::span<const double> counts, std::span<const double> expected);

}  // namespace limn::test
