// Whatever was edited in whatever order, the picture is the one that a fresh load of the result gives, bit for bit.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "renderer/gpu/needs_constants.hpp"
#include "renderer/techniques/technique.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {
namespace {

/// Seeded choices; the same seed gives the same sequence.
class Dice {
 public:
  explicit Dice(uint32_t seed) : m_engine(seed * 7919u + 17u) {}
  uint32_t below(uint32_t n) { return uint32_t(m_engine() % n); }
  bool chance(uint32_t oneIn) { return below(oneIn) == 0; }
  float real(float low, float high) { return low + (high - low) * float(m_engine() % 4096) / 4095.0f; }
  glm::vec3 color() { return {real(0, 1), real(0, 1), real(0, 1)}; }
  glm::dvec3 place(double extent) { return extent * glm::dvec3(real(-1, 1), real(-1, 1), real(-1, 1)); }
  template <class T>
  std::optional<T> maybe(T value) { return chance(2) ? std::optional<T>(value) : std::nullopt; }

 private:
  std::mt19937 m_engine;
};

Edit materialEdit(Dice& dice, const Scene& scene) {
  SetMaterial e;
  e.material = dice.below(uint32_t(scene.materials.size()));
  e.baseColor = dice.maybe(glm::vec4(dice.color(), dice.real(0.2f, 1.0f)));
  e.roughness = dice.maybe(dice.chance(5) ? 0.0f : dice.real(0.05f, 1.0f));
  e.metallic = dice.maybe(dice.chance(2) ? 0.0f : dice.real(0.0f, 1.0f));
  e.ior = dice.maybe(dice.real(1.0f, 2.0f));
  if (dice.chance(4)) e.emission = dice.chance(2) ? glm::vec3(0.0f) : 3.0f * dice.color();
  if (dice.chance(4)) e.alphaMode = AlphaMode(dice.below(3));
  if (dice.chance(4)) e.transmission = dice.chance(2) ? 0.0f : dice.real(0.3f, 1.0f);
  if (dice.chance(4)) e.thickness = dice.chance(2) ? 0.0f : 0.3f;
  if (dice.chance(6)) e.alphaCutoff = dice.real(0.0f, 1.0f);
  if (dice.chance(6)) e.attenuationColor = dice.color();
  if (dice.chance(6)) e.normalScale = dice.real(-2.0f, 2.0f);
  return e;
}

Edit lightEdit(Dice& dice, const Scene& scene) {
  SetLight e;
  e.light = dice.below(uint32_t(scene.lights.size()));
  e.color = dice.maybe(dice.color());
  e.intensity = dice.maybe(dice.chance(4) ? 0.0f : dice.real(0.1f, 5.0f));
  e.range = dice.maybe(dice.chance(2) ? 0.0f : dice.real(0.5f, 4.0f));
  return e;
}

Edit nodeEdit(Dice& dice, const Scene& scene) {
  SetNodeTransform e;
  e.node = dice.below(uint32_t(scene.nodes.size()));
  // Now and then so far that render space itself moves.
  e.translation = dice.maybe(dice.place(dice.chance(12) ? 20000.0 : 1.0));
  e.rotation = dice.maybe(glm::dquat(dice.real(0.1f, 1.0f), dice.real(-1, 1), dice.real(-1, 1), dice.real(-1, 1)));
  e.scale = dice.maybe(glm::dvec3(dice.real(0.3f, 1.5f), dice.real(0.3f, 1.5f), dice.chance(4) ? -1.0 : 1.0));
  return e;
}

Edit viewEdit(Dice& dice, const Scene& scene) {
  SetView e{scene.view};
  e.view.eye = glm::dvec3(0.0, 0.3, 2.6) + dice.place(0.8);
  e.view.lens.yfov = dice.real(0.4f, 1.0f);
  e.view.lens.perspective = !dice.chance(6);
  return e;
}

Edit environmentEdit(Dice& dice) {
  SetEnvironment e{dice.maybe(dice.chance(3) ? glm::vec3(0.0f) : dice.color()), dice.maybe(dice.real(-4, 4))};
  if (dice.chance(2)) e.image = dice.chance(3) ? nullptr : skyImage(dice.below(32));
  return e;
}

Edit pointProjectionEdit(Dice& dice) {
  SetTechnique e;
  if (dice.chance(2)) e.parameters.push_back({"bounces", dice.below(4)});
  if (dice.chance(2)) e.parameters.push_back({"projections", 512 + dice.below(1024)});
  if (dice.chance(2)) e.parameters.push_back({"microSize", 8 + dice.below(25)});
  if (dice.chance(4)) e.parameters.push_back({"clusters", dice.chance(2) ? 64 : 256});
  if (dice.chance(4)) e.parameters.push_back({"startGrid", 4u << dice.below(3)});
  if (dice.chance(4)) e.parameters.push_back({"filterSize", 1 + 2 * dice.below(4)});
  if (dice.chance(4)) e.parameters.push_back({"auditShare", dice.chance(2) ? 0.0 : 0.5});
  return e;
}

Edit pathTracingEdit(Dice& dice) {
  SetTechnique e;
  if (dice.chance(2)) e.parameters.push_back({"maxBounces", dice.below(6)});
  if (dice.chance(2)) e.parameters.push_back({"rouletteStart", 1 + dice.below(4)});
  if (dice.chance(2)) e.parameters.push_back({"adaptive", dice.below(2)});
  if (dice.chance(2)) e.parameters.push_back({"minSamples", 4 + dice.below(5)});
  if (dice.chance(2)) e.parameters.push_back({"noiseThreshold", dice.real(0.05f, 0.5f)});
  return e;
}

/// Parameters with which little work is a pass.
std::vector<std::pair<std::string, double>> smallParameters(const std::string& technique) {
  if (technique != "point-projection") return {};
  return {{"points", 16384}, {"clusters", 64}, {"projections", 512}, {"bounces", 2}};
}

/// Of the session's own technique.
Edit anyEdit(Dice& dice, const TestSession& session) {
  const Scene& scene = session.scene();
  switch (dice.below(12)) {
    case 0: case 1: case 2: return materialEdit(dice, scene);
    case 3: case 4: return lightEdit(dice, scene);
    case 5: case 6: return nodeEdit(dice, scene);
    case 7: return environmentEdit(dice);
    case 8: return viewEdit(dice, scene);
    case 9: return SetResolve{dice.real(-3, 3), ToneMap(dice.below(4)), ResolveView(dice.below(8))};
    case 10: return SetImageSize{16 + 4 * dice.below(9), 16 + 4 * dice.below(9)};
    default:
      return session->technique().info().name == "path-tracing" ? pathTracingEdit(dice) : pointProjectionEdit(dice);
  }
}

void load(TestSession& session, const Scene& scene) {
  LoadRequest request;
  request.loaded = std::make_shared<LoadedScene>(LoadedScene{scene, {}});
  (void)session.ask(std::move(request));
  session.run(0);
}

/// Brings picture size, technique and parameters to those of `model`, then loads `scene` anew.
void loadInto(TestSession& session, const Scene& scene, const SceneSummary& model) {
  std::vector<Edit> settings{Edit(SetImageSize{model.width, model.height})};
  settings.emplace_back(std::in_place_type<SetTechnique>, model.technique, model.parameters);
  (void)session.edit(std::move(settings));
  load(session, scene);
}

std::shared_ptr<const SceneSummary> describe(TestSession& session) {
  (void)session.ask(DescribeRequest{});
  session.run(0);
  const auto replies = session.take<DescribeReply>();
  return replies.empty() ? nullptr : replies.back().scene;
}

SessionConfig smallQuanta(const std::string& technique) {
  SessionConfig config = smallPicture(32, 24);
  config.technique = technique;
  config.parameters = smallParameters(technique);
  config.quantumSeconds = 0.0005;  // several to a pass
  config.firstFrameSeconds = 0.001;
  return config;
}

/// One loaded session for each technique and pipeline variant, so that every reference is rendered by the variant cut to
/// its scene, in a session that has never changed its technique.
class References {
 public:
  uint64_t hash(const Scene& scene, const SceneSummary& model, uint32_t passes) {
    auto& session = m_sessions[{model.technique, gpu::needsConstants(sceneNeeds(scene))}];
    if (!session) session = std::make_unique<TestSession>(scene, smallQuanta(model.technique));
    loadInto(*session, scene, model);
    session->run(passes);
    return session->hash();
  }

 private:
  std::map<std::pair<std::string, std::vector<uint32_t>>, std::unique_ptr<TestSession>> m_sessions;
};

/// The two scenes that sequences begin with, and load on their way.
const std::vector<Scene>& startScenes() {
  static const std::vector<Scene> kStarts{richScene().scene, plainScene()};
  return kStarts;
}

/// A technique at random, or a scene.
void changeGround(TestSession& session, Dice& dice) {
  if (dice.chance(3)) return load(session, startScenes()[dice.below(2)]);
  const std::string name = techniqueInfos()[dice.below(uint32_t(techniqueInfos().size()))].name;
  (void)session.edit({Edit(SetTechnique{name, smallParameters(name)})});
  session.run(0);
}

/// Random batches with partial steps between them; `everything`: also techniques and scenes change.
void playSequence(TestSession& session, Dice& dice, bool everything) {
  const uint32_t batches = 1 + dice.below(6);
  for (uint32_t i = 0; i < batches; ++i) {
    if (everything && dice.chance(2)) changeGround(session, dice);
    std::vector<Edit> edits;
    const uint32_t count = 1 + dice.below(3);
    while (edits.size() < count) edits.push_back(anyEdit(dice, session));
    (void)session.edit(std::move(edits));
    session.steps(int(dice.below(5)));
  }
}

void expectPicturesOfFreshLoads(const std::string& technique, uint32_t sequences, uint32_t mostPasses,
                                bool everything = false) {
  const std::vector<Scene>& starts = startScenes();
  TestSession edited[] = {{starts[0], smallQuanta(technique)}, {starts[1], smallQuanta(technique)}};
  const auto defaults = describe(edited[0]);
  References references;
  for (uint32_t seed = 0; seed < sequences; ++seed) {
    Dice dice(seed);
    TestSession& session = edited[seed % 2];
    loadInto(session, starts[seed % 2], *defaults);
    session.steps(int(dice.below(4)));
    playSequence(session, dice, everything);
    const uint32_t passes = 1 + dice.below(mostPasses);
    session.run(0);
    session.published.clear();
    session.run(passes);
    for (const ErrorReply& error : session.take<ErrorReply>()) ADD_FAILURE() << "seed " << seed << ": " << error.error.text();
    const uint64_t hash = session.hash();
    const auto summary = describe(session);
    EXPECT_EQ(hash, references.hash(session.scene(), *summary, passes)) << "seed " << seed << ", " << passes << " passes";
    if (seed % 20 < 2) {
      SessionConfig config = smallQuanta(summary->technique);
      config.width = summary->width;
      config.height = summary->height;
      config.parameters = summary->parameters;
      EXPECT_EQ(hash, freshHash(session.scene(), config, passes)) << "seed " << seed << ", a new session";
    }
  }
}

TEST(AnyEdits, GiveThePictureOfAFreshLoad) { expectPicturesOfFreshLoads("path-tracing", 200, 6); }
TEST(AnyEdits, GivePointProjectionsPictureOfAFreshLoad) { expectPicturesOfFreshLoads("point-projection", 24, 7); }
TEST(AnyEdits, AmongOtherTechniquesAndScenesGiveThePictureOfAFreshLoad) {
  expectPicturesOfFreshLoads("path-tracing", 20, 5, true);
}

}  // namespace
}  // namespace limn::test
