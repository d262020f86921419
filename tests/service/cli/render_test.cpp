#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <thread>

#include "protocol/json_value.hpp"
#include "renderer/base/clock.hpp"
#include "tests/service/child_process.hpp"
#include "tests/service/cli/render_fixture.hpp"
#include "tests/service/raw_client.hpp"

namespace limn {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class Render : public test::RenderFixture {
 protected:
  static std::string metadata(const FilmImage& image, const std::string& key) {
    for (const auto& [name, value] : image.metadata)
      if (name == key) return value;
    return "";
  }
  /// Asks until the file is there or patience ends.
  static bool appears(const std::string& name) {
    const double end = nowSeconds() + server::testing::RawClient::kPatience;
    while (!std::filesystem::exists(name) && nowSeconds() < end) std::this_thread::yield();
    return std::filesystem::exists(name);
  }
};

std::vector<std::string> layerNames(const FilmImage& image) {
  std::vector<std::string> names;
  for (const FilmLayer& layer : image.layers) names.push_back(layer.name);
  return names;
}

TEST_F(Render, PartsMergeToTheWholeUpToRounding) {
  const FilmImage whole = film("whole.exr", {"--spp", "8"});
  film("a.exr", {"--samples", "0:3"});
  film("b.exr", {"--samples", "3:8"});
  const test::ProgramRun merge =
      test::runProgram(LIMN_PROGRAM, {"merge", file("b.exr"), file("a.exr"), "--output", file("merged.exr")});
  ASSERT_EQ(merge.exitCode, 0) << merge.err;
  const FilmImage merged = readExr(file("merged.exr")).value();
  EXPECT_EQ(merged.find("samples")->data, whole.find("samples")->data);
  EXPECT_EQ(metadata(merged, "limn:samples"), "0:8");
  // Two roundings of a float (2^-24) a sample; cancellation cannot be worse, radiance is not negative.
  for (const char* layer : {"beauty", "direct"})
    for (size_t i = 0; i < whole.find(layer)->data.size(); ++i) {
      const float expected = whole.find(layer)->data[i];
      ASSERT_NEAR(merged.find(layer)->data[i], expected, 16.0 * 6e-8 * std::abs(expected)) << layer << " " << i;
    }
}

TEST_F(Render, TheSameCommandGivesTheSameBitsAndAnotherSeedOthers) {
  const FilmImage first = film("first.exr", {"--steps", "2", "--seed", "5"});
  const FilmImage again = film("again.exr", {"--steps", "2", "--seed", "5"});
  const FilmImage other = film("other.exr", {"--steps", "2", "--seed", "6"});
  for (const FilmLayer& layer : first.layers) EXPECT_EQ(layer.data, again.find(layer.name)->data) << layer.name;
  EXPECT_NE(first.find("beauty")->data, other.find("beauty")->data);
}

TEST_F(Render, StatisticsCheckpointsAndLayersAreAsAsked) {
  const FilmImage image = film("s.exr", {"--spp", "4", "--aov", "depth", "--stats", file("s.json"), "--checkpoints",
                                         "0.000001,1000"});
  EXPECT_THAT(layerNames(image), UnorderedElementsAre("beauty", "depth"));
  EXPECT_EQ(metadata(image, "limn:samples"), "0:4");
  EXPECT_EQ(metadata(readExr(file("s.0.000001s.exr")).value(), "limn:samples"), "0:1");
  EXPECT_EQ(metadata(readExr(file("s.1000s.exr")).value(), "limn:samples"), "0:4");

  const Result<protocol::JsonValue> stats = protocol::parseJson(test::readText(file("s.json")), 8);
  ASSERT_TRUE(stats.ok()) << stats.error().text();
  EXPECT_EQ(*stats->find("samples")->string(), "0:4");
  EXPECT_EQ(*stats->find("sceneHash")->string(), metadata(image, "limn:sceneHash"));
  for (const char* part : {"load", "build", "warmUp", "render", "write"})
    EXPECT_GT(*stats->find("seconds")->find(part)->number(), 0.0) << part;
  EXPECT_GT(*stats->find("raysPerSecond")->number(), 0.0);
  EXPECT_FALSE(stats->find("ran")->array()->empty());
  EXPECT_FALSE(stats->find("leftOut")->array()->empty());
  EXPECT_FALSE(stats->find("memory")->object()->empty());
  EXPECT_GT(*stats->find("stageMs")->find("trace")->number(), 0.0);
  EXPECT_TRUE(stats->find("figures")->object()->empty());
  const protocol::JsonValue::Array& checkpoints = *stats->find("checkpoints")->array();
  ASSERT_EQ(checkpoints.size(), 2u);
  EXPECT_LT(*checkpoints[0].find("seconds")->number(), *checkpoints[1].find("seconds")->number());
}

TEST_F(Render, ACheckpointThatTheDiskHasNoRoomForCostsNeitherThePictureNorTheStatistics) {
  ASSERT_EQ(run("warm.png", {"--steps", "1"}).exitCode, 0) << "pipelines are kept before room is short";
  // Room for a small PNG, not for a film with all its layers.
  const std::string shortOfRoom = "trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\"";
  const test::ProgramRun done = test::runProgram(
      "/bin/sh", {"-c", shortOfRoom, LIMN_PROGRAM, "render", kScene, "--output", file("full.png"), "--size", "24x20",
                  "--steps", "2", "--stats", file("full.json"), "--checkpoints", "0.000001,1000"});
  EXPECT_EQ(done.exitCode, 1);
  EXPECT_THAT(done.err, HasSubstr("full.0.000001s.exr: cannot be written: File too large; 2 of 2 checkpoints"));
  EXPECT_THAT(done.out, HasSubstr("samples 0:2"));
  EXPECT_TRUE(test::readText(file("full.png")).starts_with("\x89PNG"));
  EXPECT_FALSE(std::filesystem::exists(file("full.0.000001s.exr")));
  const Result<protocol::JsonValue> stats = protocol::parseJson(test::readText(file("full.json")), 8);
  ASSERT_TRUE(stats.ok()) << stats.error().text();
  const protocol::JsonValue& checkpoint = stats->find("checkpoints")->array()->front();
  EXPECT_THAT(*checkpoint.find("failure")->string(), HasSubstr("File too large"));
  EXPECT_FALSE(checkpoint.find("file"));
}

TEST_F(Render, ASignalEndsItWithThePictureSoFar) {
  for (const int number : {SIGINT, SIGTERM}) {
    const std::string name = "signal" + std::to_string(number);
    server::testing::ChildProcess process(
        LIMN_PROGRAM, {"render", kScene, "--output", file(name + ".exr"), "--size", "24x20", "--spp", "4000000000",
                       "--stats", file(name + ".json"), "--checkpoints", "0.000001,1000000"});
    ASSERT_TRUE(appears(file(name + ".0.000001s.exr")));
    process.signal(number);
    ASSERT_EQ(process.wait(), 128 + number) << process.errors();

    const Result<protocol::JsonValue> stats = protocol::parseJson(test::readText(file(name + ".json")), 8);
    ASSERT_TRUE(stats.ok()) << stats.error().text();
    EXPECT_TRUE(*stats->find("interrupted")->boolean());
    const std::string passes = std::to_string(uint64_t(*stats->find("steps")->number()));
    EXPECT_THAT(process.errors(), HasSubstr("limn render: interrupted after " + passes + " passes; "));
    EXPECT_EQ(metadata(readExr(file(name + ".exr")).value(), "limn:samples"), *stats->find("samples")->string());
    EXPECT_FALSE(std::filesystem::exists(file(name + ".1000000s.exr")));
  }
}

TEST_F(Render, APngIsWritten) {
  const test::ProgramRun done = run("view.png", {"--steps", "1"});
  ASSERT_EQ(done.exitCode, 0) << done.err;
  EXPECT_TRUE(test::readText(file("view.png")).starts_with("\x89PNG"));
}

TEST_F(Render, WhatCannotBeRenderedExits1WithOneLineAndLeavesNoFile) {
  const test::ProgramRun camera = run("camera.exr", {"--camera", "nobody"});
  EXPECT_EQ(camera.exitCode, 1);
  EXPECT_THAT(camera.err, HasSubstr("no camera 'nobody'"));
  EXPECT_EQ(std::count(camera.err.begin(), camera.err.end(), '\n'), 1) << camera.err;
  EXPECT_FALSE(std::filesystem::exists(file("camera.exr")));
  const test::ProgramRun absent =
      test::runProgram(LIMN_PROGRAM, {"render", "absent.glb", "--output", file("absent.exr")});
  EXPECT_EQ(absent.exitCode, 1);
  EXPECT_THAT(absent.err, HasSubstr("absent.glb"));
}

}  // namespace
}  // namespace limn
