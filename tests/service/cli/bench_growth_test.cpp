// How growth and the cost of what a scene does not need are reported: plots, page, tables.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "server/limn/bench_options.hpp"
#include "server/limn/bench_page_parts.hpp"
#include "server/limn/bench_plots.hpp"

namespace limn::bench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Time doubles and memory stays while the size grows fourfold.
Growth growthOf(const std::string& technique) {
  Growth growth{technique, "points", {}, {}, {}, {}, {}};
  std::vector<Sample> time;
  for (const double size : {16.0, 64.0, 256.0}) {
    growth.points.push_back({size, std::sqrt(size), 2.0 * size, 30.0, 1.0});
    time.push_back({size, std::sqrt(size)});
  }
  growth.time = fitPower(time);
  return growth;
}

BenchResults resultsWithGrowth() {
  BenchResults results;
  results.growth = {growthOf("one"), growthOf("other")};
  return results;
}

TEST(BenchGrowth, TimeAndMemoryArePlottedWithTheirExponents) {
  const std::vector<Plot> plots = plotsOf(resultsWithGrowth());
  std::vector<std::string> names;
  for (const Plot& plot : plots) names.push_back(plot.name);
  ASSERT_THAT(names, ElementsAre("growth-points", "memory-points"));
  std::vector<std::string> titles;
  for (const Plot::Line& line : plots[0].lines) titles.push_back(line.title);
  EXPECT_THAT(titles, ElementsAre("one, to the 0.50", "one, first steps", "other, to the 0.50", "other, first steps"));
  ASSERT_EQ(plots[1].lines.size(), 2u);
  EXPECT_EQ(plots[1].lines[0].points.back().x, 256.0);
  EXPECT_EQ(plots[1].lines[0].points.back().y, 30.0);
}

TEST(BenchGrowth, NoTechniqueEndsBeforeItsStepsAreTimed) {
  for (const TechniqueInfo& technique : techniqueInfos()) {
    std::vector<std::pair<std::string, double>> parameters = parametersOf(technique, {{technique.name, "maxSamples", 4.0}});
    putOffTheEnd(parameters, technique);
    const auto isEnd = [](const auto& parameter) { return parameter.first == "maxSamples"; };
    ASSERT_EQ(std::count_if(parameters.begin(), parameters.end(), isEnd), 1) << technique.name;
    EXPECT_GE(std::find_if(parameters.begin(), parameters.end(), isEnd)->second, 65536.0) << technique.name;
  }
}

TEST(BenchGrowth, ThePageHasALineATechniqueAndAxis) {
  const std::string section = growthSection(resultsWithGrowth(), "nowhere");
  EXPECT_THAT(section, HasSubstr("<td>one</td><td>points</td><td>16</td><td>256</td><td>4</td><td>16</td><td>0.500 ± "));
  EXPECT_THAT(section, HasSubstr("<td>other</td>"));
  EXPECT_EQ(growthSection({}, "nowhere"), "");
}

TEST(BenchAblation, IsInThePageAndInTheTables) {
  BenchResults results;
  EXPECT_EQ(ablationSection(results), "");
  results.options.budgets = {{"1", 1.0, 0}};
  SceneResult scene;
  scene.name = "room";
  scene.ablations = {{"path-tracing", {0.25, 10.0}, {0.75, 12.0}}};
  scene.runs.resize(1);
  scene.runs[0].technique = "path-tracing";
  scene.runs[0].checkpoints.resize(1);
  results.scenes = {scene};
  EXPECT_THAT(ablationSection(results), HasSubstr("<td>room</td><td>path-tracing</td><td>0.25</td><td>0.75</td><td>3</td>"
                                                  "<td>10</td><td>12</td>"));
  const std::string csv = resultsCsv(results);
  EXPECT_THAT(csv, HasSubstr(",stepSeconds,stepSecondsAllNeeds\n"));
  EXPECT_THAT(csv, HasSubstr(",0.25,0.75\n"));
  EXPECT_THAT(resultsJson(results), HasSubstr("\"stepSecondsAllNeeds\":0.75"));
}

}  // namespace
}  // namespace limn::bench
