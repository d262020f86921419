#include "server/limn/bench_page_parts.hpp"

#include <algorithm>
#include <filesystem>

#include "renderer/base/file_bytes.hpp"
#include "server/limn/bench_html.hpp"
#include "server/limn/bench_page.hpp"

namespace limn::bench {
namespace {

constexpr uint64_t kMostPlotBytes = 16u << 20;

std::string growthRow(const Growth& growth) {
  return row({escaped(growth.technique), escaped(growth.axis), number(growth.points.front().size, "%.0f"),
              number(growth.points.back().size, "%.0f"), number(growth.points.front().stepSeconds),
              number(growth.points.back().stepSeconds), fitText(growth.time), fitText(growth.first),
              number(growth.points.front().megabytes), number(growth.points.back().megabytes), fitText(growth.memory),
              fitText(growth.build)});
}

}  // namespace

std::string plot(const std::string& directory, const std::string& name, const std::string& caption) {
  const auto bytes = readFileBytes(std::filesystem::path(directory) / (name + ".svg"), kMostPlotBytes);
  if (!bytes) return "";
  return "<p><img alt=\"" + escaped(caption) + "\" src=\"data:image/svg+xml;base64," +
         base64(std::string(bytes->begin(), bytes->end())) + "\"></p>\n";
}

std::string fitText(const std::optional<PowerFit>& fit) {
  return fit ? number(fit->exponent, "%.3f") + " ± " + number(fit->exponentDeviation, "%.3f") : "–";
}

std::string growthSection(const BenchResults& results, const std::string& directory) {
  if (results.growth.empty()) return "";
  std::string text = "<h2>Growth</h2>\n<p>Exponents of power laws, with standard errors, fitted to made scenes of "
                     "which one size alone grows. The first steps hold what is done once: lighting of points, the first "
                     "gathers. Memory is the device's.</p>\n" +
                     header({"technique", "against", "from", "to", "s a step, smallest", "s a step, largest",
                             "exponent of it", "of the first steps", "MB, smallest", "MB, largest", "exponent of it",
                             "of the build"});
  std::vector<std::string> axes;
  for (const Growth& growth : results.growth) {
    if (growth.points.empty()) continue;
    text += growthRow(growth);
    if (std::find(axes.begin(), axes.end(), growth.axis) == axes.end()) axes.push_back(growth.axis);
  }
  text += "</table>\n";
  for (const std::string& axis : axes)
    text += plot(directory, "growth-" + axis, "seconds a step against " + axis) +
            plot(directory, "memory-" + axis, "device memory against " + axis);
  return text;
}

std::string ablationSection(const BenchResults& results) {
  std::string rows;
  for (const SceneResult& scene : results.scenes)
    for (const Ablation& a : scene.ablations)
      rows += row({escaped(scene.name), escaped(a.technique), number(a.needed.stepSeconds), number(a.all.stepSeconds),
                   number(a.all.stepSeconds / a.needed.stepSeconds), number(a.needed.megabytes),
                   number(a.all.megabytes)});
  if (rows.empty()) return "";
  return "<h2>What leaving out saves</h2>\n<p>The same steps with what the scene needs, and with everything at work "
         "that any scene may need: in turn, the quickest of " + number(kAblationRounds) + " each.</p>\n" +
         header({"scene", "technique", "s a step, as needed", "s a step, everything", "times as long", "MB, as needed",
                 "MB, everything"}) + rows + "</table>\n";
}

}  // namespace limn::bench
