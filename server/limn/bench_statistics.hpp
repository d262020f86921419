#pragma once
#include <optional>
#include <span>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/film/compare.hpp"

namespace limn::bench {

/// Arithmetic mean; 0 of nothing. `deviation` is the sample's standard deviation, 0 of fewer than two values.
double meanOf(std::span<const double> values);
double deviationOf(std::span<const double> values);
/// The middle value, or the mean of the middle two; NaN of nothing.
double medianOf(std::vector<double> values);

/// One point of a curve of error over time.
struct TimedError {
  double seconds = 0.0, error = 0.0;
};

/// When a curve first comes down to an error: by linear interpolation of log error over log seconds.
struct TimeToError {
  enum class When {
    atOrBefore,                  ///< the first point is there already: `seconds` is its time, an upper bound
    at,                          ///< between two points
    never,                       ///< not within the curve; `seconds` is the time of its last point, a lower bound
  };
  When when = When::never;
  double seconds = 0.0;
};
/// `curve` ascends in seconds; its values are positive.
TimeToError timeToError(std::span<const TimedError> curve, double error);

/// y = factor * x^exponent by least squares in logarithms.
struct PowerFit {
  double exponent = 0.0, factor = 0.0;
  double exponentDeviation = 0.0;  ///< standard error of the exponent; 0 of two points
};
struct Sample {
  double x = 0.0, y = 0.0;
};
/// Leaves out what has no logarithm. Nothing when fewer than two different x remain.
std::optional<PowerFit> fitPower(std::span<const Sample> samples);

/// What a technique's relMSE is made of, from pictures of the same budget with N different seeds. All three are means
/// over the same values: those left after the 0.1 % whose quotients, averaged over the seeds, are largest.
struct ErrorParts {
  double total = 0.0;            ///< mean relMSE of one picture
  double noise = 0.0;            ///< variance between seeds, relative as relMSE is
  double biasSquared = 0.0;      ///< error of the seeds' mean minus noise / N; about 0 when unbiased, may be negative
  double biasDeviation = 0.0;    ///< standard error of biasSquared, as if pixels erred independently
};
/// Nothing of fewer than two pictures. Errors: those of relativeSquares().
Result<std::optional<ErrorParts>> splitError(std::span<const RadianceView> pictures, const Reference& reference);

/// An error estimate beside the error it estimated.
struct EstimateCheck {
  double estimate = 0.0, low = 0.0, high = 0.0;  ///< with its 95 % interval
  double truth = 0.0;
};
/// How honest the estimates are: the share of intervals that hold the truth should be about 95 %.
struct Calibration {
  size_t count = 0;
  double heldShare = 0.0;        ///< 0..1
  double medianRatio = 0.0;      ///< of estimate / truth
};
/// Checks whose estimate or truth is not a positive number do not count.
Calibration calibrate(std::span<const EstimateCheck> checks);

}  // namespace limn::bench
