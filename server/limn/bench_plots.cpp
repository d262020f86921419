#include "server/limn/bench_plots.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "protocol/json_writer.hpp"
#include "renderer/base/file_bytes.hpp"

namespace limn::bench {
namespace {

constexpr size_t kMostLinesBelow = 6;  // named below a plot; more are named beside it

Plot::Line errorLine(const Curve& curve, const std::string& title) {
  Plot::Line line{title, {}};
  for (const CurvePoint& point : curve.points) line.points.push_back({point.seconds, point.relMse});
  return line;
}

void addErrorPlots(const BenchResults& results, std::vector<Plot>& plots) {
  Plot all{"errors", "Speed against error", "seconds after the first step", "relMSE", {}};
  Plot samples{"samples", "Error against samples", "samples of a pixel (harmonic mean)", "relMSE", {}};
  for (const SceneResult& scene : results.scenes) {
    Plot one{"error-" + scene.name, scene.name, "seconds after the first step", "relMSE", {}};
    for (const Curve& curve : scene.curves) {
      one.lines.push_back(errorLine(curve, curve.technique));
      all.lines.push_back(errorLine(curve, scene.name + ", " + curve.technique));
      Plot::Line line{scene.name + ", " + curve.technique, {}};
      for (const CurvePoint& point : curve.points) line.points.push_back({point.samples, point.relMse});
      samples.lines.push_back(line);
    }
    plots.push_back(one);
  }
  plots.push_back(all);
  plots.push_back(samples);
}

void addConvergencePlot(const BenchResults& results, std::vector<Plot>& plots) {
  Plot plot{"convergence", "Error of every quotient against samples, many seeds", "samples of a pixel", "relMSE", {}};
  for (const SceneResult& scene : results.scenes)
    for (const Convergence& convergence : scene.convergences) {
      Plot::Line line{scene.name + ", " + convergence.technique, {}};
      for (const Convergence::Level& level : convergence.own.levels)
        line.points.push_back({level.samples, level.relMseAll});
      plot.lines.push_back(line);
    }
  plots.push_back(plot);
}

void addCalibrationPlot(const BenchResults& results, std::vector<Plot>& plots) {
  Plot plot{"calibration", "What the film says of its error", "true relMSE", "estimated relMSE", {}, true};
  for (const TechniqueCalibration& calibration : results.calibrations) {
    Plot::Line line{calibration.technique, {}};
    for (const SceneResult& scene : results.scenes)
      for (const Run& run : scene.runs)
        for (const Checkpoint& c : run.checkpoints)
          if (run.technique == calibration.technique) line.points.push_back({c.relMse, c.estimate});
    plot.lines.push_back(line);
  }
  plots.push_back(plot);
}

/// The technique with the exponent of the power law through its points.
std::string fitTitle(const std::string& technique, const std::optional<PowerFit>& fit) {
  if (!fit) return technique;
  char text[32];
  std::snprintf(text, sizeof text, ", to the %.2f", fit->exponent);
  return technique + text;
}

void addGrowthPlots(const BenchResults& results, std::vector<Plot>& plots) {
  std::map<std::string, Plot> byName;
  const auto plotOf = [&](const std::string& kind, const Growth& growth, const char* what) -> Plot& {
    const std::string name = kind + "-" + growth.axis;
    return byName.try_emplace(name, Plot{name, "Growth with " + growth.axis, growth.axis, what, {}}).first->second;
  };
  for (const Growth& growth : results.growth) {
    Plot::Line time{fitTitle(growth.technique, growth.time), {}}, memory{fitTitle(growth.technique, growth.memory), {}};
    Plot::Line first{fitTitle(growth.technique + ", first steps", growth.first), {}};
    for (const Growth::Point& point : growth.points) {
      time.points.push_back({point.size, point.stepSeconds});
      first.points.push_back({point.size, point.firstSeconds});
      memory.points.push_back({point.size, point.megabytes});
    }
    Plot& seconds = plotOf("growth", growth, "seconds: of a step, of the first steps together");
    seconds.lines.push_back(time);
    seconds.lines.push_back(first);
    plotOf("memory", growth, "device memory [MB]").lines.push_back(memory);
  }
  for (const auto& [name, plot] : byName) plots.push_back(plot);
}

/// Between single quotes; the titles come from file names.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : c == '\n' ? " " : std::string(1, c);
  return result + "'";
}

bool drawable(const Sample& point) {
  return point.x > 0.0 && point.y > 0.0 && std::isfinite(point.x) && std::isfinite(point.y);
}

}  // namespace

std::vector<Plot> plotsOf(const BenchResults& results) {
  std::vector<Plot> plots;
  addErrorPlots(results, plots);
  addConvergencePlot(results, plots);
  addCalibrationPlot(results, plots);
  addGrowthPlots(results, plots);
  // A log axis needs something to show.
  for (Plot& plot : plots)
    for (Plot::Line& line : plot.lines) std::erase_if(line.points, [](const Sample& p) { return !drawable(p); });
  for (Plot& plot : plots) std::erase_if(plot.lines, [](const Plot::Line& line) { return line.points.empty(); });
  std::erase_if(plots, [](const Plot& plot) { return plot.lines.empty(); });
  return plots;
}

std::string gnuplotScript(const Plot& plot, const std::string& directory) {
  std::string script, drawing;
  for (size_t i = 0; i < plot.lines.size(); ++i) {
    const std::string block = "$line" + std::to_string(i);
    script += block + " << EOD\n";
    for (const Sample& point : plot.lines[i].points)
      script += protocol::javascriptNumber(point.x) + " " + protocol::javascriptNumber(point.y) + "\n";
    script += "EOD\n";
    drawing += (i ? ", " : "") + block + " using 1:2 with " + (plot.dots ? "points" : "linespoints linewidth 2") +
               " pointtype 7 pointsize 0.5 title " + quoted(plot.lines[i].title);
  }
  if (plot.dots) drawing += ", x with lines linecolor rgb 'gray' title 'estimate = truth'";
  const bool few = plot.lines.size() <= kMostLinesBelow;
  script += "set logscale xy\nset format xy '%g'\nset grid\nset key outside noenhanced ";
  script += few ? "bottom center horizontal\n" : "right\n";
  script += "set title " + quoted(plot.title) + " noenhanced\n";
  script += "set xlabel " + quoted(plot.xLabel) + "\nset ylabel " + quoted(plot.yLabel) + "\n";
  const std::string file = (std::filesystem::path(directory) / plot.name).string();
  const std::string size = few ? "860,520" : "1160," + std::to_string(std::max<size_t>(520, 120 + 18 * plot.lines.size()));
  script += "set terminal svg size " + size + " font 'sans,13' background rgb 'white'\nset output ";
  script += quoted(file + ".svg") + "\nplot " + drawing + "\nset terminal png size " + size + "\nset output ";
  script += quoted(file + ".png");
  script += "\nreplot\nunset output\nreset\n";
  return script;
}

Result<bool> drawPlots(const std::vector<Plot>& plots, const std::string& directory) {
  std::string script;
  for (const Plot& plot : plots) script += gnuplotScript(plot, directory);
  const std::string file = (std::filesystem::path(directory) / "plots.gnuplot").string();
  const Result<void> written =
      writeFileAtomically(file, {reinterpret_cast<const uint8_t*>(script.data()), script.size()});
  if (!written) return written.error();
  std::string word = "'";
  for (const char c : file) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return std::system(("gnuplot " + word + "' >/dev/null 2>&1").c_str()) == 0;
}

}  // namespace limn::bench
