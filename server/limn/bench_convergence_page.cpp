#include "server/limn/bench_html.hpp"
#include "server/limn/bench_page_parts.hpp"

namespace limn::bench {
namespace {

constexpr double kLeastRatio = 0.8, kMostRatio = 1.25;  // of variance between seeds over what is told
const std::string kHowConverged =
    "<h3>With every quotient, over many seeds</h3>\n<p>Squared error of an unbiased estimator falls as one over the "
    "samples while these are independent of each other: slope −1. A picture shows that only where the rare bright "
    "paths are met that make the mean. The 0.1 % largest quotients hold them: without these an error of few samples "
    "looks smaller than it is and the slope flatter, or steeper where more samples spread them thin. So here every "
    "quotient counts, over " +
    std::to_string(kConvergenceSide) + "x" + std::to_string(kConvergenceSide) + " pixels and many seeds, and the " +
    std::to_string(kMostSamples) +
    " samples of each seed are cut into consecutive blocks: at every length all samples count, and a bright path "
    "weighs alike. Standard errors are jackknifed over seeds; the reference's own noise has no part in the product of "
    "differences from its halves. The goal, −1 ± 0.05 within a standard error, is <b>met</b> or missed as said: by "
    "independent samples (<code>sobol=0</code>) it must be, and by the technique's own, scrambled Sobol points, "
    "<b>steeper</b> is better than asked, because they spread more evenly. The gain is the error of independent samples "
    "over that of as many Sobol points, at the most samples.</p>\n"
    "<p>The last columns: the variance between seeds, relative as relMSE is, over the error that the films estimate of "
    "themselves, at the most samples and both without the largest quotients. At 1 the seeds differ by as much as the "
    "error bar says, over 1 by more; 0.8 to 1.25 is the goal.</p>\n";

std::string slopeText(const std::optional<Slope>& slope) {
  return slope ? number(slope->exponent, "%.3f") + " ± " + number(slope->deviation, "%.3f") : "–";
}

std::string judged(const std::optional<Slope>& slope) {
  if (!slope) return "–";
  const SlopeVerdict verdict = judgeSlope(*slope);
  return marked(verdictName(verdict), verdict == SlopeVerdict::flatter);
}

std::string ratioText(const SeedSpread& spread) {
  const std::string text = number(spread.ratio(), "%.2f") + " ± " + number(spread.deviation, "%.2f");
  return marked(text, spread.ratio() < kLeastRatio || spread.ratio() > kMostRatio);
}

std::vector<std::string> cellsOf(const SceneResult& scene, const Convergence& c) {
  const std::optional<Slope> independent = c.independent ? c.independent->slopeAll : std::nullopt;
  std::vector<std::string> cells = {escaped(scene.name), escaped(c.technique), std::to_string(c.seeds),
                                    number(c.own.levels.front().relMseAll), number(c.own.levels.back().relMseAll),
                                    slopeText(independent), judged(independent), slopeText(c.own.slopeAll),
                                    judged(c.own.slopeAll), c.gain() ? number(*c.gain(), "%.2f") : "–",
                                    slopeText(c.own.slope)};
  if (c.spread)
    for (const std::string& cell : {number(c.spread->between), number(c.spread->told), ratioText(*c.spread)})
      cells.push_back(cell);
  cells.resize(14, "–");
  return cells;
}

}  // namespace

std::string convergenceSection(const BenchResults& results, const std::string& directory) {
  std::string rows;
  for (const SceneResult& scene : results.scenes)
    for (const Convergence& c : scene.convergences)
      if (!c.own.levels.empty()) rows += row(cellsOf(scene, c));
  if (rows.empty()) return "";
  const std::string first = number(double(kFewestSamples)), last = number(double(kMostSamples));
  return kHowConverged +
         header({"scene", "technique", "seeds", "relMSE of every quotient, " + first + " samples", last + " samples",
                 "slope, independent samples", "−1 ± 0.05", "slope, Sobol points", "−1 ± 0.05", "gain",
                 "slope without the largest", "variance between seeds", "told", "ratio"}) +
         rows + "</table>\n" + plot(directory, "convergence", "relMSE of every quotient over samples");
}

}  // namespace limn::bench
