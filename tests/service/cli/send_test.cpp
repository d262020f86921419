#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/service/cli/run_program.hpp"
#include "tests/service/service_fixture.hpp"

namespace limn {
namespace {

using server::testing::TestService;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kRoughness = R"({"op":"set","target":"material","material":0,"roughness":0.25})";

/// `limn send` against the real server with a fake renderer behind it.
class Send : public ::testing::Test {
 protected:
  explicit Send(uint32_t passes = 4) : m_service(options(passes)) {}

  test::ProgramRun send(const std::string& script, std::vector<std::string> flags = {}) {
    const std::string file = m_scratch.file("script.jsonl");
    std::ofstream(file) << script;
    flags.insert(flags.begin(), {"send", "ws://127.0.0.1:" + std::to_string(m_service.port()) + "/ws", file});
    return test::runProgram(LIMN_PROGRAM, flags);
  }
  std::string scratch(const std::string& name) const { return m_scratch.file(name); }
  std::vector<std::string> filesIn(const std::string& directory) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(directory)) names.push_back(entry.path().filename());
    return names;
  }

 private:
  static TestService::Options options(uint32_t passes) {
    TestService::Options options;
    options.renderer.passes = passes;
    return options;
  }

  test::ScratchDirectory m_scratch;
  TestService m_service;
};

/// The renderer answers edits, but no picture ever shows them.
class SendWithoutPictures : public Send {
 protected:
  SendWithoutPictures() : Send(0) {}
};

TEST_F(Send, PrintsOneLineAMessageWithItsCost) {
  const test::ProgramRun run = send(std::string(kRoughness) + "\n\n{\"op\":\"ping\"}\n{\"op\":\"describe\"}\n");
  ASSERT_EQ(run.exitCode, 0) << run.err;
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 3) << run.out;
  EXPECT_THAT(run.out, HasSubstr("line 1: set seq "));
  EXPECT_THAT(run.out, HasSubstr(": relight, "));
  EXPECT_THAT(run.out, HasSubstr("line 3: ping seq "));
  EXPECT_THAT(run.out, HasSubstr(" ms\n"));
  EXPECT_EQ(run.err, "");
}

TEST_F(Send, KeepsFramesAndSavedFiles) {
  const std::string directory = scratch("kept/deep");
  const test::ProgramRun run = send(std::string(kRoughness) + "\n{\"op\":\"save\"}\n", {"--save", directory});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  const std::vector<std::string> names = filesIn(directory);
  EXPECT_THAT(names, Contains(AllOf(StartsWith("save-"), EndsWith(".exr"))));
  EXPECT_THAT(names, Contains(StartsWith("frame-")));
  EXPECT_THAT(run.out, HasSubstr(" frames\n"));
}

TEST_F(Send, WaitsForConvergence) {
  const test::ProgramRun run = send(std::string(kRoughness) + "\n", {"--wait-error", "0.5"});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("end: wait seq "));
  EXPECT_THAT(run.out, HasSubstr(" steps, film "));
}

TEST_F(Send, WaitsForAnErrorThatTheScriptNames) {
  const test::ProgramRun run = send(std::string(kRoughness) + "\n{\"op\":\"wait\",\"error\":0.5}\n");
  ASSERT_EQ(run.exitCode, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("line 2: wait seq "));
}

TEST_F(Send, StopsAtTheFirstErrorReplyAndShowsItsText) {
  const test::ProgramRun run =
      send("\n{\"op\":\"set\",\"target\":\"material\",\"material\":99,\"roughness\":0.5}\n{\"op\":\"ping\"}\n");
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_THAT(run.err, HasSubstr("script.jsonl:2 seq 2 /material: no such material"));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_THAT(run.out, ::testing::Not(HasSubstr("ping")));
}

TEST_F(Send, AMistakeInTheScriptIsFoundBeforeConnecting) {
  const test::ProgramRun run = send(std::string(kRoughness) + "\n{\"op\":\"paint\"}\n");
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, HasSubstr("script.jsonl:2"));
}

TEST_F(Send, SaysGoodbyeWhenTheScriptDoes) {
  const test::ProgramRun run = send("{\"op\":\"ping\"}\n{\"op\":\"bye\"}\n");
  EXPECT_EQ(run.exitCode, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("line 2: bye"));
}

TEST_F(Send, NumbersEveryMessageAnewBetweenItsOwn) {
  // 1 is that of hello; frames, and with them acknowledgements that take numbers, come all the while.
  const std::string again = R"({"op":"set","seq":1,"target":"material","material":0,"roughness":0.25})";
  const std::string script = again + "\n{\"op\":\"wait\",\"seq\":9}\n" + again + "\n{\"op\":\"wait\",\"seq\":3}\n";
  const test::ProgramRun run = send(script, {"--save", scratch("kept")});
  EXPECT_EQ(run.exitCode, 0) << run.err;
  EXPECT_THAT(run.out, ::testing::Not(HasSubstr(" seq 1:")));
  EXPECT_THAT(run.out, HasSubstr("line 4: wait seq "));
}

TEST_F(SendWithoutPictures, AByeEndsTheWaitForTheLastOne) {
  const test::ProgramRun run = send(std::string(kRoughness) + "\n{\"op\":\"bye\"}\n", {"--save", scratch("kept")});
  EXPECT_EQ(run.exitCode, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, HasSubstr("kept: 0 frames"));
}

TEST_F(Send, WhatComesAfterTheByeIsRefusedWithItsLine) {
  const test::ProgramRun run = send("{\"op\":\"bye\"}\n{\"op\":\"ping\"}\n");
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_THAT(run.err, HasSubstr("script.jsonl:2: the connection ended with 1000"));
}

TEST_F(Send, UnreachableServersAndWrongAddressesAreTold) {
  const std::string script = scratch("empty.jsonl");
  std::ofstream(script) << "";
  EXPECT_EQ(test::runProgram(LIMN_PROGRAM, {"send", "ws://127.0.0.1:1/ws", script}).exitCode, 1);
  EXPECT_EQ(test::runProgram(LIMN_PROGRAM, {"send", "mailto:somebody", script}).exitCode, 64);
}

}  // namespace
}  // namespace limn
