#pragma once
#include <string>
#include <vector>

#include "server/limn/bench_results.hpp"

namespace limn::bench {

/// One drawing, in double logarithmic axes.
struct Plot {
  struct Line { std::string title; std::vector<Sample> points; };
  std::string name;                    ///< of its files, without ending
  std::string title, xLabel, yLabel;
  std::vector<Line> lines;
  bool dots = false;                   ///< points without lines, and the diagonal y = x
};

/// Error over seconds for every scene ("error-SCENE"), all scenes ("errors"), error over samples ("samples"), estimate
/// over true error ("calibration"), growth ("growth-AXIS") and memory ("memory-AXIS").
std::vector<Plot> plotsOf(const BenchResults& results);

/// What gnuplot is told: data first, then the drawing into DIRECTORY/NAME.svg and .png.
std::string gnuplotScript(const Plot& plot, const std::string& directory);

/// Writes DIRECTORY/plots.gnuplot and draws with it. False when there is no gnuplot or it failed; the rest goes on.
Result<bool> drawPlots(const std::vector<Plot>& plots, const std::string& directory);

}  // namespace limn::bench
