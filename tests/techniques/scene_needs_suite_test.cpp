// Every need of a scene, for every technique: the first object that has it turns its work on, removing the last turns
// it off, and the status says so of each, and of the pipelines that are at work.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "renderer/techniques/technique.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kRed = 1;  // material of the box and of one wall
constexpr const char* kTailored = "pipelines tailored to the scene";
constexpr const char* kForMore = "pipelines tailored to more than the scene";
constexpr const char* kGeneral = "pipelines for any scene";

/// Three walls with images that nothing shines through yet: a sky of no radiance, bumps under a coat that is not there.
Scene baseScene() {
  Scene scene = plainScene();
  const RichScene rich = richScene();
  scene.images = rich.scene.images;
  scene.environment.image = rich.scene.environment.image;
  scene.materials[kRed].clearcoatNormalTexture.image = 1;
  return scene;
}

Edit red(const std::function<void(SetMaterial&)>& set) {
  SetMaterial edit;
  edit.material = kRed;
  set(edit);
  return edit;
}
Edit lamp(float intensity) {
  SetLight edit;
  edit.intensity = intensity;
  return edit;
}
Edit sky(float radiance) {
  SetEnvironment edit;
  edit.radiance = glm::vec3(radiance);
  return edit;
}
/// A surface of metal, or none.
Edit metal(float metallic, float roughness) {
  return red([&](SetMaterial& e) { e.metallic = metallic, e.roughness = roughness; });
}

/// What a client does to bring a need into the scene and to take it away: an edit, or another file.
struct NeedCase {
  const char* need;
  Edit on, off;
  std::function<void(Scene&)> loadOn = {};  ///< set: the edits are not used
};

std::vector<NeedCase> needCases() {
  const auto with = [](auto set) { return red(set); };
  const Edit none = metal(0.0f, 1.0f);
  return {
      {"punctualLights", lamp(3.0f), lamp(0.0f)},
      {"emissiveTriangles", with([](auto& e) { e.emission = glm::vec3(2.0f); }),
       with([](auto& e) { e.emission = glm::vec3(0.0f); })},
      {"environment", sky(0.5f), sky(0.0f)},
      {"environmentImage", sky(0.5f), sky(0.0f)},
      {"textures", none, none, [](Scene& s) { s.materials[kRed].baseColorTexture.image = 0; }},
      {"normalMaps", with([](auto& e) { e.clearcoat = 1.0f; }), with([](auto& e) { e.clearcoat = 0.0f; })},
      {"alpha", with([](auto& e) { e.alphaMode = AlphaMode::blend, e.baseColor = glm::vec4(0.6f, 0.1f, 0.1f, 0.5f); }),
       with([](auto& e) { e.alphaMode = AlphaMode::opaque; })},
      {"transmission", with([](auto& e) { e.transmission = 1.0f; }), with([](auto& e) { e.transmission = 0.0f; })},
      {"panes", with([](auto& e) { e.transmission = 1.0f, e.roughness = 0.0f; }),
       with([](auto& e) { e.transmission = 0.0f, e.roughness = 1.0f; })},
      {"clearcoat", with([](auto& e) { e.clearcoat = 1.0f; }), with([](auto& e) { e.clearcoat = 0.0f; })},
      {"glossy", with([](auto& e) { e.specular = 1.0f; }), with([](auto& e) { e.specular = 0.0f; })},
      {"mirror", metal(1.0f, 0.0f), none},
      {"sharp", metal(1.0f, 0.3f), none},
      {"vertexColors", none, none, [](Scene& s) {
         Primitive& wall = s.meshes[0].primitives[0];
         wall.colors.assign(wall.positions.size(), glm::vec4(0.5f));
       }},
      {"manyLights", none, none, [](Scene& s) {
         Node shown = s.nodes[0];
         shown.light = 0, shown.mesh = kNone;
         shown.children.clear();
         for (uint64_t i = 0; i <= kFewLights; ++i) s.roots.push_back(uint32_t(s.nodes.size())), s.nodes.push_back(shown);
       }}};
}

bool isIn(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

SessionConfig quick(const std::string& technique) {
  SessionConfig config = smallPicture(48, 32);
  config.technique = technique;
  for (const ParameterInfo& p : findTechnique(technique)->parameters)
    if (p.name == "points") config.parameters.push_back({p.name, p.minimum});
  return config;
}

/// One session a technique, so that each compiles once; made at first use, gone before the device is.
class Sessions : public testing::Environment {
 public:
  void TearDown() override { s_made.clear(); }
  static TestSession& of(const std::string& technique) {
    auto& made = s_made[technique];
    if (!made) made = std::make_unique<TestSession>(baseScene(), quick(technique));
    return *made;
  }

 private:
  static inline std::map<std::string, std::unique_ptr<TestSession>> s_made;
};
testing::Environment* const kSessions = testing::AddGlobalTestEnvironment(new Sessions);

void load(TestSession& session, Scene scene) {
  LoadRequest request;
  request.loaded = std::make_shared<LoadedScene>(LoadedScene{std::move(scene), {}});
  session.ask(std::move(request));
  session.run(1);
}

class SceneNeedsSuite : public testing::TestWithParam<std::tuple<std::string, size_t>> {
 protected:
  TestSession& session() { return Sessions::of(std::get<0>(GetParam())); }
  NeedCase needCase() const { return needCases()[std::get<1>(GetParam())]; }

  /// Every flag of the scene's needs is in one list and not in the other, and so is every pass of the technique.
  void expectTold() {
    const Status status = session().status();
    const SceneNeeds needs = sceneNeeds(session().scene());
    for (const auto& [name, flag] : sceneNeedFlags()) {
      EXPECT_EQ(isIn(status.ran, std::string("scene: ") + name), needs.*flag) << name;
      EXPECT_EQ(isIn(status.leftOut, std::string("scene: ") + name), !(needs.*flag)) << name;
    }
    for (const PassUse& pass : session()->technique().passes()) {
      EXPECT_EQ(isIn(status.ran, pass.name), pass.ran) << pass.name;
      EXPECT_EQ(isIn(status.leftOut, pass.name), !pass.ran) << pass.name;
    }
    EXPECT_EQ(isIn(status.ran, kTailored) + isIn(status.ran, kForMore) + isIn(status.ran, kGeneral), 1);
  }
  void expectNeed(bool on) {
    const std::string name = std::string("scene: ") + needCase().need;
    const Status status = session().status();
    EXPECT_EQ(isIn(status.ran, name), on);
    EXPECT_EQ(isIn(status.leftOut, name), !on);
    expectTold();
  }
};

TEST_P(SceneNeedsSuite, TheFirstTurnsItOnAndRemovingTheLastTurnsItOff) {
  const NeedCase c = needCase();
  const auto turn = [&](bool on) {
    if (!c.loadOn) return session().apply({on ? c.on : c.off}), session().run(1);
    Scene scene = plainScene();
    scene.images = baseScene().images;
    if (on) c.loadOn(scene);
    load(session(), scene);
  };
  turn(false);
  expectNeed(false);
  const uint64_t without = session().hash();
  turn(true);
  expectNeed(true);
  EXPECT_NE(session().hash(), without);
  turn(false);
  expectNeed(false);
  EXPECT_EQ(session().hash(), without) << "nothing of it stays";
  if (c.loadOn || c.need == std::string("punctualLights")) load(session(), baseScene());
}

std::vector<std::string> techniqueNames() {
  std::vector<std::string> names;
  for (const TechniqueInfo& info : techniqueInfos()) names.push_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, SceneNeedsSuite,
                         testing::Combine(testing::ValuesIn(techniqueNames()),
                                          testing::Range(size_t(0), sceneNeedFlags().size())),
                         [](const auto& parameter) {
                           std::string name = std::get<0>(parameter.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name + "_" + needCases()[std::get<1>(parameter.param)].need;
                         });

TEST(SceneNeedsCases, ThereIsOneForEveryFlag) {
  const std::vector<NeedCase> cases = needCases();
  ASSERT_EQ(cases.size(), sceneNeedFlags().size());
  for (size_t i = 0; i < cases.size(); ++i) EXPECT_STREQ(cases[i].need, sceneNeedFlags()[i].name);
}

class PipelinesSuite : public testing::TestWithParam<std::string> {
 protected:
  TestSession& session() { return Sessions::of(GetParam()); }
  void expectAtWork(const char* variant) {
    const std::vector<std::string> ran = session().status().ran;
    EXPECT_TRUE(isIn(ran, variant)) << testing::PrintToString(ran);
  }
};

TEST_P(PipelinesSuite, TheStatusSaysWhichAreAtWorkAndTheyAreCutToTheSceneWhenNobodyLooks) {
  load(session(), plainScene());
  const uint64_t plain = session().hash();
  expectAtWork(kTailored);
  session().apply({metal(1.0f, 0.2f)});
  session().run(1);
  expectAtWork(kGeneral);
  const uint64_t shiny = session().hash();

  ASSERT_TRUE(session().untilWarm());  // the other techniques
  const uint32_t before = device().pipelineStats().created;
  session().steps(3);
  EXPECT_EQ(device().pipelineStats().created, before) << "somebody may be looking";
  session().watch(false);
  session().untilIdle();
  EXPECT_GT(device().pipelineStats().created, before);
  EXPECT_FALSE(session().step()) << "once is enough";
  expectAtWork(kTailored);

  session().watch(true);
  session().apply({metal(0.0f, 1.0f)});
  session().run(1);
  expectAtWork(kForMore);
  EXPECT_EQ(session().hash(), plain);
  session().apply({metal(1.0f, 0.2f)});
  session().run(1);
  expectAtWork(kTailored);
  EXPECT_EQ(session().hash(), shiny) << "the same bits as from the pipelines that render anything";
}

TEST_P(PipelinesSuite, EverythingCanBeForcedOn) {
  SessionConfig config = quick(GetParam());
  config.allNeeds = true;
  TestSession forced(plainScene(), config);
  forced.run(1);
  const Status status = forced.status();
  for (const SceneNeedFlag& need : sceneNeedFlags())
    EXPECT_TRUE(isIn(status.ran, std::string("scene: ") + need.name)) << need.name;
  EXPECT_TRUE(isIn(status.ran, "everything, needed or not"));
  load(session(), plainScene());
  EXPECT_EQ(forced.hash(), session().hash()) << "the picture does not depend on it";
}

INSTANTIATE_TEST_SUITE_P(All, PipelinesSuite, testing::ValuesIn(techniqueNames()), [](const auto& parameter) {
  std::string name = parameter.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace limn::test
