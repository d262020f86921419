#include "server/limn/bench_page.hpp"

#include <algorithm>
#include <cmath>

#include "server/limn/bench_html.hpp"
#include "server/limn/bench_page_parts.hpp"

namespace limn::bench {
namespace {

constexpr double kMostDiscarded = 1e-5;  // share of all samples
constexpr const char* kStyle =
    "body{font:15px/1.45 sans-serif;max-width:76rem;margin:2rem auto;padding:0 1rem;color:#1c1c1c;background:#fff}"
    "h2{margin-top:2.5rem;border-bottom:1px solid #ccc}table{border-collapse:collapse;margin:.8rem 0}"
    "th,td{padding:.2rem .6rem;border:1px solid #ddd;text-align:right}th:first-child,td:first-child{text-align:left}"
    "th{background:#f3f3f3}.bad{color:#a40000;font-weight:bold}figure{display:inline-block;margin:.3rem}"
    "figcaption{font-size:13px;color:#444}img{max-width:100%;image-rendering:pixelated}";

constexpr const char* kHowMeasured =
    "<p>Time counts from the first step, with the scene loaded and pipelines warm. Adaptive sampling is off unless it "
    "was asked for. relMSE is that of <code>limn compare</code>, without the 0.1 % largest quotients, taken with the "
    "two halves of the reference, so that the reference's own noise adds nothing on average. Figures in "
    "<span class=\"bad\">red</span> miss their goal.</p>\n";
const std::string kConvergence =
    "<h2>Convergence</h2>\n<p>How the error of these runs falls with the samples. An unbiased technique's slope "
    "should be −1 ± 0.05; where many seeds were run it is judged by these, below. The spread is the standard deviation "
    "relative to the mean, at the last budget.</p>\n";
const std::string kEstimates =
    "<h2>What the film says of its own error</h2>\n<p>Of 95 % intervals 90 to 98 % should hold the true error, and the "
    "median of estimate over error should lie within 0.8 and 1.25. Left out are errors that are not five times over "
    "the reference's own noise: it cannot judge them.</p>\n";

std::string figure(const std::string& png, const std::string& caption) {
  if (png.empty()) return "";
  const std::string alt = escaped(caption), source = "data:image/png;base64," + base64(png);
  return "<figure><img alt=\"" + alt + "\" src=\"" + source + "\"><figcaption>" + alt + "</figcaption></figure>\n";
}

std::string timeText(const TimeToError& time) {
  const std::string seconds = number(time.seconds);
  if (time.when == TimeToError::When::at) return seconds;
  return (time.when == TimeToError::When::never ? "&gt; " : "≤ ") + seconds;
}

std::string timesTable(const BenchResults& results) {
  std::vector<std::string> heads = {"seconds to relMSE", "technique"};
  for (const double level : kErrorLevels) heads.push_back(number(level));
  std::string text = header(heads);
  for (const SceneResult& scene : results.scenes)
    for (const Curve& curve : scene.curves) {
      std::vector<std::string> cells = {escaped(scene.name), escaped(curve.technique)};
      for (const TimeToError& time : curve.times) cells.push_back(timeText(time));
      text += row(cells);
    }
  return text + "</table>\n";
}

std::string slopesTable(const BenchResults& results) {
  std::string text = header({"scene", "technique", "slope of relMSE over samples", "slope with every quotient",
                             "spread between seeds", "spread that intervals say"});
  for (const SceneResult& scene : results.scenes)
    for (const Curve& curve : scene.curves) {
      if (curve.points.empty() || !curve.slope) continue;
      const TechniqueInfo* info = findTechnique(curve.technique);
      const bool judged = info && !info->biased && scene.convergences.empty();
      const bool off = judged && std::abs(curve.slope->exponent + 1.0) > kSlopeTolerance;
      const CurvePoint& last = curve.points.back();
      text += row({escaped(scene.name), escaped(curve.technique), marked(fitText(curve.slope), off),
                   fitText(curve.slopeAll), number(last.spread), number(last.toldSpread)});
    }
  return text + "</table>\n";
}

std::string calibrationTable(const BenchResults& results) {
  std::string text = header({"technique", "checkpoints", "left out", "intervals that hold the error",
                             "median of estimate / error", "both against every quotient", ""});
  for (const TechniqueCalibration& c : results.calibrations) {
    const bool shareOff = c.trimmed.heldShare < 0.9 || c.trimmed.heldShare > 0.98;
    const bool ratioOff = c.trimmed.medianRatio < 0.8 || c.trimmed.medianRatio > 1.25;
    text += row({escaped(c.technique), std::to_string(c.trimmed.count), std::to_string(c.leftOut),
                 marked(number(100.0 * c.trimmed.heldShare) + " %", shareOff),
                 marked(number(c.trimmed.medianRatio), ratioOff), number(100.0 * c.all.heldShare) + " %",
                 number(c.all.medianRatio)});
  }
  return text + "</table>\n";
}

std::string partsTable(const SceneResult& scene) {
  std::string text = header({"technique", "budget", "seconds", "samples", "relMSE", "noise", "bias²", "± (95 %)"});
  for (const Curve& curve : scene.curves)
    for (const CurvePoint& p : curve.points) {
      const std::string missing = p.gatheredShare < 1.0 ? " (" + number(100.0 * p.gatheredShare) + " % of pixels)" : "";
      std::vector<std::string> cells = {escaped(curve.technique), escaped(p.budget), number(p.seconds),
                                        number(p.samples) + missing, number(p.relMse)};
      if (p.parts)
        for (const double part : {p.parts->noise, p.parts->biasSquared, 1.96 * p.parts->biasDeviation})
          cells.push_back(number(part));
      cells.resize(8, "–");
      text += row(cells);
    }
  return text + "</table>\n";
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + escaped(word);
  return text.empty() ? "nothing" : text;
}

std::string discardedText(const Status& status) {
  const std::string share = ", " + number(status.discardedShare) + " of all";
  return marked("Samples discarded: " + std::to_string(status.discardedSamples) + share + ".",
                status.discardedShare > kMostDiscarded);
}

/// What ran and what was left out, once a technique.
std::string needsText(const SceneResult& scene) {
  std::string text;
  for (const Curve& curve : scene.curves) {
    const auto of = [&](const Run& run) { return run.technique == curve.technique; };
    const auto run = std::find_if(scene.runs.begin(), scene.runs.end(), of);
    if (run == scene.runs.end()) continue;
    text += "<p>" + escaped(curve.technique) + " ran " + joined(run->status.ran) + "; left out " +
            joined(run->status.leftOut) + ". " + discardedText(run->status) + "</p>\n";
  }
  return text;
}

std::string missingText(const SceneResult& scene) {
  return std::isfinite(scene.referenceMissing) ? ", for which about " + number(scene.referenceMissing, "%.2g") + " s more are needed" : "";
}

std::string referenceText(const SceneResult& scene) {
  const std::string noise = "noise " + number(scene.referenceNoise) + ", smallest error " + number(scene.smallestError);
  std::string text = "<p>Reference: " + std::to_string(scene.referenceSamples) + " samples of a pixel in " +
                     number(scene.referenceSeconds) + " s, " + noise + ". ";
  if (scene.referenceMissing > 0.0)
    text += marked("Its time was over before it was " + number(kReferenceMargin) + " times finer" + missingText(scene) + ".", true);
  if (!scene.unsupported.empty()) text += " Not supported: " + joined(scene.unsupported) + ".";
  return text + "</p>\n";
}

std::string sceneSection(const SceneResult& scene, const std::string& directory) {
  std::string text = "<h2>" + escaped(scene.name) + "</h2>\n<p>" + std::to_string(scene.triangles) +
                     " triangles.</p>\n" + referenceText(scene) + plot(directory, "error-" + scene.name, scene.name) +
                     figure(scene.referencePng, "reference");
  for (const Curve& curve : scene.curves) {
    if (curve.points.empty()) continue;
    const CurvePoint &first = curve.points.front(), &last = curve.points.back();
    const auto caption = [&](const CurvePoint& point) {
      return curve.technique + ", " + number(point.seconds) + " s, relMSE " + number(point.relMse);
    };
    text += figure(curve.firstPng, caption(first)) + figure(curve.lastPng, caption(last));
    text += figure(curve.heatPng, "where it errs, 1e-4 dark to 10 light");
  }
  return text + partsTable(scene) + needsText(scene);
}

}  // namespace

std::string resultsPage(const BenchResults& results, const std::string& directory) {
  const BenchOptions& o = results.options;
  std::string text = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Limn: speed against error"
                     "</title><style>" + std::string(kStyle) + "</style></head><body>\n<h1>Speed against error</h1>\n";
  text += "<p>Limn " + escaped(results.version) + " on " + escaped(results.device) + " (" + escaped(results.driver) +
          "), " + std::to_string(o.width) + "x" + std::to_string(o.height) + " pixels, " + std::to_string(o.seeds) +
          " seeds, made in " + number(results.seconds / 60.0) + " minutes.</p>\n" + kHowMeasured;
  for (const std::string& sentence : results.absent) text += "<p>" + marked(escaped(sentence), true) + "</p>\n";
  text += plot(directory, "errors", "relMSE over seconds") + timesTable(results);
  text += kConvergence + slopesTable(results) + plot(directory, "samples", "relMSE over samples");
  text += convergenceSection(results, directory);
  text += kEstimates + calibrationTable(results) + plot(directory, "calibration", "estimated over true relMSE");
  text += hardCasesSection(results.hardCases);
  for (const SceneResult& scene : results.scenes) text += sceneSection(scene, directory);
  return text + ablationSection(results) + growthSection(results, directory) + "</body></html>\n";
}

}  // namespace limn::bench
