// `limn bench` as a program, on one small scene with a closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "protocol/json_value.hpp"
#include "renderer/techniques/technique_info.hpp"
#include "server/arguments.hpp"
#include "tests/service/cli/scratch_fixture.hpp"
#include "tests/support/environment_variable.hpp"

namespace limn {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kScene = LIMN_BUILD_DIR "/scenes/analytic-point.glb";
const std::string kNoisyScene = LIMN_BUILD_DIR "/scenes/cornell-point.glb";

/// References, too, are kept between the benchmarks of this program.
class Bench : public test::ScratchFixture {
 protected:
  static test::ProgramRun run(const std::string& output, std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"bench", "--output", file(output), "--size", "64x64", "--reference-seconds", "0.2",
                                 "--references", file("references")});
    return test::runProgram(LIMN_PROGRAM, flags);
  }

  struct Table {
    std::vector<std::string> columns;
    std::vector<std::map<std::string, std::string>> rows;
  };
  static Table table(const std::string& text) {
    Table read;
    for (const std::string& line : splitList(text, '\n')) {
      if (line.empty()) continue;
      const std::vector<std::string> fields = splitList(line, ',');
      if (read.columns.empty()) {
        read.columns = fields;
        continue;
      }
      EXPECT_EQ(fields.size(), read.columns.size()) << line;
      auto& row = read.rows.emplace_back();
      for (size_t i = 0; i < std::min(fields.size(), read.columns.size()); ++i) row[read.columns[i]] = fields[i];
    }
    return read;
  }
};

TEST_F(Bench, WritesATableAPageAndItsFigures) {
  const test::ProgramRun done = run("whole", {"--scenes", kScene, "--budgets", "0.05,0.02", "--seeds", "2",
                                           "--ablation"});
  ASSERT_EQ(done.exitCode, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("intervals hold the error"));

  const Table results = table(test::readText(file("whole/results.csv")));
  ASSERT_EQ(results.rows.size(), techniqueInfos().size() * 2 * 2);
  for (const auto& row : results.rows) {
    EXPECT_EQ(row.at("scene"), "analytic-point");
    EXPECT_GE(std::stod(row.at("seconds")), std::stod(row.at("budget")));
    EXPECT_TRUE(std::isfinite(std::stod(row.at("relMse"))));
    EXPECT_EQ(row.at("nonFinite"), "0");
    EXPECT_GT(std::stod(row.at("stepSeconds")), 0.0);
    EXPECT_GT(std::stod(row.at("stepSecondsAllNeeds")), 0.0);
  }
  EXPECT_EQ(results.rows[0].at("budget"), "0.02");
  EXPECT_EQ(results.rows[1].at("budget"), "0.05");

  const auto json = protocol::parseJson(test::readText(file("whole/results.json")), 16);
  ASSERT_TRUE(json.ok()) << json.error().text();
  const auto& scenes = *json->find("scenes")->array();
  ASSERT_EQ(scenes.size(), 1u);
  const auto& curves = *scenes[0].find("curves")->array();
  ASSERT_EQ(curves.size(), techniqueInfos().size());
  EXPECT_EQ(curves[0].find("points")->array()->size(), 2u);
  EXPECT_EQ(curves[0].find("secondsToError")->array()->size(), 5u);
  EXPECT_EQ(json->find("calibration")->array()->size(), techniqueInfos().size());
  const auto& ablation = *scenes[0].find("ablation")->array();
  ASSERT_EQ(ablation.size(), techniqueInfos().size());
  for (const auto& measured : ablation)
    EXPECT_GE(*measured.find("megabytesAllNeeds")->number(), *measured.find("megabytes")->number() * 0.99);

  const std::string page = test::readText(file("whole/index.html"));
  EXPECT_THAT(page, HasSubstr("</html>"));
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64,iVBORw0KGgo"));  // the first bytes of every PNG
  EXPECT_THAT(page, HasSubstr("seconds to relMSE"));
  EXPECT_THAT(page, HasSubstr("What leaving out saves"));
  EXPECT_THAT(page, Not(HasSubstr("src=\"http")));
  EXPECT_THAT(page, Not(HasSubstr("href=")));
}

TEST_F(Bench, PlotsAreDrawnInBothFormats) {
  ASSERT_EQ(run("plots", {"--scenes", kScene, "--steps", "2,4", "--seeds", "1"}).exitCode, 0);
  for (const std::string name : {"errors", "error-analytic-point", "samples"}) {
    EXPECT_THAT(test::readText(file("plots/" + name + ".svg")), HasSubstr("</svg>")) << name;
    EXPECT_TRUE(test::readText(file("plots/" + name + ".png")).starts_with("\x89PNG")) << name;
  }
  EXPECT_THAT(test::readText(file("plots/index.html")), HasSubstr("data:image/svg+xml;base64,"));
}

TEST_F(Bench, WithoutGnuplotThePageSaysSo) {
  const test::EnvironmentVariable path("PATH", file("nowhere"));
  const test::ProgramRun done = run("plain", {"--scenes", kScene, "--steps", "2", "--seeds", "1"});
  ASSERT_EQ(done.exitCode, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("gnuplot is not installed"));
  EXPECT_THAT(test::readText(file("plain/index.html")), HasSubstr("gnuplot is not installed"));
}

TEST_F(Bench, TheSamePassesAndSeedGiveTheSamePictures) {
  const std::vector<std::string> flags = {"--scenes", kScene, "--steps", "2,5", "--seeds", "2"};
  ASSERT_EQ(run("first", flags).exitCode, 0);
  ASSERT_EQ(run("second", flags).exitCode, 0);
  const Table first = table(test::readText(file("first/results.csv")));
  const Table second = table(test::readText(file("second/results.csv")));
  ASSERT_EQ(first.rows.size(), second.rows.size());
  ASSERT_GE(first.rows.size(), 4u);
  for (size_t i = 0; i < first.rows.size(); ++i) EXPECT_EQ(first.rows[i].at("filmHash"), second.rows[i].at("filmHash"));
  EXPECT_NE(first.rows[0].at("filmHash"), first.rows[2].at("filmHash")) << "another seed";
}

TEST_F(Bench, TheReferenceIsKeptAndGoesOn) {
  // Forty passes take about as long as the reference may: it cannot be twenty times better.
  const std::vector<std::string> flags = {"--scenes", kNoisyScene, "--steps", "40", "--seeds", "1"};
  double samples[2] = {}, noise[2] = {};
  for (size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(run("kept", flags).exitCode, 0);
    const auto json = protocol::parseJson(test::readText(file("kept/results.json")), 16);
    ASSERT_TRUE(json.ok());
    const auto* reference = json->find("scenes")->array()->front().find("reference");
    samples[i] = *reference->find("samples")->number();
    noise[i] = *reference->find("noise")->number();
    EXPECT_FALSE(*reference->find("fineEnough")->boolean());
    const double* missing = reference->find("secondsMissing")->number();
    EXPECT_TRUE(missing == nullptr || *missing > 0.0);  // null where its noise hides the smallest error
    EXPECT_THAT(test::readText(file("kept/index.html")), HasSubstr("Its time was over"));
  }
  EXPECT_GT(samples[0], 0.0);
  EXPECT_GT(samples[1], 1.2 * samples[0]);
  EXPECT_LT(noise[1], noise[0]);
}

TEST_F(Bench, AnErrorInALaterSceneKeepsTheReportOfTheEarlierOnes) {
  std::ofstream(file("late.glb")) << "not a scene";
  const std::vector<std::string> rest = {"--steps", "2", "--seeds", "1", "--techniques", "path-tracing"};
  std::vector<std::string> flags = {"--scenes", kScene + "," + file("late.glb")};
  flags.insert(flags.end(), rest.begin(), rest.end());
  const test::ProgramRun done = run("early", flags);
  EXPECT_EQ(done.exitCode, 1);
  EXPECT_THAT(done.err, HasSubstr("limn bench: late.glb: not JSON"));
  EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
  const Table results = table(test::readText(file("early/results.csv")));
  ASSERT_EQ(results.rows.size(), 1u);
  EXPECT_EQ(results.rows[0].at("scene"), "analytic-point");
  EXPECT_THAT(test::readText(file("early/index.html")), HasSubstr("The benchmark ended early. late.glb: not JSON"));
}

TEST_F(Bench, AnErrorInTheFirstSceneLeavesNoReport) {
  std::ofstream(file("bad.glb")) << "not a scene";
  EXPECT_EQ(run("none", {"--scenes", file("bad.glb"), "--steps", "2"}).exitCode, 1);
  EXPECT_FALSE(std::filesystem::exists(file("none/index.html")));
}

TEST_F(Bench, AReportThatCannotBeWrittenIsToldBeforeItIsMeasured) {
  std::filesystem::create_directories(file("taken/index.html"));
  const test::ProgramRun done = run("taken", {"--scenes", kScene, "--steps", "2"});
  EXPECT_EQ(done.exitCode, 1);
  EXPECT_EQ(done.out, "");
  EXPECT_THAT(done.err, HasSubstr("taken/index.html: is a directory"));
}

TEST_F(Bench, AnotherRenderersPicturesAreMeasuredToo) {
  const std::string picture = file("peer.exr");
  const std::vector<std::string> render = {"render", kScene, "--output", picture, "--size", "64x64", "--spp", "1"};
  ASSERT_EQ(test::runProgram(LIMN_PROGRAM, render).exitCode, 0);
  std::ofstream(file("list.csv")) << "scene,name,seconds,file\nanalytic-point,peer,1.5,peer.exr\n";
  const test::ProgramRun done =
      run("peers", {"--scenes", kScene, "--steps", "2", "--seeds", "1", "--pictures", file("list.csv")});
  ASSERT_EQ(done.exitCode, 0) << done.err;
  const Table results = table(test::readText(file("peers/results.csv")));
  const auto& last = results.rows.back();
  EXPECT_EQ(last.at("technique"), "peer");
  EXPECT_EQ(last.at("seconds"), "1.5");
  EXPECT_GT(std::stod(last.at("relMseAll")), 0.0);

  std::ofstream(file("bad.csv")) << "scene,name,seconds,file\nanalytic-point,peer,soon,peer.exr\n";
  const test::ProgramRun refused =
      run("peers", {"--scenes", kScene, "--steps", "2", "--seeds", "1", "--pictures", file("bad.csv")});
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_THAT(refused.err, HasSubstr("line 2"));
}

/// One good cell and one that breaks its promise of energy.
std::string hardCasesJson() {
  const auto figure = [](const char* name, double value, double bound) {
    return std::string("\"") + name + "\":{\"value\":" + std::to_string(value) + ",\"general\":" +
           std::to_string(bound) + ",\"good\":" + (value <= bound ? "true" : "false") + "}";
  };
  const auto cell = [&](const char* technique, double energy) {
    return std::string("{\"case\":\"twice <the> size\",\"claim\":\"looks the same\",\"technique\":\"") +
           technique + "\",\"unit\":\"sigma\",\"reason\":\"light is lost\",\"sound\":true,\"good\":" +
           (energy <= 1 ? "true" : "false") + "," + figure("deviation", 2, 4.5) + "," + figure("energy", energy, 1) +
           "," + figure("discarded", 0, 1e-5) + "," + figure("fireflies", 0, 1e-4) + "}";
  };
  return "{\"cells\":[" + cell("path-tracing", 0.5) + "," + cell("point-projection", 1.5) + "]}";
}

TEST_F(Bench, HardCasesAreATableWhereBadCellsAreMarked) {
  std::ofstream(file("hard.json")) << hardCasesJson();
  const std::vector<std::string> flags = {"--scenes", kScene, "--steps", "2", "--seeds", "1",
                                          "--hard-cases", file("hard.json")};
  const test::ProgramRun done = run("hard", flags);
  ASSERT_EQ(done.exitCode, 0) << done.err;
  const std::string page = test::readText(file("hard/index.html"));
  EXPECT_THAT(page, HasSubstr("1 of 2 cells keep every promise"));
  EXPECT_THAT(page, HasSubstr("<b>twice &lt;the> size</b><br>looks the same"));
  EXPECT_THAT(page, HasSubstr("<br>energy 0.5 (≤ 1)"));
  EXPECT_THAT(page, HasSubstr("<span class=\"bad\">energy 1.5 (≤ 1)</span>"));
  EXPECT_THAT(page, HasSubstr("light is lost"));
  EXPECT_THAT(test::readText(file("hard/results.json")), HasSubstr("\"hardCases\":[{\"case\":\"twice <the> size\""));

  std::ofstream(file("hard.json")) << "{\"cells\":[{\"case\":\"alone\"}]}";
  const test::ProgramRun refused = run("hard", flags);
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_THAT(refused.err, HasSubstr("#/cells/0"));
}

TEST_F(Bench, WrongUsageExits64WithOneLine) {
  for (const std::vector<std::string>& flags : std::vector<std::vector<std::string>>{
           {"--scenes", kScene, "--nonsense"},
           {"--scenes", kScene, "--budgets", "0.1,soon"},
           {"--scenes", kScene, "--budgets", "0.1,0.1"},
           {"--scenes", kScene, "--budgets", "1", "--steps", "1"},
           {"--scenes", kScene, "--steps", "0"},
           {"--scenes", kScene, "--seeds", "0"},
           {"--scenes", kScene, "--set", "maxBounces"}}) {
    const test::ProgramRun done = run("usage", flags);
    EXPECT_EQ(done.exitCode, 64) << flags.back();
    EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
  }
}

TEST_F(Bench, WhatIsNotThereExits1WithOneLine) {
  for (const std::vector<std::string>& flags :
       std::vector<std::vector<std::string>>{{"--scenes", "nowhere.glb"},
                                             {"--scenes", kScene, "--techniques", "magic"},
                                             {"--scenes", kScene, "--set", "path-tracing.magic=1"},
                                             {"--scenes", kScene, "--set", "path-tracing.maxBounces=-1"},
                                             {"--scenes", kScene, "--hard-cases", "nowhere.json"},
                                             {"--scenes", kScene, "--pictures", "nowhere.csv"}}) {
    const test::ProgramRun done = run("absent", flags);
    EXPECT_EQ(done.exitCode, 1) << flags.back();
    EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
  }
}

}  // namespace
}  // namespace limn
