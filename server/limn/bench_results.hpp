#pragma once
#include <map>
#include <string>
#include <vector>

#include "server/limn/bench_convergence.hpp"
#include "server/limn/bench_hard_cases.hpp"
#include "server/limn/bench_run.hpp"
#include "server/limn/bench_statistics.hpp"

namespace limn::bench {

/// One budget of one technique on one scene: means over the seeds.
struct CurvePoint {
  std::string budget;                  ///< as it was asked for
  double seconds = 0.0, steps = 0.0, samples = 0.0, gatheredShare = 0.0;
  double relMse = 0.0, relMseAll = 0.0;
  double spread = 0.0;                 ///< of relMse between seeds at equal samples: standard deviation over mean
  double toldSpread = 0.0;             ///< what the films' intervals say of it: half width / 1.96 / estimate
  std::optional<ErrorParts> parts;     ///< noise and bias, of two seeds or more
};

/// One technique, or another renderer, on one scene.
struct Curve {
  std::string technique;
  std::vector<CurvePoint> points;
  std::vector<TimeToError> times;      ///< one for each of kErrorLevels
  std::optional<PowerFit> slope, slopeAll;  ///< of relMse and relMseAll over samples
  std::string firstPng, lastPng, heatPng;   ///< seed 0 at the first and last budget, and where the last errs
};
constexpr double kErrorLevels[] = {0.1, 0.03, 0.01, 0.003, 0.001};

/// A technique on a scene, with what the scene needs and with everything at work that any scene may need.
struct Ablation {
  struct Cost { double stepSeconds = 0.0, megabytes = 0.0; };  ///< the quickest of kAblationRounds; on the device
  std::string technique;
  Cost needed, all;
};
constexpr uint32_t kAblationRounds = 8;

struct SceneResult {
  std::string name, file, hash;
  uint64_t triangles = 0;
  uint64_t referenceSamples = 0;
  double referenceSeconds = 0.0, referenceNoise = 0.0;
  double smallestError = 0.0;          ///< of all that is reported here
  double referenceMissing = 0.0;       ///< [s] until it is kReferenceMargin times finer than that, by its noise and its samples
  std::string referencePng;
  std::vector<std::string> unsupported;///< features of the file
  std::vector<Run> runs;
  std::vector<Curve> curves;
  std::vector<Ablation> ablations;
  std::vector<Convergence> convergences;
};
constexpr double kReferenceMargin = 20.0;

/// Time and memory against one size of the scene or picture, for one technique.
struct Growth {
  std::string technique, axis;         ///< "triangles", "lights", "points", "pixels"
  struct Point {
    double size = 0.0;
    double stepSeconds = 0.0;          ///< of a later step
    double firstSeconds = 0.0;         ///< of the first steps together, and with them what is done once
    double megabytes = 0.0, buildSeconds = 0.0;
  };
  std::vector<Point> points;
  std::optional<PowerFit> time, first, memory, build;
};

/// Calibration of the films' own error estimates, against relMSE with and without the largest quotients.
struct TechniqueCalibration {
  std::string technique;
  Calibration trimmed, all;
  size_t leftOut = 0;                  ///< checkpoints that the reference is too noisy to judge
};
/// So many times over the reference's noise must an error be for the estimate to be judged by it.
constexpr double kJudgeMargin = 5.0;

struct BenchResults {
  BenchOptions options;
  std::string device, driver, version;
  double seconds = 0.0;                ///< the whole benchmark took
  std::vector<SceneResult> scenes;
  std::vector<TechniqueCalibration> calibrations;
  std::vector<Growth> growth;
  std::vector<HardCell> hardCases;
  std::vector<std::string> absent;     ///< what could not be done, and why; one sentence each
};

/// Compares every checkpoint with the reference. Errors: those of compareImages().
Result<void> compareRuns(std::vector<Run>& runs, const Reference& reference);
/// Means over seeds, parts, times and slopes; one curve a technique, in the order of first appearance.
Result<std::vector<Curve>> makeCurves(const std::vector<Run>& runs, const std::vector<Budget>& budgets,
                                      const Reference& reference);
void finishCurve(Curve& curve);
std::vector<TechniqueCalibration> calibrateAll(const std::vector<SceneResult>& scenes);

/// A line a checkpoint. Fields with a comma or quote are quoted.
std::string resultsCsv(const BenchResults& results);
/// Everything but the pictures.
std::string resultsJson(const BenchResults& results);

}  // namespace limn::bench
