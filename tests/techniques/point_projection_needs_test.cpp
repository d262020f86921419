// Work that a scene does not need is left out of point projection; one material turns it on and off again.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "renderer/techniques/technique.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/technique_pictures.hpp"

namespace limn::test {
namespace {

SessionConfig quick(Parameters more = {}) {
  SessionConfig config = pointProjection(48, 32, 2, 0, {{"points", 16384.0}});
  config.parameters.insert(config.parameters.end(), more.begin(), more.end());
  return config;
}

struct Feature {
  const char* name;
  std::vector<const char*> passes;
  std::function<void(SetMaterial&)> add;
};

std::vector<Feature> features() {
  return {
      {"rough metal", {"glossy gathers", "glossy lobes of points"}, [](auto& e) { e.metallic = 1.0f; e.roughness = 0.7f; }},
      {"mirror", {"rays through sharp lobes"}, [](auto& e) { e.metallic = 1.0f; e.roughness = 0.0f; }},
      {"glass", {"rays through sharp lobes"}, [](auto& e) { e.transmission = 1.0f; }},
      {"coat", {"rays through sharp lobes"}, [](auto& e) { e.clearcoat = 1.0f; }}};
}

/// An edit of the red walls.
Edit materialEdit(const std::function<void(SetMaterial&)>& set) {
  SetMaterial edit;
  edit.material = 1;
  set(edit);
  return edit;
}

/// Whether the status says of every pass that it ran, or of every one that it was left out.
void expectAtWork(const Status& status, const std::vector<const char*>& passes, bool atWork) {
  const auto isIn = [](const std::vector<std::string>& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const char* pass : passes) {
    EXPECT_EQ(isIn(status.ran, pass), atWork) << pass;
    EXPECT_EQ(isIn(status.leftOut, pass), !atWork) << pass;
  }
}

TEST(PointProjectionNeeds, OneMaterialTurnsWorkOnAndOffAndNothingIsCompiled) {
  TestSession session(plainScene(), quick());
  session.run(2);
  const uint64_t plain = session.hash();
  const vk::PipelineStats before = device().pipelineStats();
  for (const Feature& feature : features()) {
    SCOPED_TRACE(feature.name);
    expectAtWork(session.status(), feature.passes, false);
    session.apply({materialEdit(feature.add)});
    session.run(2);
    expectAtWork(session.status(), feature.passes, true);
    EXPECT_NE(session.hash(), plain);
    session.apply({materialEdit([](SetMaterial& e) {
      e.metallic = e.transmission = e.clearcoat = 0.0f;
      e.roughness = plainScene().materials[1].roughness;
    })});
    session.run(2);
    expectAtWork(session.status(), feature.passes, false);
    EXPECT_EQ(session.hash(), plain);
    EXPECT_EQ(device().pipelineStats().created, before.created);
    EXPECT_EQ(device().pipelineStats().firstUses, before.firstUses);
  }
}

TEST(PointProjectionNeeds, PipelinesThatServeAllGiveTheBitsOfThoseCutToTheScene) {
  TestSession session(plainScene(), quick());
  for (const Feature& feature : features()) {
    session.apply({materialEdit(feature.add)});
    session.run(2);
    EXPECT_EQ(session.hash(), freshHash(session.scene(), quick(), 2)) << feature.name;
  }
}

TEST(PointProjectionNeeds, ADiffuseSceneTracesNoRaysThroughLobes) {
  const auto raysOf = [](float roughness) {
    Scene scene = plainScene();
    scene.materials[1].metallic = 1.0f;
    scene.materials[1].roughness = roughness;
    TestSession session(scene, quick({{"bounces", 0.0}}));
    const uint64_t before = session->technique().raysTraced();
    session.run(1);
    return session->technique().raysTraced() - before;
  };
  // One ray to the surface and one to the light at most; a mirror's pixels go on.
  EXPECT_LE(raysOf(0.8f), 2u * 48 * 32);
  EXPECT_GT(raysOf(0.0f), raysOf(0.8f));
}

}  // namespace
}  // namespace limn::test
