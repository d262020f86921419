#include "server/limn/render_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace limn {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;

/// A renderer whose passes take a second each of a clock of our own, and whose error is 1/steps, known to a fifth.
struct FakeRender {
  double clock = 100.0, passSeconds = 1.0, checkpointSeconds = 5.0;
  uint32_t steps = 0, convergesAt = 1000, failsAt = 1000, interruptedAt = 1000;
  std::vector<std::string> taken;

  RenderHooks hooks() {
    return {.pass = [this]() -> Result<PassState> {
              if (steps + 1 == failsAt) return Error{"device-lost", "gone", ""};
              if (steps < convergesAt) {
                ++steps;
                clock += passSeconds;
              }
              return PassState{steps, 1.0 / steps, 0.8 / steps, 1.2 / steps, steps == convergesAt};
            },
            .takeCheckpoint = [this](const CheckpointTaken& checkpoint) -> Result<void> {
              taken.push_back(checkpoint.request.text + "@" + std::to_string(checkpoint.state.steps));
              clock += checkpointSeconds;
              return {};
            },
            .now = [this] { return clock; },
            .interrupted = [this] { return steps >= interruptedAt; }};
  }
};

StopRule afterSeconds(double seconds) { return {seconds, {}, {}}; }

TEST(RenderLoop, StopsAtTheFirstEndOfAPassAfterTheTime) {
  FakeRender fake;
  const RenderOutcome outcome = renderUntil(afterSeconds(2.5), {}, fake.hooks()).value();
  EXPECT_EQ(outcome.state.steps, 3u);
  EXPECT_DOUBLE_EQ(outcome.seconds, 3.0);
}

TEST(RenderLoop, MakesOnePassHoweverShortTheTime) {
  FakeRender fake;
  EXPECT_EQ(renderUntil(afterSeconds(0.001), {}, fake.hooks())->state.steps, 1u);
}

TEST(RenderLoop, StopsAtTheSteps) {
  FakeRender fake;
  EXPECT_EQ(renderUntil({{}, 7, {}}, {}, fake.hooks())->state.steps, 7u);
}

TEST(RenderLoop, StopsWhenTheUpperEndOfTheIntervalIsAtTheError) {
  FakeRender fake;
  const RenderOutcome outcome = renderUntil({{}, {}, 0.2}, {}, fake.hooks()).value();
  EXPECT_EQ(outcome.state.steps, 6u);
  EXPECT_DOUBLE_EQ(outcome.state.errorHigh, 1.2 / 6.0);
}

TEST(RenderLoop, AnErrorThatIsNotKnownStopsNothing) {
  FakeRender fake;
  fake.convergesAt = 7;
  RenderHooks hooks = fake.hooks();
  hooks.pass = [pass = hooks.pass]() -> Result<PassState> {
    Result<PassState> state = pass();
    state->errorHigh = std::numeric_limits<double>::infinity();
    return state;
  };
  EXPECT_EQ(renderUntil({{}, {}, 1e6}, {}, hooks)->state.steps, 7u);
}

TEST(RenderLoop, ConvergenceEndsEveryRule) {
  for (const StopRule& rule : {StopRule{1000.0, {}, {}}, StopRule{{}, 1000, {}}, StopRule{{}, {}, 1e-9}, StopRule{}}) {
    FakeRender fake;
    fake.convergesAt = 4;
    const RenderOutcome outcome = renderUntil(rule, {}, fake.hooks()).value();
    EXPECT_EQ(outcome.state.steps, 4u);
    EXPECT_TRUE(outcome.state.converged);
  }
}

TEST(RenderLoop, ARendererThatMakesNoMorePassesEndsIt) {
  FakeRender fake;
  RenderHooks hooks = fake.hooks();
  hooks.pass = [] { return PassState{2, 0.5, 0.5, 0.5, false}; };
  EXPECT_EQ(renderUntil({}, {}, hooks)->state.steps, 2u);
}

TEST(RenderLoop, CheckpointsAreTakenAtTheFirstEndOfAPassAndCostNoTime) {
  FakeRender fake;
  const std::vector<CheckpointRequest> asked = {{"0.5", 0.5}, {"0.7", 0.7}, {"2.5", 2.5}, {"4", 4.0}};
  const RenderOutcome outcome = renderUntil(afterSeconds(4.0), asked, fake.hooks()).value();
  EXPECT_THAT(fake.taken, ElementsAre("0.5@1", "0.7@1", "2.5@3", "4@4"));
  EXPECT_DOUBLE_EQ(outcome.seconds, 4.0);
  std::vector<double> seconds;
  for (const CheckpointTaken& taken : outcome.checkpoints) seconds.push_back(taken.seconds);
  EXPECT_THAT(seconds, ElementsAre(DoubleEq(1.0), DoubleEq(1.0), DoubleEq(3.0), DoubleEq(4.0)));
}

TEST(RenderLoop, CheckpointsAfterConvergenceShowTheFinalFilm) {
  FakeRender fake;
  fake.convergesAt = 2;
  const std::vector<CheckpointRequest> asked = {{"1", 1.0}, {"10", 10.0}};
  const RenderOutcome outcome = renderUntil(afterSeconds(10.0), asked, fake.hooks()).value();
  EXPECT_THAT(fake.taken, ElementsAre("1@1", "10@2"));
  EXPECT_DOUBLE_EQ(outcome.checkpoints[1].seconds, 2.0);
}

TEST(RenderLoop, AnInterruptionEndsItAfterThePassWithoutTheLaterCheckpoints) {
  FakeRender fake;
  fake.interruptedAt = 3;
  const RenderOutcome outcome = renderUntil(afterSeconds(9.0), {{"3", 3.0}, {"5", 5.0}}, fake.hooks()).value();
  EXPECT_EQ(outcome.state.steps, 3u);
  EXPECT_TRUE(outcome.interrupted);
  EXPECT_THAT(fake.taken, ElementsAre("3@3"));
}

TEST(RenderLoop, AnInterruptionInTheLastPassIsNone) {
  FakeRender fake;
  fake.interruptedAt = 2;
  const RenderOutcome outcome = renderUntil({{}, 2, {}}, {{"5", 5.0}}, fake.hooks()).value();
  EXPECT_FALSE(outcome.interrupted);
  EXPECT_THAT(fake.taken, ElementsAre("5@2"));
}

TEST(RenderLoop, TheFirstErrorOfAPassEndsIt) {
  FakeRender fake;
  fake.failsAt = 3;
  EXPECT_EQ(renderUntil(afterSeconds(9.0), {}, fake.hooks()).error().code, "device-lost");
}

TEST(RenderLoop, ACheckpointThatIsNotWrittenIsNotedAndTheRenderGoesOn) {
  FakeRender fake;
  RenderHooks hooks = fake.hooks();
  hooks.takeCheckpoint = [](const CheckpointTaken& taken) -> Result<void> {
    return taken.request.text == "1" ? Result<void>(Error{"io", "disk full", ""}) : Result<void>();
  };
  const RenderOutcome outcome = renderUntil(afterSeconds(9.0), {{"1", 1.0}, {"2", 2.0}}, hooks).value();
  EXPECT_EQ(outcome.state.steps, 9u);
  ASSERT_EQ(outcome.checkpoints.size(), 2u);
  ASSERT_TRUE(outcome.checkpoints[0].failure);
  EXPECT_EQ(outcome.checkpoints[0].failure->message, "disk full");
  EXPECT_FALSE(outcome.checkpoints[1].failure);
}

}  // namespace
}  // namespace limn
