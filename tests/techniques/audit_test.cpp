// The audit of biased techniques: it tells their error, leaves the film alone, and costs only its share.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/rich_scene.hpp"
#include "tests/support/technique_pictures.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kPasses = 3, kPaths = 3000;  // a pass

SessionConfig audited(double share, uint32_t pathsPerPass = 0) {
  SessionConfig config = pointProjection(32, 32, 2, 0, {{"auditShare", share}});
  config.auditPathsPerPass = pathsPerPass;
  return config;
}

/// -1 without an audit.
float auditMs(const Status& status) {
  for (const StageTime& stage : status.stages)
    if (stage.name == "audit") return stage.ms;
  return -1.0f;
}

bool contains(const std::vector<std::string>& list, const std::string& wanted) {
  return std::find(list.begin(), list.end(), wanted) != list.end();
}

Edit shareOf(double share) {
  SetTechnique edit;
  edit.parameters = {{"auditShare", share}};
  return edit;
}

TEST(Audit, FilmNeverDependsOnIt) {
  const uint64_t without = freshHash(plainScene(), audited(0.0), kPasses);
  EXPECT_EQ(freshHash(plainScene(), audited(0.5), kPasses), without);
  EXPECT_EQ(freshHash(plainScene(), audited(0.05, kPaths), kPasses), without);
}

TEST(Audit, SameStepsGiveTheSameEstimate) {
  std::vector<Status> told;
  for (int i = 0; i < 2; ++i) {
    TestSession session(plainScene(), audited(0.05, kPaths));
    session.run(kPasses);
    told.push_back(session.status());
  }
  EXPECT_TRUE(std::isfinite(told[0].errorHigh));
  EXPECT_EQ(told[0].estimatedError, told[1].estimatedError);
  EXPECT_EQ(told[0].errorLow, told[1].errorLow);
  EXPECT_EQ(told[0].errorHigh, told[1].errorHigh);
}

TEST(Audit, WithoutItNothingIsSaidOfABiasedPicture) {
  TestSession session(plainScene(), audited(0.0, kPaths));
  session.run(kPasses);
  const Status status = session.status();
  EXPECT_TRUE(std::isinf(status.estimatedError));
  EXPECT_TRUE(std::isinf(status.errorHigh));
  EXPECT_EQ(auditMs(status), -1.0f);
  EXPECT_FALSE(contains(status.ran, "audit pixels"));
}

TEST(Audit, TheFirstWholePictureIsJudgedBeforeItsPassEnds) {
  SessionConfig config = audited(0.5);
  config.quantumSeconds = 1e-4;  // a pass takes many
  TestSession session(plainScene(), config);
  Status status = session.status();
  while (status.steps == 0 && std::isinf(status.errorHigh)) {
    session.step();
    status = session.status();
  }
  EXPECT_EQ(status.steps, 0u);
  EXPECT_TRUE(std::isfinite(status.estimatedError));
}

TEST(Audit, UnbiasedTechniquesHaveNone) {
  TestSession session(plainScene(), pathTracing(32, 32, 2, 8));
  session.run(8);
  EXPECT_EQ(auditMs(session.status()), -1.0f);
  EXPECT_TRUE(std::isfinite(session.status().errorHigh));
  for (const auto& [owner, bytes] : session.status().memory) EXPECT_NE(owner, "audit");
}

TEST(Audit, AnEditForgetsItAndExposureDoesNot) {
  TestSession session(plainScene(), audited(0.05, kPaths));
  session.run(kPasses);
  const float before = session.status().errorHigh;
  SetResolve brighter;
  brighter.exposure = 2.0f;
  session.apply({brighter});
  EXPECT_EQ(session.status().errorHigh, before);
  SetMaterial red;
  red.material = 0;
  red.baseColor = glm::vec4(0.9f, 0.1f, 0.1f, 1.0f);
  session.apply({red});
  EXPECT_TRUE(std::isinf(session.status().errorHigh));
  session.run(kPasses);
  TestSession fresh(session.scene(), audited(0.05, kPaths));
  fresh.run(kPasses);
  EXPECT_EQ(session.status().estimatedError, fresh.status().estimatedError);
}

TEST(Audit, AShareThatRisesMakesNoPipelineAndKeepsTheFilm) {
  TestSession session(plainScene(), audited(0.0));
  session.run(kPasses);
  const Status before = session.status();
  const EditAck ack = session.apply({shareOf(0.5)});
  EXPECT_EQ(ack.cost, CostClass::displayOnly);
  EXPECT_EQ(session.status().steps, kPasses);
  session.run(kPasses + 3);
  EXPECT_EQ(session.status().pipelinesCreated, before.pipelinesCreated);
  EXPECT_GT(auditMs(session.status()), 0.0f);
}

TEST(Audit, NothingRunsAfterThePictureHasConverged) {
  SessionConfig config = audited(0.5);
  config.sampleCount = kPasses;
  TestSession session(plainScene(), config);
  session.untilIdle();
  const Status before = session.status();
  EXPECT_EQ(before.phase, Phase::converged);
  EXPECT_FALSE(session.step());
  EXPECT_EQ(session.status().quanta, before.quanta);
  EXPECT_EQ(auditMs(session.status()), auditMs(before));
}

}  // namespace
}  // namespace limn::test
