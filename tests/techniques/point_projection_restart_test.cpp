// What an edit costs the point projection technique, what it shows first, and that nothing of an older state stays.
#include <gtest/gtest.h>

#include <functional>

#include "renderer/techniques/point_projection_impl.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/technique_pictures.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kBlock = 3;  ///< node of plainScene() that has the block

SessionConfig quick(Parameters more = {}) {
  SessionConfig config = pointProjection(48, 32, 2, 0, {{"points", 16384.0}});
  config.parameters.insert(config.parameters.end(), more.begin(), more.end());
  return config;
}

/// Quanta as small as work can be cut, so that edits come in the middle of everything.
SessionConfig smallestQuanta() {
  SessionConfig config = quick();
  config.quantumSeconds = config.firstFrameSeconds = 1e-6;
  config.frameSeconds = 0.0;
  return config;
}

template <class T>
Edit with(std::function<void(T&)> set) {
  T edit;
  set(edit);
  return edit;
}
Edit parameter(const char* name, double value) { return SetTechnique{std::nullopt, {{name, value}}}; }
Edit intensity(float value) {
  return with<SetLight>([=](auto& e) { e.intensity = value; });
}
Edit blockAt(double x) {
  return with<SetNodeTransform>([=](auto& e) { e.node = kBlock; e.translation = glm::dvec3(x, 0.0, 0.0); });
}
Edit viewFrom(double x) {
  SetView e{plainScene().view};
  e.view.eye.x = x;
  return e;
}

const PointProjectionWork& workOf(TestSession& session) {
  return dynamic_cast<const PointProjectionTechnique&>(session->technique()).work();
}

struct Row {
  const char* name;
  Edit edit;
  bool gathers, lights, places, samples;  ///< of points: anew by rays; put somewhere else; chosen anew
};

std::vector<Row> rows() {
  const auto color = [](auto& e) { e.material = 1; e.baseColor = glm::vec4(0.2f, 0.3f, 0.6f, 1.0f); };
  return {{"exposure", SetResolve{1.0f, std::nullopt}, false, false, false, false},
          {"camera", viewFrom(0.4), true, false, false, false},
          {"size", SetImageSize{40, 32}, true, false, false, false},
          {"projections", parameter("projections", 600), true, false, false, false},
          {"threshold", parameter("threshold", 1.0), true, false, false, false},
          {"lambda", parameter("lambda", 1.0), true, false, false, false},
          {"startGrid", parameter("startGrid", 8), true, false, false, false},
          {"filterSize", parameter("filterSize", 3), true, false, false, false},
          {"light", intensity(5.0f), true, true, false, false},
          {"environment", SetEnvironment{glm::vec3(0.2f), std::nullopt}, true, true, false, false},
          {"material", with<SetMaterial>(color), true, true, false, false},
          {"microSize", parameter("microSize", 16), true, true, false, false},
          {"bounces", parameter("bounces", 3), true, true, false, false},
          {"relightSamples", parameter("relightSamples", 2), true, true, false, false},
          {"object", blockAt(0.2), true, true, true, false},
          {"clusters", parameter("clusters", 128), true, true, true, false},
          {"points", parameter("points", 20000), true, true, true, true}};
}

TEST(PointProjectionRestart, EachEditRedoesWhatItMust) {
  TestSession session(plainScene(), quick());
  session.run(1);
  for (const Row& row : rows()) {
    SCOPED_TRACE(row.name);
    const PointProjectionWork before = workOf(session);
    session.apply({row.edit});
    session.run(1);
    const PointProjectionWork after = workOf(session);
    EXPECT_EQ(after.pixelsGathered > before.pixelsGathered, row.gathers);
    EXPECT_EQ(after.slotsLit > before.slotsLit, row.lights);
    EXPECT_EQ(after.pathSides > before.pathSides, row.lights);
    EXPECT_EQ(after.pointUpdates - before.pointUpdates, row.places ? 1u : 0u);
    EXPECT_EQ(after.blocksSampled > before.blocksSampled, row.samples);
  }
}

TEST(PointProjectionRestart, AnEditSaidAgainCostsNothing) {
  TestSession session(plainScene(), quick());
  for (const Row& row : rows()) {
    session.apply({row.edit});
    session.run(1);
    const uint64_t gathered = workOf(session).pixelsGathered;
    EXPECT_EQ(session.apply({row.edit}).cost, CostClass::none) << row.name;
    session.run(1);
    EXPECT_EQ(workOf(session).pixelsGathered, gathered) << row.name;
  }
}

TEST(PointProjectionRestart, APictureIsShownLongBeforeThePointsAreLit) {
  TestSession session(plainScene(), smallestQuanta());
  session.run(1);
  for (const Edit& edit : {intensity(4.0f), blockAt(0.1), viewFrom(0.3)}) {
    session.apply({edit});
    const uint64_t quantaBefore = session.status().quanta;
    const auto frame = session.nextFrame();
    const uint64_t first = session.status().quanta - quantaBefore;
    EXPECT_EQ(frame->info.phase, Phase::coarse);
    EXPECT_EQ(frame->info.steps, 0u);
    EXPECT_LT(frame->info.gatheredShare, 0.3f);
    int bright = 0;  // the block in the middle is lit, and no pixel is left out
    for (size_t y = 14; y < 22; ++y)
      for (size_t x = 20; x < 28; ++x) bright += frame->rgba[(y * 48 + x) * 4] > 0;
    EXPECT_EQ(bright, 64);
    while (session.published.back()->info.steps == 0) session.nextFrame();
    EXPECT_LT(first * 2, session.status().quanta - quantaBefore) << "the first picture waited for most of the pass";
  }
}

TEST(PointProjectionRestart, NoGhostWhereverTheWorkWasInterrupted) {
  const Scene a = plainScene();
  TestSession session(a, smallestQuanta());
  session.run(1);
  const std::vector<Edit> there{intensity(9.0f), blockAt(0.3), viewFrom(-0.4),
                                with<SetMaterial>([](auto& e) { e.baseColor = glm::vec4(0.1f, 0.9f, 0.2f, 1.0f); })};
  const std::vector<Edit> back{intensity(3.0f), blockAt(0.0), viewFrom(0.2),
                               with<SetMaterial>([](auto& e) { e.baseColor = glm::vec4(0.7f, 0.7f, 0.7f, 1.0f); })};
  session.apply(there);
  const uint64_t begin = session.status().quanta;
  session.run(2);
  const auto inTwoPasses = int(session.status().quanta - begin);
  EXPECT_GT(inTwoPasses, 100) << "the quanta are too long to interrupt anything";
  session.apply(back);
  ASSERT_EQ(session.scene().hash(), a.hash());
  const uint64_t expected = freshHash(a, quick(), 2);
  constexpr int kPlaces = 24;
  for (int i = 0; i < kPlaces; ++i) {
    const int quanta = i < 8 ? i : inTwoPasses * (i - 7) / (kPlaces - 8);
    // A single kind of edit keeps most of what there is; all together keep least.
    session.apply(i % 2 == 0 ? std::vector<Edit>{there[size_t(i / 2) % there.size()]} : there);
    session.steps(quanta);
    session.apply(back);
    session.steps(i % 3);
    session.run(2);
    EXPECT_EQ(session.hash(), expected) << "interrupted after " << quanta << " quanta of " << inTwoPasses;
  }
}

TEST(PointProjectionRestart, FineStartGridsSeeTheNewView) {
  for (const double stride : {2.0, 4.0, 8.0}) {
    const SessionConfig config = quick({{"startGrid", stride}});
    TestSession session(plainScene(), config);
    session.run(1);  // the points are lit
    session.apply({viewFrom(0.4)});
    session.run(1);
    EXPECT_EQ(session.hash(), freshHash(session.scene(), config, 1)) << stride;
  }
}

/// Without paths bounces are gathered at points, one after the other, as in the paper.
TEST(PointProjectionRestart, GatheredBouncesAreAskedEverywhereAndByTheRaysOfNow) {
  SessionConfig config = quick({{"paths", 0.0}, {"bounces", 4.0}});
  TestSession session(plainScene(), config);
  session.run(1);
  EXPECT_EQ(workOf(session).bounceSites % 3, 0u) << "a side that the first bounce left dark was not asked again";
  EXPECT_EQ(workOf(session).bounceSites / 3 % (2 * 256), 0u) << "a side of some cluster was left out";
  session.apply({parameter("correctionRays", 0.0)});
  session.run(1);
  config.parameters.push_back({"correctionRays", 0.0});
  EXPECT_EQ(session.hash(), freshHash(plainScene(), config, 1));
}

TEST(PointProjectionRestart, PointsThatStayAreNotIndexedAgain) {
  TestSession session(plainScene(), quick());
  session.run(1);
  const uint64_t before = workOf(session).pointIndices;
  session.apply({intensity(5.0f)});
  session.run(1);
  EXPECT_EQ(workOf(session).pointIndices, before);
  session.apply({blockAt(0.2)});
  session.run(1);
  EXPECT_EQ(workOf(session).pointIndices, before + 1);
}

}  // namespace
}  // namespace limn::test
