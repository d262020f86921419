// The restart table of DESIGN.md section 3: what each edit costs, what is redone, and what every sample survives.
#include <gtest/gtest.h>

#include <functional>

#include "renderer/techniques/technique_info.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {
namespace {

const RichScene& rich() {
  static const RichScene kScene = richScene();
  return kScene;
}

/// One session for the whole file; every test loads the scene anew.
class Restart : public testing::Test {
 protected:
  static void SetUpTestSuite() { s_session = std::make_unique<TestSession>(rich().scene, smallPicture()); }
  static void TearDownTestSuite() { s_session.reset(); }

  void SetUp() override {
    LoadRequest load;
    load.loaded = std::make_shared<LoadedScene>(LoadedScene{rich().scene, {}});
    (void)session().ask(std::move(load));
    (void)session().edit({Edit(SetResolve{0.0f, ToneMap::pbrNeutral}), Edit(SetImageSize{32, 32})});
    session().run(kPasses);
    (void)session().takeReplies();
  }
  static TestSession& session() { return *s_session; }

  /// The ack of a batch, with what it did to the counters.
  struct Outcome {
    EditAck ack;
    uint64_t restarts = 0, blocksRebuilt = 0;
    uint32_t passesKept = 0;
  };
  static Outcome outcomeOf(std::vector<Edit> edits) {
    const Status before = session().status();
    Outcome outcome;
    outcome.ack = session().apply(std::move(edits));
    const Status after = session().status();
    outcome.restarts = after.restarts - before.restarts;
    outcome.blocksRebuilt = after.blocksRebuilt - before.blocksRebuilt;
    outcome.passesKept = after.steps;
    return outcome;
  }

  static constexpr uint32_t kPasses = 3;

 private:
  static inline std::unique_ptr<TestSession> s_session;
};

struct Row {
  const char* name;
  std::function<Edit()> edit;
  CostClass cost;
  uint64_t blocksRebuilt;
};

template <class T>
std::function<Edit()> with(std::function<void(T&)> set) {
  return [set] {
    T edit;
    set(edit);
    return Edit(std::move(edit));
  };
}

std::vector<Row> rows() {
  const RichScene& r = rich();
  const auto parameter = [](const char* name, double value) {
    return with<SetTechnique>([=](SetTechnique& e) { e.parameters.push_back({name, value}); });
  };
  return {
      {"Exposure", with<SetResolve>([](auto& e) { e.exposure = 1.0f; }), CostClass::displayOnly, 0},
      {"ToneMap", with<SetResolve>([](auto& e) { e.toneMap = ToneMap::aces; }), CostClass::displayOnly, 0},
      {"View", with<SetResolve>([](auto& e) { e.view = ResolveView::indirect; }), CostClass::displayOnly, 0},
      {"LightColor", with<SetLight>([&](auto& e) { e.light = r.point; e.color = glm::vec3(0.5f); }), CostClass::relight, 0},
      {"LightIntensity", with<SetLight>([&](auto& e) { e.light = r.spot; e.intensity = 5.0f; }), CostClass::relight, 0},
      {"Environment", with<SetEnvironment>([](auto& e) { e.radiance = glm::vec3(0.1f); }), CostClass::relight, 0},
      {"EnvironmentRotation", with<SetEnvironment>([](auto& e) { e.rotation = 1.0f; }), CostClass::relight, 0},
      {"EnvironmentImage", with<SetEnvironment>([](auto& e) { e.image = skyImage(3); }), CostClass::relight, 0},
      {"NoEnvironmentImage", with<SetEnvironment>([](auto& e) { e.image = nullptr; }), CostClass::relight, 0},
      {"BaseColor", with<SetMaterial>([&](auto& e) { e.material = r.floor; e.baseColor = glm::vec4(0.2f); }), CostClass::regather, 0},
      {"Roughness", with<SetMaterial>([&](auto& e) { e.material = r.metal; e.roughness = 0.7f; }), CostClass::regather, 0},
      {"Emission", with<SetMaterial>([&](auto& e) { e.material = r.lamp; e.emission = glm::vec3(1.0f); }), CostClass::regather, 0},
      {"AlphaModeRebuildsItsBlock", with<SetMaterial>([&](auto& e) { e.material = r.cutout; e.alphaMode = AlphaMode::opaque; }),
       CostClass::regather, 1},
      {"Camera", with<SetView>([&](auto& e) { e.view = r.scene.view; e.view.eye.x += 0.5; }), CostClass::regather, 0},
      {"ImageSize", with<SetImageSize>([](auto& e) { e.width = 40; e.height = 24; }), CostClass::regather, 0},
      {"MaxBounces", parameter("maxBounces", 5), CostClass::regather, 0},
      {"LeafTransform", with<SetNodeTransform>([&](auto& e) { e.node = r.glassNode; e.translation = glm::dvec3(0.1, 0, 0); }),
       CostClass::rebuild, 1},
      {"ParentTransformMovesItsChild",
       with<SetNodeTransform>([&](auto& e) { e.node = r.metalNode; e.translation = glm::dvec3(-0.5, -0.3, -0.2); }), CostClass::rebuild, 2},
  };
}

TEST_F(Restart, ABatchThatUndoesItselfCostsNothing) {
  SetTechnique few, many;
  few.parameters = {{"maxBounces", 5.0}};
  many.parameters = {{"maxBounces", 32.0}};
  const Outcome parameter = outcomeOf({few, many}), size = outcomeOf({SetImageSize{48, 40}, SetImageSize{32, 32}});
  const SetMaterial there{.material = 0, .roughness = 0.9f}, back{.material = 0, .roughness = rich().scene.materials[0].roughness};
  const Outcome scene = outcomeOf({there, back});
  for (const Outcome& outcome : {parameter, size, scene}) {
    EXPECT_EQ(outcome.ack.cost, CostClass::none);
    EXPECT_EQ(outcome.restarts, 0u);
    EXPECT_EQ(outcome.passesKept, kPasses);
  }
}

TEST_F(Restart, EachEditCostsItsClassAndRedoesNoMore) {
  for (const Row& row : rows()) {
    SCOPED_TRACE(row.name);
    SetUp();
    const Outcome first = outcomeOf({row.edit()});
    EXPECT_STREQ(costClassName(first.ack.cost), costClassName(row.cost));
    EXPECT_EQ(first.blocksRebuilt, row.blocksRebuilt);
    const bool restarts = row.cost > CostClass::displayOnly;
    EXPECT_EQ(first.restarts, restarts ? 1u : 0u);
    EXPECT_EQ(first.passesKept, restarts ? 0u : kPasses);
    // Said again it changes nothing, and nothing restarts.
    const Outcome again = outcomeOf({row.edit()});
    EXPECT_EQ(again.ack.cost, CostClass::none);
    EXPECT_EQ(again.restarts + again.blocksRebuilt, 0u);
    EXPECT_EQ(again.passesKept, first.passesKept);
    session().edit({Edit(SetTechnique{std::nullopt, {{"maxBounces", 32.0}}})});
  }
}

TEST_F(Restart, RevisionsTellWhatChanged) {
  const EditAck before = session().apply({});
  const EditAck light = session().apply({with<SetLight>([](auto& e) { e.intensity = 9.0f; })()});
  EXPECT_EQ(light.sceneRevision, before.sceneRevision + 1);
  EXPECT_EQ(light.viewRevision, before.viewRevision);
  const EditAck view = session().apply({with<SetView>([](auto& e) { e.view = rich().scene.view; e.view.eye.y += 0.1; })()});
  EXPECT_EQ(view.sceneRevision, light.sceneRevision);
  EXPECT_EQ(view.viewRevision, before.viewRevision + 1);
  const EditAck display = session().apply({Edit(SetResolve{2.0f, std::nullopt})});
  EXPECT_EQ(display.sceneRevision, view.sceneRevision);
  EXPECT_EQ(display.viewRevision, view.viewRevision);
}

TEST_F(Restart, ADisplayEditKeepsEverySampleAndShowsThemAnew) {
  const uint64_t hash = session().hash();
  const auto before = must(session()->resolveFrame());
  session().apply({Edit(SetResolve{2.0f, ToneMap::linear})});
  EXPECT_EQ(session().hash(), hash);
  EXPECT_NE(must(session()->resolveFrame())->rgba, before->rgba);
}

TEST_F(Restart, ABatchCostsItsDearestEditAndRestartsOnce) {
  const Outcome outcome = outcomeOf({Edit(SetResolve{1.0f, std::nullopt}), with<SetLight>([](auto& e) { e.intensity = 2.5f; })(),
                                     with<SetNodeTransform>([](auto& e) { e.node = rich().glassNode; e.scale = glm::dvec3(0.5); })()});
  EXPECT_EQ(outcome.ack.cost, CostClass::rebuild);
  EXPECT_EQ(outcome.restarts, 1u);
  EXPECT_EQ(outcome.blocksRebuilt, 1u);
}

TEST_F(Restart, EditsThatWaitTogetherAreRedoneOnce) {
  const Status before = session().status();
  for (const float intensity : {1.5f, 2.5f, 3.5f}) session().edit({with<SetLight>([=](auto& e) { e.intensity = intensity; })()});
  session().run(0);
  EXPECT_EQ(session().take<EditAck>().size(), 3u);
  EXPECT_EQ(session().status().restarts, before.restarts + 1);
}

struct Mistake {
  const char* place;
  std::function<Edit()> edit;
};

TEST_F(Restart, OneBadEditOfABatchChangesNothingAndIsNamed) {
  const Mistake mistakes[] = {
      {"material", with<SetMaterial>([](auto& e) { e.material = 99; })},
      {"roughness", with<SetMaterial>([](auto& e) { e.roughness = 1.5f; })},
      {"light", with<SetLight>([](auto& e) { e.light = 7; })},
      {"node", with<SetNodeTransform>([](auto& e) { e.node = 1000; })},
      {"radiance", with<SetEnvironment>([](auto& e) { e.radiance = glm::vec3(-1.0f); })},
      {"view/up", with<SetView>([](auto& e) { e.view = rich().scene.view; e.view.up = glm::dvec3(0.0); })},
      {"exposure", with<SetResolve>([](auto& e) { e.exposure = 1000.0f; })},
      {"width", with<SetImageSize>([](auto& e) { e.width = 4; e.height = 32; })},
      {"height", with<SetImageSize>([](auto& e) { e.width = 32; e.height = 100000; })},
      {"technique", with<SetTechnique>([](auto& e) { e.technique = "crystal-ball"; })},
      {"parameters/nonsense", with<SetTechnique>([](auto& e) { e.parameters.push_back({"nonsense", 1.0}); })},
      {"parameters/maxBounces", with<SetTechnique>([](auto& e) { e.parameters.push_back({"maxBounces", 2.5}); })},
  };
  const uint64_t scene = session().scene().hash(), film = session().hash();
  const Status before = session().status();
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.place);
    const uint32_t seq = session().edit({with<SetLight>([](auto& e) { e.intensity = 77.0f; })(), Edit(SetImageSize{48, 48}), mistake.edit()});
    session().run(0);
    const std::vector<Reply> replies = session().takeReplies();
    ASSERT_EQ(replies.size(), 1u);
    const auto* error = std::get_if<ErrorReply>(&replies[0]);
    ASSERT_NE(error, nullptr);
    EXPECT_EQ(error->to.seq, seq);
    EXPECT_EQ(error->error.place, std::string("/edits/2/") + mistake.place);
    EXPECT_EQ(session().scene().hash(), scene);
    EXPECT_EQ(session().hash(), film);
  }
  const Status after = session().status();
  EXPECT_EQ(after.restarts, before.restarts);
  EXPECT_EQ(after.editsApplied, before.editsApplied);
  EXPECT_EQ(after.steps, before.steps);
}

TEST_F(Restart, AnEditOfABatchIsJudgedByWhatTheOnesBeforeItLeave) {
  const TechniqueInfo* other = nullptr;
  for (const TechniqueInfo& info : techniqueInfos())
    if (info.name != session().status().technique) other = &info;
  ASSERT_NE(other, nullptr);
  const auto choose = [](const std::string& name) { return Edit(SetTechnique{name, {}}); };
  const auto set = [](const std::string& name, double value) { return Edit(SetTechnique{std::nullopt, {{name, value}}}); };
  const auto cone = [](auto member, float angle) {
    return with<SetLight>([=](auto& e) { e.light = rich().spot; e.*member = angle; })();
  };
  const ParameterInfo& parameter = other->parameters.front();
  const std::string own = session().status().technique;
  const CostClass cost = session().apply({choose(other->name), set(parameter.name, parameter.maximum), choose(own),
                                          set("maxBounces", 3), cone(&SetLight::outerConeAngle, 0.9f),
                                          cone(&SetLight::innerConeAngle, 0.8f)}).cost;
  EXPECT_EQ(cost, CostClass::rebuild);
  EXPECT_EQ(session().status().technique, own);
  EXPECT_FLOAT_EQ(session().scene().lights[rich().spot].innerConeAngle, 0.8f);

  // Each is good alone: the cones cross, and the other technique has no such parameter.
  const uint64_t scene = session().scene().hash();
  const std::pair<std::vector<Edit>, const char*> mistakes[] = {
      {{cone(&SetLight::innerConeAngle, 0.7f), cone(&SetLight::outerConeAngle, 0.6f)}, "/edits/1/outerConeAngle"},
      {{set("maxBounces", 5), choose(other->name), set("rouletteStart", 2)}, "/edits/2/parameters/rouletteStart"}};
  for (const auto& [edits, place] : mistakes) {
    (void)session().edit(edits);
    session().run(0);
    const auto errors = session().take<ErrorReply>();
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].error.place, place);
    EXPECT_EQ(session().scene().hash(), scene);
    EXPECT_EQ(session().status().technique, own);
  }
}

TEST_F(Restart, NoEditMakesAPipeline) {
  ASSERT_TRUE(session().untilWarm());
  const vk::PipelineStats before = device().pipelineStats();
  const std::string own = session().status().technique;
  const auto choose = [](const std::string& name) {
    SetTechnique e{name, {}};
    for (const ParameterInfo& p : findTechnique(name)->parameters)
      if (p.name == "points") e.parameters.push_back({p.name, p.minimum});
    return Edit(e);
  };
  for (const TechniqueInfo& info : techniqueInfos())
    for (const std::string& name : {info.name, own}) {
      session().edit({choose(name)}), session().run(1);
      EXPECT_EQ(session().status().technique, name);
    }
  for (const Row& row : rows()) session().edit({row.edit()}), session().run(2);
  for (const uint32_t side : {64u, 16u, 48u}) session().edit({Edit(SetImageSize{side, side})}), session().run(3);
  // Away with every need, and back.
  const Scene scene = session().scene();
  for (uint32_t m = 0; m < scene.materials.size(); ++m) {
    session().edit({with<SetMaterial>([&](auto& e) { e.material = m; e.alphaMode = AlphaMode::blend; e.transmission = 0.0f; })()});
    session().edit({with<SetMaterial>([&](auto& e) { e.material = m; e.emission = glm::vec3(0.0f); e.clearcoat = 0.0f; })()});
    session().run(1);
  }
  session().edit({Edit(SetEnvironment{glm::vec3(0.0f), 0.0f})});
  session().steps(20);
  (void)must(session()->resolveFrame());
  EXPECT_EQ(device().pipelineStats().created, before.created);
  EXPECT_EQ(device().pipelineStats().firstUses, before.firstUses);
}

TEST(RestartOfAPlainScene, EditsThatAddNeedsMakeNoPipeline) {
  TestSession session(plainScene(), smallPicture());
  session.run(1);
  const vk::PipelineStats before = device().pipelineStats();
  SetMaterial everything;
  everything.baseColor = glm::vec4(0.8f, 0.7f, 0.6f, 0.5f);
  everything.emission = glm::vec3(1.0f);
  everything.specular = 1.0f;
  everything.transmission = 0.5f;
  everything.clearcoat = 1.0f;
  everything.alphaMode = AlphaMode::blend;
  session.edit({Edit(everything), Edit(SetEnvironment{glm::vec3(0.3f), 0.0f})});
  session.run(3);
  EXPECT_EQ(session.take<EditAck>().size(), 1u);
  EXPECT_EQ(device().pipelineStats().created, before.created);
  EXPECT_EQ(device().pipelineStats().firstUses, before.firstUses);
}

}  // namespace
}  // namespace limn::test
