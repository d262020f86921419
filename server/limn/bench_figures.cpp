#include "server/limn/bench_figures.hpp"

#include <algorithm>

#include "server/limn/bench_html.hpp"

namespace limn::bench {
namespace {

std::string lineOf(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

std::string headOf(const std::vector<std::string>& cells) {
  std::string line = lineOf(cells) + "|";
  for (size_t i = 0; i < cells.size(); ++i) line += "---|";
  return line + "\n";
}

std::string short2(double value) { return number(value, "%.2g"); }
std::string withDeviation(double value, double deviation, const char* format = "%.2f") {
  return number(value, format) + " ± " + number(deviation, format);
}

/// Another renderer has budgets of its own: its cells say when.
std::string errorFigures(const BenchResults& results) {
  const std::vector<Budget>& budgets = results.options.budgets;
  std::vector<std::string> heads = {"scene", "technique"};
  for (const Budget& budget : budgets) heads.push_back(budget.text + (budget.steps > 0 ? " passes" : " s"));
  std::string text = "## Speed against error (relMSE)\n\n" + headOf(heads), peers;
  for (const SceneResult& scene : results.scenes)
    for (const Curve& curve : scene.curves) {
      std::vector<std::string> cells = {scene.name, curve.technique};
      const bool own = findTechnique(curve.technique);
      for (const CurvePoint& p : curve.points)
        cells.push_back(short2(p.relMse) + (own ? "" : " at " + short2(p.seconds) + " s"));
      (own ? text : peers) += lineOf(cells);
    }
  return text + peers;
}

/// How far references are from being kReferenceMargin times finer than the smallest error.
std::string referenceFigures(const BenchResults& results) {
  std::string text = "\n## References\n\n" + headOf({"scene", "samples", "s", "noise", "smallest error", "s missing until it is " +
                                                     number(kReferenceMargin) + " times finer"});
  for (const SceneResult& scene : results.scenes)
    text += lineOf({scene.name, std::to_string(scene.referenceSamples), number(scene.referenceSeconds, "%.0f"),
                    short2(scene.referenceNoise), short2(scene.smallestError), number(scene.referenceMissing, "%.0f")});
  return text;
}

std::string convergenceFigures(const BenchResults& results) {
  std::string lines;
  for (const SceneResult& scene : results.scenes)
    for (const Convergence& c : scene.convergences) {
      std::vector<std::string> cells = {scene.name, c.technique, std::to_string(c.seeds)};
      const std::optional<Slope> independent = c.independent ? c.independent->slopeAll : std::nullopt;
      for (const std::optional<Slope>& slope : {independent, c.own.slopeAll}) {
        cells.push_back(slope ? withDeviation(slope->exponent, slope->deviation, "%.3f") : "–");
        cells.push_back(slope ? verdictName(judgeSlope(*slope)) : "–");
      }
      cells.push_back(c.gain() ? number(*c.gain(), "%.2f") : "–");
      cells.push_back(c.spread ? withDeviation(c.spread->ratio(), c.spread->deviation) : "–");
      lines += lineOf(cells);
    }
  if (lines.empty()) return "";
  return "\n## Slope of relMSE over samples, and spread between seeds\n\n" +
         headOf({"scene", "technique", "seeds", "independent samples", "−1 ± 0.05", "Sobol points", "−1 ± 0.05",
                 "error of the former / of the latter", "variance between seeds / told"}) +
         lines;
}

std::string calibrationFigures(const BenchResults& results) {
  std::string text = "\n## What films say of their own error\n\n" +
                     headOf({"technique", "pictures", "left out", "intervals that hold the error",
                             "median of estimate / error"});
  for (const TechniqueCalibration& c : results.calibrations) {
    std::vector<std::string> cells = {c.technique, std::to_string(c.trimmed.count), std::to_string(c.leftOut)};
    if (c.trimmed.count > 0)
      for (const std::string& cell :
           {number(100.0 * c.trimmed.heldShare, "%.0f") + " %", number(c.trimmed.medianRatio, "%.2f")})
        cells.push_back(cell);
    cells.resize(5, "–");
    text += lineOf(cells);
  }
  return text;
}

std::string growthFigures(const BenchResults& results) {
  if (results.growth.empty()) return "";
  std::string text = "\n## Exponents of growth\n\n" +
                     headOf({"technique", "against", "time of a step", "of the first steps", "memory", "build"});
  for (const Growth& g : results.growth) {
    std::vector<std::string> cells = {g.technique, g.axis};
    for (const std::optional<PowerFit>& fit : {g.time, g.first, g.memory, g.build})
      cells.push_back(fit ? withDeviation(fit->exponent, fit->exponentDeviation) : "–");
    text += lineOf(cells);
  }
  return text;
}

/// A step with everything at work over one with what is needed: where leaving out saves least, and where most.
std::string ablationFigures(const BenchResults& results) {
  struct Saved { double ratio = 0.0; std::string where; };
  std::vector<Saved> all;
  for (const SceneResult& scene : results.scenes)
    for (const Ablation& a : scene.ablations)
      all.push_back({a.all.stepSeconds / a.needed.stepSeconds, scene.name + ", " + a.technique});
  if (all.empty()) return "";
  const auto [least, most] = std::minmax_element(all.begin(), all.end(), [](const Saved& a, const Saved& b) {
    return a.ratio < b.ratio;
  });
  return "\n## What leaving out saves\n\nA step with everything at work takes " + number(least->ratio, "%.2f") +
         " times as long at least (" + least->where + "), " + number(most->ratio, "%.2f") + " times at most (" +
         most->where + ").\n";
}

/// The parts of a cell over their bounds.
std::string brokenText(const HardCell& cell) {
  std::string text = cell.sound ? "" : "not finite, ";
  const std::pair<std::string, const HardFigure*> figures[] = {{cell.unit, &cell.deviation},
                                                               {"energy", &cell.energy},
                                                               {"fireflies", &cell.fireflies},
                                                               {"discarded", &cell.discarded}};
  for (const auto& [name, figure] : figures)
    if (!figure->good) text += name + " " + short2(figure->value) + " of " + short2(figure->bound) + ", ";
  return text + (cell.reason.empty() ? "for no known reason" : cell.reason);
}

std::string hardCaseFigures(const BenchResults& results) {
  const std::vector<HardCell>& cells = results.hardCases;
  if (cells.empty()) return "";
  const auto good = std::count_if(cells.begin(), cells.end(), [](const HardCell& cell) { return cell.good; });
  std::string text = "\n## Hard cases\n\n" + std::to_string(good) + " of " + std::to_string(cells.size()) +
                     " cells keep every promise.";
  const auto share = [](const HardCell& cell) { return cell.deviation.value / cell.deviation.bound; };
  const auto worst = std::max_element(cells.begin(), cells.end(), [&](const HardCell& a, const HardCell& b) {
    return share(a) < share(b);
  });
  text += " The largest deviation for its bound: " + short2(worst->deviation.value) + " of " +
          short2(worst->deviation.bound) + " " + worst->unit + " (" + worst->name + ", " + worst->technique + ").\n";
  for (const HardCell& cell : cells)
    if (!cell.good) text += "- " + cell.name + ", " + cell.technique + ": " + brokenText(cell) + "\n";
  return text;
}

}  // namespace

std::string resultsFigures(const BenchResults& results) {
  const BenchOptions& o = results.options;
  std::string text = "# Figures of a benchmark\n\nLimn " + results.version + " on " + results.device + " (" +
                     results.driver + "), " + std::to_string(o.width) + "x" + std::to_string(o.height) + " pixels, " +
                     std::to_string(o.seeds) + " seeds, made in " + number(results.seconds / 60.0) + " minutes.\n\n";
  text += errorFigures(results) + referenceFigures(results) + convergenceFigures(results) + calibrationFigures(results) + growthFigures(results) +
          ablationFigures(results) + hardCaseFigures(results);
  for (const std::string& sentence : results.absent) text += "\n" + sentence + "\n";
  return text;
}

}  // namespace limn::bench
