// What the device cannot hold, a scene or a picture or a technique or the lights that an edit makes, is refused, and what was
// before it is rendered on as if nothing had been asked.
#include <gtest/gtest.h>

#include "renderer/techniques/technique.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {
namespace {

constexpr uint64_t kLargestBuffer = 1 << 20;

/// A ball whose vertices alone need several times the largest buffer.
Scene largeScene() {
  SceneBuilder b;
  b.scene = plainScene();
  b.sphere(0, {0, 0, 0}, 0.5f, 220);
  b.scene.name = "large";
  return b.scene;
}

uint32_t load(TestSession& session, Scene scene) {
  LoadRequest request;
  request.loaded = std::make_shared<LoadedScene>(LoadedScene{std::move(scene), {}});
  return session.ask(std::move(request));
}

std::unique_ptr<vk::Device> smallDevice() {
  vk::DeviceOptions options;
  options.validation = true;
  options.cacheDir = LIMN_BUILD_DIR "/test-pipelines";
  options.largestBuffer = kLargestBuffer;
  return must(vk::Device::open(options));
}

/// Plain, and a ball whose triangles fit where as many lights do not.
struct BallScene {
  Scene scene;
  uint32_t ball = 0;  ///< material

  BallScene() {
    SceneBuilder b;
    b.scene = plainScene();
    ball = b.diffuse(glm::vec3(0.5f));
    b.sphere(ball, {0, 0, 0}, 0.5f, 64);
    scene = b.scene;
  }
  SetMaterial glow() const { return {.material = ball, .emission = glm::vec3(1.0f)}; }
};

SetLight intensity(float value) { return {.intensity = value}; }

/// The error of the one reply there is, which refuses `seq`; an empty one, and a failure, where there is another.
Error refusalOf(TestSession& session, uint32_t seq) {
  const std::vector<Reply> replies = session.takeReplies();
  EXPECT_EQ(replies.size(), 1u);
  const auto* refused = replies.empty() ? nullptr : std::get_if<ErrorReply>(&replies[0]);
  EXPECT_NE(refused, nullptr);
  if (!refused) return {};
  EXPECT_EQ(refused->to.seq, seq);
  EXPECT_EQ(refused->error.code, "limit");
  return refused->error;
}

SetTechnique pointsOf(double count) {
  SetTechnique edit;
  edit.technique = "point-projection";
  edit.parameters = {{"points", count}, {"clusters", 256.0}};
  return edit;
}

TEST(RefusedSetup, KeepsSizeTechniqueParametersAndPicture) {
  const auto small = smallDevice();
  const auto log = small->validationLog();
  {
    TestSession session(plainScene(), smallPicture(), *small);
    session.run(3);
    const uint64_t film = session.hash();
    // Quarter of a million points need more than the largest buffer holds.
    const uint32_t many = session.edit({pointsOf(262144.0)});
    session.run(3);
    EXPECT_EQ(refusalOf(session, many).place, "/edits/0");
    EXPECT_EQ(session->technique().info().name, "path-tracing");
    EXPECT_EQ(session.hash(), film) << "the same samples by the same technique";

    EXPECT_EQ(session.apply({pointsOf(16384.0)}).cost, CostClass::rebuild);
    session.run(2);
    const uint64_t projected = session.hash();
    // A film of this size fits, but nothing that holds twice as much for a pixel; the light of the same batch stays as it is.
    SetLight dim;
    dim.intensity = 0.5f;
    const uint32_t large = session.edit({dim, SetImageSize{256, 256}});
    session.run(2);
    EXPECT_EQ(refusalOf(session, large).place, "/edits/1");
    EXPECT_EQ(session.hash(), projected) << "the same samples of the same size and scene";

    EXPECT_EQ(session.apply({SetImageSize{48, 40}}).cost, CostClass::regather);
    session.run(2);
    EXPECT_EQ(session.film().width, 48u);
  }
  EXPECT_EQ(log->count(), 0u);
}

TEST(RefusedEdit, KeepsTheSceneAndItsPicture) {
  const auto small = smallDevice();
  const auto log = small->validationLog();
  {
    const BallScene made;
    TestSession session(made.scene, smallPicture(), *small);
    session.apply({intensity(1.5f)});
    session.run(3);
    const uint64_t scene = session.scene().hash(), film = session.hash(), applied = session.status().editsApplied;

    const uint32_t seq = session.edit({made.glow()});
    session.run(3);
    EXPECT_EQ(refusalOf(session, seq).place, "/edits/0");
    EXPECT_EQ(session.scene().hash(), scene);
    EXPECT_EQ(session.hash(), film) << "the same samples of the same scene";
    EXPECT_EQ(session.status().editsApplied, applied);

    const EditAck next = session.apply({intensity(2.5f)});
    EXPECT_EQ(next.cost, CostClass::relight);
    EXPECT_EQ(next.sceneRevision, 3u) << "the refused edit made no revision";
    session.run(3);
    Scene wanted = made.scene;
    wanted.lights[0].intensity = 2.5f;
    EXPECT_EQ(session.hash(), freshHash(wanted, smallPicture(), 3));
  }
  EXPECT_EQ(log->count(), 0u);
}

TEST(RefusedEdit, TakesNoEditOfTheSameTurnAlong) {
  const auto small = smallDevice();
  const BallScene made;
  TestSession session(made.scene, smallPicture(), *small);
  session.run(1);
  const uint32_t before = session.edit({intensity(1.5f)}), refused = session.edit({made.glow()});
  const uint32_t after = session.edit({SetMaterial{.material = 0, .baseColor = glm::vec4(0.2f, 0.3f, 0.4f, 1.0f)}}, 2);
  session.run(3);
  const std::vector<Reply> replies = session.takeReplies();
  ASSERT_EQ(replies.size(), 3u);
  ASSERT_TRUE(std::holds_alternative<EditAck>(replies[0]) && std::holds_alternative<ErrorReply>(replies[1]) &&
              std::holds_alternative<EditAck>(replies[2]));
  const auto& first = std::get<EditAck>(replies[0]);
  const auto& last = std::get<EditAck>(replies[2]);
  EXPECT_EQ(first.to.seq, before);
  EXPECT_EQ(first.cost, CostClass::relight);
  EXPECT_EQ(std::get<ErrorReply>(replies[1]).to.seq, refused);
  EXPECT_EQ(last.to.seq, after);
  EXPECT_EQ(last.cost, CostClass::regather);
  EXPECT_EQ(last.sceneRevision, first.sceneRevision + 1);
  Scene wanted = made.scene;
  wanted.lights[0].intensity = 1.5f;
  wanted.materials[0].baseColor = {0.2f, 0.3f, 0.4f, 1.0f};
  EXPECT_EQ(session.hash(), freshHash(wanted, smallPicture(), 3));
}

// Every transform is one that a node may have.
TEST(RefusedEdit, NodesDoNotReachTooFarTogether) {
  const RichScene made = richScene();
  TestSession session(made.scene, smallPicture());
  const uint32_t child = made.scene.nodes[made.metalNode].children.at(0);
  const SetNodeTransform outer{.node = made.metalNode, .scale = glm::dvec3(1e12)}, inner{.node = child, .scale = glm::dvec3(1e12)};
  const uint32_t seq = session.edit({SetResolve{.exposure = 1.0f}, outer, inner});
  session.run(1);
  const auto refused = session.take<ErrorReply>();
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_EQ(refused[0].to.seq, seq);
  EXPECT_EQ(refused[0].error.code, "out-of-range");
  EXPECT_EQ(refused[0].error.place, "/edits/2");
  EXPECT_EQ(session.scene().hash(), made.scene.hash());
}

TEST(RefusedEdit, OfABatchTakesAllOfItBack) {
  const auto small = smallDevice();
  const BallScene made;
  TestSession session(made.scene, smallPicture(), *small);
  session.run(3);
  const uint64_t film = session.hash();
  SetTechnique shallow;
  shallow.parameters = {{"maxBounces", 1.0}};
  const uint32_t seq = session.edit({SetImageSize{48, 40}, shallow, SetNodeTransform{.node = 0, .translation = glm::dvec3(0, -1, 0)},
                                     SetEnvironment{.radiance = glm::vec3(1.0f)}, made.glow(), SetResolve{.exposure = 2.0f}});
  session.run(3);
  EXPECT_EQ(refusalOf(session, seq).place, "seq " + std::to_string(seq) + " /edits");
  EXPECT_EQ(session.scene().hash(), made.scene.hash());
  EXPECT_EQ(session.hash(), film) << "the same samples of the same size and scene";
  session.ask(DescribeRequest{});
  session.run(3);
  const auto described = session.take<DescribeReply>();
  ASSERT_EQ(described.size(), 1u);
  EXPECT_EQ(described[0].scene->width, 32u);
  EXPECT_EQ(described[0].scene->resolve.exposure, 0.0f);
  EXPECT_EQ(described[0].scene->viewRevision, 1u);
}

TEST(RefusedEdit, OfABatchWithASizeLeavesNothingToTheNextSetup) {
  const auto small = smallDevice();
  const BallScene made;
  TestSession session(made.scene, smallPicture(), *small);
  session.run(1);
  SetTechnique shallow;
  shallow.parameters = {{"maxBounces", 1.0}};
  const uint32_t refused = session.edit({SetImageSize{48, 40}, made.glow()}), taken = session.edit({shallow});
  session.run(3);
  const std::vector<Reply> replies = session.takeReplies();
  ASSERT_EQ(replies.size(), 2u);
  ASSERT_TRUE(std::holds_alternative<ErrorReply>(replies[0]) && std::holds_alternative<EditAck>(replies[1]));
  EXPECT_EQ(std::get<ErrorReply>(replies[0]).to.seq, refused);
  EXPECT_EQ(std::get<EditAck>(replies[1]).to.seq, taken);
  SessionConfig wanted = smallPicture();
  wanted.parameters = shallow.parameters;
  EXPECT_EQ(session.hash(), freshHash(made.scene, wanted, 3));
}

TEST(RefusedLoad, KeepsTheSceneItsPictureAndItsEdits) {
  const auto small = smallDevice();
  ASSERT_EQ(small->limits().maxBufferSize, kLargestBuffer);
  const auto log = small->validationLog();
  {
    TestSession session(plainScene(), smallPicture(), *small);
    SetLight dim;
    dim.intensity = 1.5f;
    session.apply({dim});
    session.run(3);
    const uint64_t scene = session.scene().hash(), film = session.hash();
    const Status before = session.status();

    const uint32_t seq = load(session, largeScene());
    session.run(3);
    const std::string why = refusalOf(session, seq).message;
    EXPECT_NE(why.find("maxBufferSize"), std::string::npos) << why;
    EXPECT_EQ(session.scene().hash(), scene);
    EXPECT_EQ(session.hash(), film) << "the same samples of the same scene, the edit's light included";
    EXPECT_EQ(session.status().editsApplied, before.editsApplied);

    // Nothing is left of the refused one: edits of the old scene and a load that fits go on as ever.
    dim.intensity = 2.5f;
    EXPECT_EQ(session.apply({dim}).cost, CostClass::relight);
    load(session, plainScene());
    session.run(3);
    EXPECT_EQ(session.take<LoadReply>().size(), 1u);
    EXPECT_EQ(session.hash(), freshHash(plainScene(), smallPicture(), 3));
  }
  EXPECT_EQ(log->count(), 0u);
}

}  // namespace
}  // namespace limn::test
