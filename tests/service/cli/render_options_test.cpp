#include "server/limn/render_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "renderer/techniques/technique_info.hpp"
#include "server/limn/render_stats.hpp"
#include "tests/service/cli/run_program.hpp"

namespace limn {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Result<RenderOptions> options(std::vector<std::string> words) {
  words.insert(words.begin(), {"scene.glb", "--output", "out.exr"});
  const Result<Arguments> arguments = Arguments::parse(renderSpec(), words);
  return arguments ? renderOptions(*arguments) : Result<RenderOptions>(arguments.error());
}

TEST(RenderOptions, DefaultsAreSixtyFourSamplesAt512) {
  const Result<RenderOptions> o = options({});
  ASSERT_TRUE(o.ok()) << o.error().text();
  EXPECT_EQ(o->width, 512u);
  EXPECT_EQ(o->samples.count(), 64u);
  EXPECT_EQ(sessionConfig(*o).sampleCount, 64u);
  EXPECT_EQ(sessionConfig(*o).technique, techniqueInfos().front().name);
}

TEST(RenderOptions, EveryFlagReachesTheSession) {
  const Result<RenderOptions> o = options({"--size", "64x32", "--seed", "9", "--technique", "path-tracing", "--set",
                                           "maxBounces=3", "--samples", "16:48", "--aov", "depth,normal"});
  ASSERT_TRUE(o.ok()) << o.error().text();
  const SessionConfig config = sessionConfig(*o);
  EXPECT_EQ(config.width, 64u);
  EXPECT_EQ(config.height, 32u);
  EXPECT_EQ(config.seed, 9u);
  EXPECT_EQ(config.technique, "path-tracing");
  EXPECT_EQ(config.firstSample, 16u);
  EXPECT_EQ(config.sampleCount, 32u);
  std::map<std::string, double> parameters(config.parameters.begin(), config.parameters.end());
  EXPECT_EQ(parameters.at("maxBounces"), 3.0);
  EXPECT_EQ(parameters.at("adaptive"), 0.0) << "counted samples are not adaptive";
  EXPECT_THAT(o->layers, ElementsAre("depth", "normal"));
}

TEST(RenderOptions, TimedRendersKeepTheTechniquesOwnSampling) {
  const SessionConfig config = sessionConfig(options({"--time", "2.5"}).value());
  EXPECT_EQ(config.sampleCount, 0u);
  EXPECT_TRUE(config.parameters.empty());
  EXPECT_EQ(options({"--time", "2.5"})->stop.seconds, 2.5);
}

TEST(RenderOptions, CheckpointsAreSortedAndEndARenderWithoutARule) {
  const Result<RenderOptions> o = options({"--checkpoints", "0.5,0.1,0.25"});
  ASSERT_TRUE(o.ok()) << o.error().text();
  ASSERT_EQ(o->checkpoints.size(), 3u);
  EXPECT_EQ(o->checkpoints[0].text, "0.1");
  EXPECT_EQ(o->stop.seconds, 0.5);
  EXPECT_EQ(options({"--checkpoints", "0.5", "--spp", "4"})->stop.seconds, std::nullopt);
}

struct Refusal {
  std::vector<std::string> words;
  std::string code, says;
};

class RenderOptionsRefuse : public ::testing::TestWithParam<Refusal> {};

TEST_P(RenderOptionsRefuse, WithACodeAndAReason) {
  const Result<RenderOptions> o = options(GetParam().words);
  ASSERT_FALSE(o.ok());
  EXPECT_EQ(o.error().code, GetParam().code);
  EXPECT_THAT(o.error().text(), HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Table, RenderOptionsRefuse,
    ::testing::Values(
        Refusal{{"--size", "64"}, "usage", "WxH"}, Refusal{{"--seed", "-1"}, "usage", "--seed"},
        Refusal{{"--seed", "4294967296"}, "usage", "--seed"}, Refusal{{"--time", "0"}, "usage", "--time"},
        Refusal{{"--time", "soon"}, "usage", "--time"}, Refusal{{"--steps", "0"}, "usage", "--steps"},
        Refusal{{"--spp", "1.5"}, "usage", "--spp"}, Refusal{{"--until-error", "-1"}, "usage", "--until-error"},
        Refusal{{"--time", "1", "--spp", "4"}, "usage", "exclude each other"},
        Refusal{{"--samples", "8:8"}, "usage", "A:B"}, Refusal{{"--samples", "8"}, "usage", "A:B"},
        Refusal{{"--samples", "0:4294967296"}, "usage", "A:B"},
        Refusal{{"--samples", "8:16", "--spp", "12"}, "usage", "--spp"},
        Refusal{{"--samples", "8:16", "--set", "adaptive=1"}, "usage", "adaptive"},
        Refusal{{"--set", "maxBounces"}, "usage", "name=number"}, Refusal{{"--set", "=1"}, "usage", "name=number"},
        Refusal{{"--set", "maxBounces=many"}, "usage", "name=number"},
        Refusal{{"--set", "maxBounces=1", "--set", "maxBounces=2"}, "usage", "twice"},
        Refusal{{"--checkpoints", "1,x"}, "usage", "--checkpoints"},
        Refusal{{"--checkpoints", ","}, "usage", "at least one"},
        Refusal{{"--checkpoints", "3", "--time", "2"}, "usage", "after the end"},
        Refusal{{"--set", "colour=1"}, "unsupported", "no parameter 'colour'"},
        Refusal{{"--set", "maxBounces=-1"}, "out-of-range", "maxBounces"},
        Refusal{{"--technique", "crayon"}, "unsupported", "crayon"},
        Refusal{{"--aov", "smell"}, "unsupported", "smell"},
        Refusal{{"--stats", "/nonexistent/stats.json"}, "io", "/nonexistent: no such directory"},
        Refusal{{"--stats", "/proc"}, "io", "/proc: is a directory"},
        Refusal{{"--stats", "/proc/stats.json"}, "io", "/proc/stats.json: cannot be written"}));

TEST(RenderOptions, OutputsAreExrOrPng) {
  const auto with = [](const std::vector<std::string>& words) {
    const Result<Arguments> arguments = Arguments::parse(renderSpec(), words);
    return arguments ? renderOptions(*arguments) : Result<RenderOptions>(arguments.error());
  };
  EXPECT_TRUE(with({"s.glb", "--output", "o.png"})->png);
  EXPECT_EQ(with({"s.glb", "--output", "o.jpg"}).error().code, "usage");
  EXPECT_EQ(with({"s.glb", "--output", "o.png", "--aov", "depth"}).error().code, "usage");
  EXPECT_EQ(with({"s.glb", "--output", "o.png", "--samples", "0:4"}).error().code, "usage");
  EXPECT_EQ(with({"s.glb", "--output", "/proc/o.exr"}).error().code, "io");
  EXPECT_EQ(with({"s.glb"}).error().code, "usage");
  EXPECT_EQ(with({"--output", "o.png"}).error().code, "usage");
}

TEST(RenderOptions, CheckpointsThatCannotBeWrittenAreFoundBeforeTheRender) {
  const test::ScratchDirectory scratch;
  std::filesystem::create_directory(scratch.file("o.0.5s.exr"));
  const std::vector<std::string> words = {"s.glb", "--output", scratch.file("o.png"), "--checkpoints", "0.25,0.5"};
  const Result<RenderOptions> o = renderOptions(Arguments::parse(renderSpec(), words).value());
  ASSERT_FALSE(o.ok());
  EXPECT_EQ(o.error().text(), scratch.file("o.0.5s.exr") + ": is a directory");
}

Scene sceneWithCameras() {
  Scene scene;
  for (const char* name : {"front", "1", "unplaced"}) {
    Camera camera;
    camera.name = name;
    scene.cameras.push_back(camera);
  }
  for (int32_t i = 0; i < 2; ++i) {
    Node node;
    node.camera = i;
    node.parentFromLocal.translation = {10.0 + i, 0.0, 0.0};
    scene.nodes.push_back(node);
    scene.roots.push_back(uint32_t(i));
  }
  scene.view.eye = {-1.0, 0.0, 0.0};
  return scene;
}

TEST(RenderOptions, CamerasAreFoundByNameThenByIndex) {
  const Scene scene = sceneWithCameras();
  EXPECT_EQ(findView(scene, "")->eye.x, -1.0);
  EXPECT_EQ(findView(scene, "front")->eye.x, 10.0);
  EXPECT_EQ(findView(scene, "0")->eye.x, 10.0);
  EXPECT_EQ(findView(scene, "1")->eye.x, 11.0);
}

TEST(RenderOptions, AbsentCamerasAreRefusedWithThoseThereAre) {
  const Scene scene = sceneWithCameras();
  for (const char* name : {"back", "3", "-1", "99999999999999999999"}) {
    const Result<View> view = findView(scene, name);
    ASSERT_FALSE(view.ok()) << name;
    EXPECT_THAT(view.error().text(), HasSubstr("0 'front', 1 '1', 2 'unplaced'"));
  }
  EXPECT_THAT(findView(scene, "unplaced").error().text(), HasSubstr("no node"));
  EXPECT_THAT(findView(Scene(), "0").error().text(), HasSubstr("none"));
}

TEST(RenderStats, CheckpointFilesStandBesideTheOutput) {
  EXPECT_EQ(checkpointFile("out.exr", "0.25"), "out.0.25s.exr");
  EXPECT_EQ(checkpointFile("a.b/still.v2.png", "1"), "a.b/still.v2.1s.exr");
}

}  // namespace
}  // namespace limn
