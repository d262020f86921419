#pragma once
#include <optional>
#include <string>
#include <vector>

#include "server/limn/bench_run.hpp"
#include "server/limn/bench_slope.hpp"

namespace limn::bench {

/// How an unbiased technique converges on one scene: small pictures of many seeds, so that rare bright paths are met.
struct Convergence {
  struct Level {
    double samples = 0.0;              ///< of a pixel, in one picture
    double relMse = 0.0, relMseAll = 0.0;  ///< means over blocks of so many samples and over seeds
  };
  struct Fall {
    std::vector<Level> levels;         ///< each twice the samples of the one before
    std::optional<Slope> slope, slopeAll;  ///< of relMse and relMseAll over samples
  };
  std::string technique;
  uint32_t seeds = 0;
  Fall own;
  std::optional<Fall> independent;     ///< without Sobol points, of a technique that can: slope -1 wherever it is unbiased
  std::optional<SeedSpread> spread;    ///< at the last level of `own`

  /// Error of independent samples over that of as many own ones, at the most samples.
  std::optional<double> gain() const;
};
constexpr uint32_t kConvergenceSide = 64;                  ///< [pixel]
constexpr uint64_t kFewestSamples = 4, kMostSamples = 64;  ///< of a pixel, in pictures of the first and last level

/// Runs `options.convergence` seeds of a technique, and a reference of as many samples as they have together, which is
/// kept beside the others as `name`. Errors: "bad-image" when pixels have different numbers of samples.
Result<Convergence> measureConvergence(vk::Device& device, const LoadedScene& loaded, const BenchOptions& options,
                                       const std::string& name, SessionConfig config);

}  // namespace limn::bench
