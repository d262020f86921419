#include <cmath>

#include "protocol/json_writer.hpp"
#include "server/limn/bench_results.hpp"
#include "server/limn/hex_text.hpp"

namespace limn::bench {
namespace {

using protocol::javascriptNumber;
using protocol::JsonWriter;

std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csvNumber(double value) { return std::isfinite(value) ? javascriptNumber(value) : ""; }

std::string csvLine(const std::vector<std::string>& fields) {
  std::string line;
  for (size_t i = 0; i < fields.size(); ++i) line += (i ? "," : "") + csvField(fields[i]);
  return line + "\n";
}

const std::vector<std::string> kColumns = {
    "scene",     "technique", "seed", "budget", "seconds",  "steps",    "samples",       "gatheredShare",    "relMse",
    "relMseAll", "estimate",  "low",  "high",   "nonFinite", "filmHash", "raysPerSecond", "discardedSamples",
    "discardedShare", "stepSeconds", "stepSecondsAllNeeds"};

/// Of the ablation; empty where it was not measured.
std::string stepSeconds(const SceneResult& scene, const Run& run, Ablation::Cost Ablation::*cost) {
  for (const Ablation& ablation : scene.ablations)
    if (ablation.technique == run.technique) return csvNumber((ablation.*cost).stepSeconds);
  return "";
}

std::vector<std::string> rowOf(const SceneResult& scene, const Run& run, const Budget& budget, const Checkpoint& c) {
  return {scene.name, run.technique, std::to_string(run.seed), budget.text, csvNumber(c.seconds),
          std::to_string(c.steps), csvNumber(c.samples), csvNumber(c.gatheredShare), csvNumber(c.relMse),
          csvNumber(c.relMseAll), csvNumber(c.estimate), csvNumber(c.low), csvNumber(c.high),
          std::to_string(c.nonFinite), hexText(c.filmHash), csvNumber(run.status.raysPerSecond),
          std::to_string(run.status.discardedSamples), csvNumber(run.status.discardedShare),
          stepSeconds(scene, run, &Ablation::needed), stepSeconds(scene, run, &Ablation::all)};
}

/// Another renderer's picture has no run of ours.
std::vector<std::string> rowOf(const SceneResult& scene, const Curve& curve, const CurvePoint& point) {
  std::vector<std::string> row(kColumns.size());
  row[0] = scene.name;
  row[1] = curve.technique;
  row[3] = point.budget;
  row[4] = csvNumber(point.seconds);
  row[8] = csvNumber(point.relMse);
  row[9] = csvNumber(point.relMseAll);
  return row;
}

bool hasRun(const SceneResult& scene, const Curve& curve) {
  for (const Run& run : scene.runs)
    if (run.technique == curve.technique) return true;
  return false;
}

template <class List, class Write>
void writeList(JsonWriter& json, const char* name, const List& list, Write write) {
  json.key(name);
  json.beginArray();
  for (const auto& item : list) write(json, item);
  json.endArray();
}

void writeFit(JsonWriter& json, const char* name, const std::optional<PowerFit>& fit) {
  if (!fit) return;
  json.key(name);
  json.beginObject();
  json.field("exponent", fit->exponent);
  json.field("exponentDeviation", fit->exponentDeviation);
  json.field("factor", fit->factor);
  json.endObject();
}

void writePoint(JsonWriter& json, const CurvePoint& point) {
  json.beginObject();
  json.field("budget", point.budget);
  json.field("seconds", point.seconds);
  json.field("steps", point.steps);
  json.field("samples", point.samples);
  json.field("gatheredShare", point.gatheredShare);
  json.field("relMse", point.relMse);
  json.field("relMseAll", point.relMseAll);
  json.field("spread", point.spread);
  json.field("toldSpread", point.toldSpread);
  if (point.parts) {
    json.field("noise", point.parts->noise);
    json.field("biasSquared", point.parts->biasSquared);
    json.field("biasDeviation", point.parts->biasDeviation);
  }
  json.endObject();
}

void writeTimes(JsonWriter& json, const Curve& curve) {
  json.key("secondsToError");
  json.beginArray();
  for (size_t i = 0; i < curve.times.size(); ++i) {
    const TimeToError& time = curve.times[i];
    json.beginObject();
    json.field("relMse", kErrorLevels[i]);
    json.field("seconds", time.seconds);
    json.field("is", std::string(time.when == TimeToError::When::at      ? "interpolated"
                                 : time.when == TimeToError::When::never ? "longer than"
                                                                         : "at most"));
    json.endObject();
  }
  json.endArray();
}

void writeCurve(JsonWriter& json, const Curve& curve) {
  json.beginObject();
  json.field("technique", curve.technique);
  writeList(json, "points", curve.points, writePoint);
  writeTimes(json, curve);
  writeFit(json, "slope", curve.slope);
  writeFit(json, "slopeAll", curve.slopeAll);
  json.endObject();
}

void writeRun(JsonWriter& json, const Run& run) {
  json.beginObject();
  json.field("technique", run.technique);
  json.field("seed", run.seed);
  json.field("buildSeconds", run.buildSeconds);
  json.field("warmUpSeconds", run.warmUpSeconds);
  json.field("raysPerSecond", run.status.raysPerSecond);
  json.field("discardedSamples", run.status.discardedSamples);
  json.field("discardedShare", run.status.discardedShare);
  json.field("memory", run.status.memory);
  json.field("hostMemory", run.status.hostMemory);
  json.field("ran", run.status.ran);
  json.field("leftOut", run.status.leftOut);
  json.endObject();
}

void writeAblation(JsonWriter& json, const Ablation& ablation) {
  json.beginObject();
  json.field("technique", ablation.technique);
  json.field("stepSeconds", ablation.needed.stepSeconds);
  json.field("stepSecondsAllNeeds", ablation.all.stepSeconds);
  json.field("megabytes", ablation.needed.megabytes);
  json.field("megabytesAllNeeds", ablation.all.megabytes);
  json.endObject();
}

void writeSlope(JsonWriter& json, const char* name, const std::optional<Slope>& slope) {
  if (!slope) return;
  json.key(name);
  json.beginObject();
  json.field("exponent", slope->exponent);
  json.field("deviation", slope->deviation);
  json.field("verdict", std::string(verdictName(judgeSlope(*slope))));
  json.endObject();
}

void writeLevel(JsonWriter& json, const Convergence::Level& level) {
  json.beginObject();
  json.field("samples", level.samples);
  json.field("relMse", level.relMse);
  json.field("relMseAll", level.relMseAll);
  json.endObject();
}

void writeFall(JsonWriter& json, const Convergence::Fall& fall) {
  writeList(json, "levels", fall.levels, writeLevel);
  writeSlope(json, "slope", fall.slope);
  writeSlope(json, "slopeAll", fall.slopeAll);
}

void writeConvergence(JsonWriter& json, const Convergence& convergence) {
  json.beginObject();
  json.field("technique", convergence.technique);
  json.field("seeds", convergence.seeds);
  writeFall(json, convergence.own);
  if (convergence.independent) {
    json.key("independent");
    json.beginObject();
    writeFall(json, *convergence.independent);
    json.endObject();
  }
  if (convergence.spread) {
    json.field("betweenSeeds", convergence.spread->between);
    json.field("told", convergence.spread->told);
    json.field("spreadRatio", convergence.spread->ratio());
    json.field("spreadRatioDeviation", convergence.spread->deviation);
  }
  json.endObject();
}

void writeScene(JsonWriter& json, const SceneResult& scene) {
  json.beginObject();
  json.field("scene", scene.name);
  json.field("sceneHash", scene.hash);
  json.field("triangles", scene.triangles);
  json.field("unsupported", scene.unsupported);
  json.key("reference");
  json.beginObject();
  json.field("samples", scene.referenceSamples);
  json.field("seconds", scene.referenceSeconds);
  json.field("noise", scene.referenceNoise);
  json.field("smallestError", scene.smallestError);
  json.field("fineEnough", scene.referenceMissing == 0.0);
  json.field("secondsMissing", scene.referenceMissing);
  json.endObject();
  writeList(json, "curves", scene.curves, writeCurve);
  writeList(json, "runs", scene.runs, writeRun);
  writeList(json, "ablation", scene.ablations, writeAblation);
  writeList(json, "convergence", scene.convergences, writeConvergence);
  json.endObject();
}

void writeCalibration(JsonWriter& json, const char* name, const Calibration& calibration) {
  json.key(name);
  json.beginObject();
  json.field("count", calibration.count);
  json.field("heldShare", calibration.heldShare);
  json.field("medianRatio", calibration.medianRatio);
  json.endObject();
}

void writeGrowthPoint(JsonWriter& json, const Growth::Point& point) {
  json.beginObject();
  json.field("size", point.size);
  json.field("stepSeconds", point.stepSeconds);
  json.field("firstSeconds", point.firstSeconds);
  json.field("megabytes", point.megabytes);
  json.field("buildSeconds", point.buildSeconds);
  json.endObject();
}

void writeGrowth(JsonWriter& json, const Growth& growth) {
  json.beginObject();
  json.field("technique", growth.technique);
  json.field("axis", growth.axis);
  writeList(json, "points", growth.points, writeGrowthPoint);
  writeFit(json, "time", growth.time);
  writeFit(json, "first", growth.first);
  writeFit(json, "memory", growth.memory);
  writeFit(json, "build", growth.build);
  json.endObject();
}

void writeHardFigure(JsonWriter& json, const char* name, const HardFigure& figure) {
  json.key(name);
  json.beginObject();
  json.field("value", figure.value);
  json.field("bound", figure.bound);
  json.field("good", figure.good);
  json.endObject();
}

void writeHardCell(JsonWriter& json, const HardCell& cell) {
  json.beginObject();
  json.field("case", cell.name);
  json.field("technique", cell.technique);
  json.field("good", cell.good);
  json.field("sound", cell.sound);
  json.field("unit", cell.unit);
  writeHardFigure(json, "deviation", cell.deviation);
  writeHardFigure(json, "energy", cell.energy);
  writeHardFigure(json, "discarded", cell.discarded);
  writeHardFigure(json, "fireflies", cell.fireflies);
  json.field("reason", cell.reason);
  json.endObject();
}

}  // namespace

std::string resultsCsv(const BenchResults& results) {
  std::string text = csvLine(kColumns);
  for (const SceneResult& scene : results.scenes) {
    for (const Run& run : scene.runs)
      for (size_t i = 0; i < run.checkpoints.size(); ++i)
        text += csvLine(rowOf(scene, run, results.options.budgets[i], run.checkpoints[i]));
    for (const Curve& curve : scene.curves)
      if (!hasRun(scene, curve))
        for (const CurvePoint& point : curve.points) text += csvLine(rowOf(scene, curve, point));
  }
  return text;
}

std::string resultsJson(const BenchResults& results) {
  JsonWriter json;
  json.beginObject();
  json.field("version", results.version);
  json.field("device", results.device);
  json.field("driver", results.driver);
  json.field("width", results.options.width);
  json.field("height", results.options.height);
  json.field("seeds", results.options.seeds);
  json.field("seconds", results.seconds);
  json.field("absent", results.absent);
  writeList(json, "scenes", results.scenes, writeScene);
  writeList(json, "calibration", results.calibrations, [](JsonWriter& out, const TechniqueCalibration& c) {
    out.beginObject();
    out.field("technique", c.technique);
    out.field("leftOut", c.leftOut);
    writeCalibration(out, "relMse", c.trimmed);
    writeCalibration(out, "relMseAll", c.all);
    out.endObject();
  });
  writeList(json, "growth", results.growth, writeGrowth);
  writeList(json, "hardCases", results.hardCases, writeHardCell);
  json.endObject();
  return json.take() + "\n";
}

}  // namespace limn::bench
