// Flags of limn that only a run of the real program shows to work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/json_value.hpp"
#include "tests/service/cli/render_fixture.hpp"
#include "tests/service/service_fixture.hpp"
#include "tests/support/environment_variable.hpp"

namespace limn {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class Flags : public test::RenderFixture {
 protected:
  /// Metadata of a small picture rendered with these flags.
  static std::map<std::string, std::string> rendered(std::vector<std::string> flags) {
    flags.insert(flags.end(), {"--stats", file("out.json")});
    const FilmImage image = film("out.exr", std::move(flags));
    return {image.metadata.begin(), image.metadata.end()};
  }
  static double statistic(const std::string& name) {
    const Result<protocol::JsonValue> stats = protocol::parseJson(test::readText(file("out.json")), 8);
    EXPECT_TRUE(stats.ok());
    return stats ? *stats->find(name)->number() : -1.0;
  }
};

TEST_F(Flags, TechniqueAndItsParameters) {
  EXPECT_EQ(rendered({"--spp", "1"})["limn:technique"], "path-tracing");
  auto metadata = rendered({"--technique", "point-projection", "--set", "bounces=2", "--steps", "1"});
  EXPECT_EQ(metadata["limn:technique"], "point-projection");
  EXPECT_THAT(metadata["limn:parameters"], HasSubstr("bounces=2"));
}

TEST_F(Flags, TimeIsRenderedAtLeastSoLong) {
  EXPECT_GE(std::stod(rendered({"--time", "0.25"})["limn:seconds"]), 0.25);
}

TEST_F(Flags, UntilErrorStopsWhereTheEstimateIsBelow) {
  rendered({"--until-error", "0.25"});
  const double error = statistic("estimatedError");
  EXPECT_GT(error, 0.0);
  EXPECT_LE(error, 0.25);
}

TEST_F(Flags, CameraByNameAndByIndex) {
  const std::string first = rendered({"--spp", "1"})["limn:view"];
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(rendered({"--spp", "1", "--camera", "Camera"})["limn:view"], first);
  EXPECT_EQ(rendered({"--spp", "1", "--camera", "0"})["limn:view"], first);
}

TEST_F(Flags, SendGivesUpAfterItsTimeout) {
  server::testing::TestService service;
  service.renderer->hold(true);
  std::ofstream(file("script.jsonl")) << R"({"op":"set","target":"material","material":0,"roughness":0.25})" << '\n';
  const std::string url = "ws://127.0.0.1:" + std::to_string(service.port()) + "/ws";
  const test::ProgramRun run =
      test::runProgram(LIMN_PROGRAM, {"send", url, file("script.jsonl"), "--timeout", "0.25"});
  service.renderer->hold(false);
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_THAT(run.err, HasSubstr("script.jsonl:1: no answer to seq 2 within 0.25 s"));
}

TEST_F(Flags, DevicesAreListedByTheirIndex) {
  const test::ProgramRun run = test::runProgram(LIMN_PROGRAM, {"devices"});
  EXPECT_EQ(run.exitCode, 0) << run.err;
  EXPECT_THAT(run.out, StartsWith("0  "));
  for (const char* told : {"; driver ", "; Vulkan 1.", " GiB of its own memory; ray query: "})
    EXPECT_THAT(run.out, HasSubstr(told));
}

TEST_F(Flags, InfoTellsWhatTheFileHolds) {
  const test::ProgramRun run = test::runProgram(LIMN_PROGRAM, {"info", kScene});
  EXPECT_EQ(run.exitCode, 0) << run.err;
  for (const char* told : {"cornell-box.glb, hash ", "triangles: 38", "materials: 4", "0 Camera: perspective"})
    EXPECT_THAT(run.out, HasSubstr(told));
}

TEST_F(Flags, ALostDeviceIsExit75) {
  const test::EnvironmentVariable lose("LIMN_LOSE_DEVICE_AT", "3");
  const test::ProgramRun lost = run("lost.exr");
  EXPECT_EQ(lost.exitCode, 75);
  EXPECT_THAT(lost.err, HasSubstr("limn render: vkQueueSubmit2 failed with VK_ERROR_DEVICE_LOST"));
  EXPECT_FALSE(std::filesystem::exists(file("lost.exr")));
}

}  // namespace
}  // namespace limn
