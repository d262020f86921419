// The progressive loop: a coarse picture first, never starved, idle when done, and answers to whoever asks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/techniques/technique_info.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kSide = 64;

/// Quanta of one workgroup, so that an edit finds the loop in the middle of a pass.
SessionConfig slowPicture() {
  SessionConfig config = smallPicture(kSide, kSide);
  config.quantumSeconds = 1e-6;
  config.firstFrameSeconds = 1e-6;  // shorter than any grid takes: the coarsest is shown first
  config.frameSeconds = 0.0;
  config.parameters = {{"maxBounces", 2.0}, {"adaptive", 0.0}};
  return config;
}

Edit viewFrom(double x) {
  SetView e;
  e.view = plainScene().view;
  e.view.eye.x = x;
  return e;
}

Edit intensity(float value) {
  SetLight e;
  e.intensity = value;
  return e;
}

class Loop : public testing::Test {
 protected:
  static void SetUpTestSuite() { s_session = std::make_unique<TestSession>(plainScene(), slowPicture()); }
  static void TearDownTestSuite() { s_session.reset(); }
  void SetUp() override {
    session().watch(true);
    load(plainScene());
    session().untilIdle(1);
    session().takeReplies();
    session().published.clear();
  }
  static TestSession& session() { return *s_session; }
  static uint32_t load(Scene scene) {
    LoadRequest request;
    request.loaded = std::make_shared<LoadedScene>(LoadedScene{std::move(scene), {}});
    const uint32_t seq = session().ask(std::move(request));
    session().run(0);
    return seq;
  }

 private:
  static inline std::unique_ptr<TestSession> s_session;
};

TEST_F(Loop, AfterAnEditTheFirstPictureIsCoarseAndTheNextAreFiner) {
  session().edit({viewFrom(0.1)});
  float share = 0.0f;
  Phase phase = Phase::coarse;
  for (int i = 0; i < 4; ++i) {
    const auto frame = session().nextFrame();
    if (i == 0) {
      EXPECT_EQ(frame->info.phase, Phase::coarse);
      EXPECT_LT(frame->info.gatheredShare, 0.3f);
    }
    EXPECT_GE(frame->info.gatheredShare, share);
    EXPECT_GE(frame->info.phase, phase);
    EXPECT_EQ(frame->rgba.size(), size_t(kSide) * kSide * 4);
    share = frame->info.gatheredShare;
    phase = frame->info.phase;
  }
  while (session().published.back()->info.phase == Phase::coarse) session().nextFrame();
  EXPECT_EQ(session().published.back()->info.gatheredShare, 1.0f);
  EXPECT_GE(session().published.back()->info.steps, 1u);
}

TEST_F(Loop, ACoarsePictureLeavesNoPixelUnfilled) {
  session().edit({viewFrom(0.2)});
  const auto frame = session().nextFrame();
  ASSERT_EQ(frame->info.phase, Phase::coarse);
  // The block in the middle is lit; a hole would be black.
  for (uint32_t y = kSide / 2 + 4; y < kSide / 2 + 12; ++y)
    for (uint32_t x = kSide / 2 - 4; x < kSide / 2 + 4; ++x) EXPECT_GT(frame->rgba[(size_t(y) * kSide + x) * 4], 0) << x << ' ' << y;
}

TEST_F(Loop, AnEditStormShowsEveryStateItAppliesAndNeverStarvesThePicture) {
  constexpr int kEdits = 400;
  // Nine quanta to the coarsest grid.
  std::vector<uint32_t> sent{session().edit({Edit(SetImageSize{192, 192})})};
  session().step();
  for (int i = 0; i < kEdits; ++i) {
    sent.push_back(session().edit({viewFrom(0.001 * i)}));
    session().step();
  }
  session().untilIdle(50);
  sent.push_back(session().edit({Edit(SetImageSize{kSide, kSide})}));
  sent.push_back(session().edit({viewFrom(0.0)}));
  session().nextFrame();
  std::vector<uint32_t> acked;
  size_t superseded = 0;
  for (const EditAck& ack : session().take<EditAck>()) {
    acked.push_back(ack.to.seq);
    superseded += ack.superseded;
  }
  std::sort(acked.begin(), acked.end());
  EXPECT_EQ(acked, sent) << "every edit has one ack, replaced ones too";
  EXPECT_GT(superseded, 0u) << "the loop was never busy: the storm tested nothing";
  const size_t states = sent.size() - superseded - 1;  // the last two are one state
  EXPECT_GE(session().published.size(), states) << "a picture of every state before the next restart";
  uint32_t newest = 0;
  for (const auto& frame : session().published) {
    ASSERT_FALSE(frame->info.applied.empty());
    EXPECT_GE(frame->info.applied[0].seq, newest);
    newest = frame->info.applied[0].seq;
  }
  EXPECT_EQ(newest, sent.back()) << "the last edit is what is shown in the end";
}

TEST_F(Loop, SceneEditsOfAStormAreNeverDropped) {
  for (int i = 0; i < 60; ++i) {
    session().edit({intensity(1.0f + 0.1f * float(i))});
    session().step();
  }
  session().untilIdle(50);
  const auto acks = session().take<EditAck>();
  EXPECT_EQ(acks.size(), 60u);
  for (const EditAck& ack : acks) EXPECT_FALSE(ack.superseded);
  EXPECT_FLOAT_EQ(session().scene().lights[0].intensity, 1.0f + 0.1f * 59.0f);
}

TEST_F(Loop, FramesNameTheNewestAppliedEditOfEveryClient) {
  const uint32_t first = session().edit({viewFrom(0.3)}, 5), second = session().edit({intensity(2.0f)}, 6);
  const auto frame = session().nextFrame();
  std::map<uint64_t, uint32_t> applied;
  for (const Origin& origin : frame->info.applied) applied[origin.client] = origin.seq;
  EXPECT_EQ(applied[5], first);
  EXPECT_EQ(applied[6], second);
}

TEST(LoopAtRest, AConvergedPictureCostsNothing) {
  SessionConfig config = slowPicture();
  config.sampleCount = 4;
  TestSession session(plainScene(), config);
  session.untilIdle();
  EXPECT_EQ(session.published.back()->info.phase, Phase::converged);
  EXPECT_FLOAT_EQ(session.published.back()->info.meanSamples, 4.0f);
  const uint64_t quanta = session.replies.status().quanta;
  const size_t frames = session.published.size();
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(session.step());
  EXPECT_EQ(session.status().quanta, quanta);
  EXPECT_EQ(session.published.size(), frames);
  // A display edit shows the samples that there are; nothing is sampled.
  session.edit({Edit(SetResolve{1.0f, std::nullopt})});
  session.untilIdle();
  EXPECT_EQ(session.published.size(), frames + 1);
  EXPECT_EQ(session.status().quanta, quanta);
  // Any other wakes it.
  session.edit({intensity(2.0f)});
  session.untilIdle();
  EXPECT_GT(session.status().quanta, quanta);
  EXPECT_EQ(session.published.back()->info.phase, Phase::converged);
}

TEST_F(Loop, UnwatchedItSleepsWhateverIsEdited) {
  session().watch(false);
  session().untilIdle(5);
  for (const Edit& edit : {viewFrom(0.4), intensity(4.0f), Edit(SetResolve{1.5f, std::nullopt})}) {
    session().edit({edit});
    const size_t frames = session().published.size();
    EXPECT_LE(session().untilIdle(100), 1) << "nobody looks, yet it works";
    EXPECT_EQ(session().take<EditAck>().size(), 1u);
    EXPECT_EQ(session().published.size(), frames);
  }
  session().watch(true);
  EXPECT_EQ(session().nextFrame()->info.phase, Phase::coarse);
}

TEST_F(Loop, AWaitIsAnsweredAlsoUnwatchedAndEditsStillComeIn) {
  session().watch(false);
  session().untilIdle(5);
  session().edit({intensity(3.0f)});
  const uint32_t wait = session().ask(WaitRequest{{}, 3});
  session().step();
  // A watcher who comes meanwhile is heard before the wait is over.
  const uint32_t edit = session().edit({viewFrom(0.5)});
  session().step();
  const auto acks = session().take<EditAck>();
  ASSERT_EQ(acks.size(), 2u);
  EXPECT_EQ(acks[1].to.seq, edit);
  EXPECT_LT(session().untilIdle(100000), 100000);
  const auto answers = session().take<WaitReply>();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].to.seq, wait);
  EXPECT_EQ(answers[0].steps, 3u);
  SessionConfig config = slowPicture();
  EXPECT_EQ(answers[0].filmHash, freshHash(session().scene(), config, 3));
}

TEST_F(Loop, ALoadReplacesTheSceneAndIsAnswered) {
  session().run(2);
  const uint64_t before = session().hash();
  Scene other = plainScene();
  other.materials[0].baseColor = glm::vec4(0.1f, 0.2f, 0.8f, 1.0f);
  other.name = "other";
  const uint32_t seq = load(other);
  const auto replies = session().take<LoadReply>();
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_EQ(replies[0].to.seq, seq);
  EXPECT_EQ(replies[0].scene->name, "other");
  EXPECT_EQ(session().scene().hash(), other.hash());
  session().run(2);
  EXPECT_NE(session().hash(), before);
}

TEST_F(Loop, ALoadThatFailedChangesNothing) {
  session().run(2);
  const uint64_t scene = session().scene().hash(), film = session().hash();
  const uint64_t restarts = session().status().restarts;
  session().ask(LoadRequest{});
  session().run(0);
  EXPECT_EQ(session().scene().hash(), scene);
  EXPECT_EQ(session().hash(), film);
  EXPECT_EQ(session().status().restarts, restarts);
}

TEST(LoopFigures, EveryTechniqueTellsItsSamplesAndItsError) {
  for (const TechniqueInfo& info : techniqueInfos()) {
    SCOPED_TRACE(info.name);
    SessionConfig config = smallPicture();
    config.technique = info.name;
    config.auditPathsPerPass = 3000;
    TestSession session(plainScene(), config);
    constexpr uint32_t kPasses = 3;
    session.run(kPasses);
    const Status status = session.status();
    EXPECT_GE(status.meanSamples, float(kPasses)) << "a pass takes one sample of every pixel at least";
    EXPECT_GT(status.estimatedError, 0.0f);
    EXPECT_LE(status.errorLow, status.estimatedError);
    EXPECT_GE(status.errorHigh, status.estimatedError);
    EXPECT_TRUE(std::isfinite(status.errorHigh));
  }
}

TEST_F(Loop, DescribeTellsWhatPanelsNeed) {
  session().edit({intensity(6.0f), Edit(SetResolve{0.5f, ToneMap::agx})});
  session().ask(DescribeRequest{});
  session().run(0);
  const auto replies = session().take<DescribeReply>();
  ASSERT_EQ(replies.size(), 1u);
  const SceneSummary& s = *replies[0].scene;
  EXPECT_EQ(s.hash, session().scene().hash());
  EXPECT_FLOAT_EQ(s.lights.at(0).intensity, 6.0f);
  EXPECT_EQ(s.resolve, (ResolveSettings{0.5f, ToneMap::agx}));
  EXPECT_EQ(s.width, kSide);
  EXPECT_EQ(s.parameters.size(), techniqueInfos().front().parameters.size());
}

TEST_F(Loop, WhatWasDescribedIsMadeAnewOnlyWhenItHasChanged) {
  std::shared_ptr<const SceneSummary> last;
  const auto described = [&] {
    for (int i = 0; i < 2; ++i) session().ask(DescribeRequest{});
    session().run(0);
    const auto replies = session().take<DescribeReply>();
    EXPECT_EQ(replies.size(), 2u);
    EXPECT_EQ(replies.front().scene, replies.back().scene) << "two who ask are told the same";
    EXPECT_NE(replies.back().scene, last) << "something was edited";
    return last = replies.back().scene;
  };
  SetNodeTransform moved;
  moved.translation = glm::dvec3(0.0, 50.0, 0.0);
  SetMaterial painted;
  painted.baseColor = glm::vec4(0.25f, 0.5f, 0.75f, 1.0f);
  for (const Edit& edit : {viewFrom(0.5), Edit(painted), intensity(7.0f), Edit(SetResolve{0.25f}), Edit(moved),
                           Edit(SetEnvironment{.radiance = glm::vec3(0.5f)})}) {
    session().edit({edit});
    const auto scene = described();
    EXPECT_EQ(scene->hash, session().scene().hash());
    const Bounds bounds = worldBounds(session().scene());
    EXPECT_EQ(scene->bounds.low, bounds.low);
    EXPECT_EQ(scene->bounds.high, bounds.high);
  }
}

}  // namespace
}  // namespace limn::test
