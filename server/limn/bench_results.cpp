#include "server/limn/bench_results.hpp"

#include <algorithm>
#include <cmath>

namespace limn::bench {
namespace {

constexpr double kIntervalSigmas = 1.96;  // of a 95 % interval
constexpr double kLeastSamples = 4.0;     // under them a slope says how a pass begins, not how it converges

std::vector<const Run*> runsOf(const std::vector<Run>& runs, const std::string& technique) {
  std::vector<const Run*> found;
  for (const Run& run : runs)
    if (run.technique == technique) found.push_back(&run);
  return found;
}

template <class Field>
std::vector<double> collect(const std::vector<const Run*>& runs, size_t budget, Field field) {
  std::vector<double> values;
  for (const Run* run : runs) values.push_back(double(field(run->checkpoints[budget])));
  return values;
}

Result<CurvePoint> makePoint(const std::vector<const Run*>& runs, size_t i, const Budget& budget,
                             const Reference& reference) {
  const auto mean = [&](auto field) { return meanOf(collect(runs, i, field)); };
  CurvePoint point;
  point.budget = budget.text;
  point.seconds = mean([](const Checkpoint& c) { return c.seconds; });
  point.steps = mean([](const Checkpoint& c) { return c.steps; });
  point.samples = mean([](const Checkpoint& c) { return c.samples; });
  point.gatheredShare = mean([](const Checkpoint& c) { return c.gatheredShare; });
  point.relMse = mean([](const Checkpoint& c) { return c.relMse; });
  point.relMseAll = mean([](const Checkpoint& c) { return c.relMseAll; });
  // Within the same time seeds may have made a different number of samples: that is no spread of the error.
  const std::vector<double> scaled = collect(runs, i, [](const Checkpoint& c) { return c.relMse * c.samples; });
  if (meanOf(scaled) > 0.0) point.spread = deviationOf(scaled) / meanOf(scaled);
  point.toldSpread = mean([](const Checkpoint& c) {
    return c.estimate > 0.0 && std::isfinite(c.high) ? (c.high - c.estimate) / kIntervalSigmas / c.estimate : 0.0;
  });
  std::vector<RadianceView> pictures;
  for (const Run* run : runs) pictures.push_back(run->checkpoints[i].picture.view());
  const Result<std::optional<ErrorParts>> parts = splitError(pictures, reference);
  if (!parts) return parts.error();
  point.parts = *parts;
  return point;
}

}  // namespace

Result<void> compareRuns(std::vector<Run>& runs, const Reference& reference) {
  for (Run& run : runs)
    for (Checkpoint& checkpoint : run.checkpoints) {
      const Result<ErrorMetrics> metrics = compareImages(checkpoint.picture.view(), reference);
      if (!metrics) return metrics.error();
      checkpoint.relMse = metrics->relMse;
      checkpoint.relMseAll = metrics->relMseAll;
      checkpoint.nonFinite = metrics->nonFinite;
    }
  return {};
}

void finishCurve(Curve& curve) {
  std::vector<TimedError> errors;
  std::vector<Sample> trimmed, all;
  for (const CurvePoint& point : curve.points) {
    if (point.relMse > 0.0) errors.push_back({point.seconds, point.relMse});
    if (point.gatheredShare < 1.0 || point.samples < kLeastSamples) continue;
    trimmed.push_back({point.samples, point.relMse});
    all.push_back({point.samples, point.relMseAll});
  }
  for (const double level : kErrorLevels) curve.times.push_back(timeToError(errors, level));
  curve.slope = fitPower(trimmed);
  curve.slopeAll = fitPower(all);
}

Result<std::vector<Curve>> makeCurves(const std::vector<Run>& runs, const std::vector<Budget>& budgets,
                                      const Reference& reference) {
  std::vector<Curve> curves;
  for (const Run& first : runs) {
    const auto known = [&](const Curve& curve) { return curve.technique == first.technique; };
    if (std::any_of(curves.begin(), curves.end(), known)) continue;
    Curve curve;
    curve.technique = first.technique;
    for (size_t i = 0; i < budgets.size(); ++i) {
      const Result<CurvePoint> point = makePoint(runsOf(runs, first.technique), i, budgets[i], reference);
      if (!point) return point.error();
      curve.points.push_back(*point);
    }
    finishCurve(curve);
    curves.push_back(std::move(curve));
  }
  return curves;
}

std::vector<TechniqueCalibration> calibrateAll(const std::vector<SceneResult>& scenes) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<EstimateCheck>> trimmed, all;
  std::map<std::string, size_t> leftOut;
  for (const SceneResult& scene : scenes)
    for (const Run& run : scene.runs) {
      if (std::find(order.begin(), order.end(), run.technique) == order.end()) order.push_back(run.technique);
      for (const Checkpoint& c : run.checkpoints) {
        if (scene.referenceNoise * kJudgeMargin > c.relMse) {
          ++leftOut[run.technique];
          continue;
        }
        trimmed[run.technique].push_back({c.estimate, c.low, c.high, c.relMse});
        all[run.technique].push_back({c.estimate, c.low, c.high, c.relMseAll});
      }
    }
  std::vector<TechniqueCalibration> result;
  for (const std::string& technique : order)
    result.push_back({technique, calibrate(trimmed[technique]), calibrate(all[technique]), leftOut[technique]});
  return result;
}

}  // namespace limn::bench
