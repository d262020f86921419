// Where the time went: what the statistics say about the work since the restart.
#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/techniques/technique.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/technique_pictures.hpp"

namespace limn::test {
namespace {

const StageTime* find(const std::vector<StageTime>& stages, const char* name) {
  const auto found = std::find_if(stages.begin(), stages.end(), [&](const StageTime& s) { return s.name == name; });
  return found == stages.end() ? nullptr : &*found;
}

void expectTimed(const Status& status, const std::vector<const char*>& names, bool timed) {
  for (const char* name : names) {
    const StageTime* stage = find(status.stages, name);
    EXPECT_EQ(stage != nullptr, timed) << name;
    EXPECT_TRUE(stage == nullptr || stage->ms > 0.0f) << name;
  }
}

SessionConfig fewPoints() { return pointProjection(48, 32, 2, 0, {{"points", 16384.0}}); }

const std::vector<const char*> kPoints{"sample points", "move points", "cluster points", "upload points"};
const std::vector<const char*> kLighting{"relight", "paths", "spread"};
/// Passes until all levels are gathered and filtered.
constexpr uint32_t kEveryStage = 16;
const std::vector<const char*> kPicture{"sites", "start grid", "level", "interpolate", "filter", "shade"};

TEST(StageTimes, EveryTechniqueTellsAndNoneTwice) {
  for (const TechniqueInfo& info : techniqueInfos()) {
    SCOPED_TRACE(info.name);
    SessionConfig config = smallPicture();
    config.technique = info.name;
    TestSession session(plainScene(), config);
    session.run(2);
    const Status status = session.status();
    std::vector<std::string> names;
    for (const StageTime& stage : status.stages) names.push_back(stage.name);
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
    expectTimed(status, {"build", "warmUp", "sample"}, true);

    // What the technique was timed at from outside holds its stages, but for what was done while it was prepared.
    double parts = 0.0;
    for (const StageTime& stage : session->technique().stages())
      if (std::find(kPoints.begin(), kPoints.end(), stage.name) == kPoints.end()) parts += stage.ms;
    EXPECT_GT(parts, 0.0);
    EXPECT_LE(parts, find(status.stages, "sample")->ms * 1.001);
  }
}

TEST(StageTimes, OfPointsAndOfTheirLightUntilTheyAreKept) {
  TestSession session(plainScene(), fewPoints());
  session.run(kEveryStage);
  expectTimed(session.status(), kPoints, true);
  expectTimed(session.status(), kLighting, true);
  expectTimed(session.status(), kPicture, true);

  SetView camera;
  camera.view = session.scene().view;
  camera.view.eye.x += 0.01;
  session.apply({camera});
  session.run(kEveryStage);
  expectTimed(session.status(), kPoints, false);
  expectTimed(session.status(), kLighting, false);
  expectTimed(session.status(), kPicture, true);
}

TEST(StageTimes, FiguresTellThePointsAndHowEvenTheyAre) {
  TestSession session(plainScene(), fewPoints());
  session.run(1);
  const Status status = session.status();
  ASSERT_EQ(status.figures.size(), 3u);
  EXPECT_EQ(status.figures[0], (std::pair<std::string, double>("points", 16384.0)));
  EXPECT_EQ(status.figures[1], (std::pair<std::string, double>("pointClusters", 256.0)));
  EXPECT_EQ(status.figures[2].first, "pointRelativeRadius");
  EXPECT_GE(status.figures[2].second, 0.6);
  EXPECT_LE(status.figures[2].second, 1.0);
}

}  // namespace
}  // namespace limn::test
