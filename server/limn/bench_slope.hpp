#pragma once
#include <optional>
#include <span>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/film/compare.hpp"

namespace limn::bench {

/// The mean of a pixel's first samples, as a progressive renderer shows it.
struct RunningMean {
  uint64_t samples = 0;                ///< of every pixel
  RadianceImage picture;
};

/// Means of consecutive blocks of `samples` samples: [0, n), [n, 2n), ... `run` ascends and passes all multiples of it
/// up to its last. A bright path then weighs alike at every block length, which is what makes slopes comparable.
std::vector<RadianceImage> blockMeans(std::span<const RunningMean> run, uint64_t samples);

/// The exponent of a power law, with what the choice of seeds may change of it.
struct Slope {
  double exponent = 0.0;
  double deviation = 0.0;              ///< standard error, by leaving out one seed after the other
};
/// Of y over x, y being the mean over seeds of `ofSeed[seed][i]` at `x[i]`. Delete-one jackknife [Efron 1982]: what the
/// values of one seed have in common does not deceive it. Nothing of fewer than two seeds, or where fitPower() has none.
std::optional<Slope> slopeOfSeeds(std::span<const double> x, std::span<const std::vector<double>> ofSeed);

/// How an unbiased technique's slope of squared error over samples stands to -1 +- 0.05, its standard error allowed.
enum class SlopeVerdict {
  met,
  steeper,                             ///< better than independent samples: points that spread evenly do that
  flatter,
};
constexpr double kSlopeTolerance = 0.05;
SlopeVerdict judgeSlope(const Slope& slope);
const char* verdictName(SlopeVerdict verdict);

/// Whether pictures of different seeds differ by as much as they say of themselves. Both are relMSE.
struct SeedSpread {
  double between = 0.0;                ///< variance between seeds, without each picture's 0.1 % largest quotients
  double told = 0.0;                   ///< mean of the films' own estimates
  double deviation = 0.0;              ///< standard error of between / told, by the jackknife over seeds
  double ratio() const { return between / told; }
};
/// `pictures` of one size and their `estimates`; the reference's mean says what relMSE divides by. Nothing of fewer than
/// three, or where nothing is told. Errors: those of compareImages().
Result<std::optional<SeedSpread>> spreadOfSeeds(std::span<const RadianceView> pictures,
                                                std::span<const double> estimates, const Reference& reference);

}  // namespace limn::bench
