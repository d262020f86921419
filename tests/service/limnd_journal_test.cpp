// The plug is pulled at any moment: what was acknowledged is there again.
#include <algorithm>
#include <csignal>

#include "tests/service/cli/run_program.hpp"
#include "tests/service/daemon_fixture.hpp"

namespace limn::server::testing {
namespace {

/// A daemon with its journal in a directory, and a client of it that does not watch.
struct Kept {
  explicit Kept(const test::ScratchDirectory& scratch)
      : daemon({"--asset-root", kScenes, "--journal", scratch.file("journal")}), client(daemon.port) {
    client.greet(false);
  }
  Daemon daemon;
  TestClient client;
};

/// The scene with all that the journal holds: it is asked for behind those edits.
protocol::SceneMessage describe(TestClient& client) {
  const uint32_t seq = client.nextSeq();
  client.send(protocol::Describe{seq});
  return client.await<protocol::SceneMessage>([&](const auto& scene) { return scene.seq == seq; });
}

void kill(Daemon& daemon) {
  daemon.process.signal(SIGKILL);
  EXPECT_EQ(daemon.process.wait(), -SIGKILL);
}

TEST(LimndJournal, everythingAcknowledgedOutlivesTheProcess) {
  const test::ScratchDirectory scratch;
  protocol::SceneMessage before;
  {
    Kept kept(scratch);
    TestClient& client = kept.client;
    const auto scene = client.await<protocol::SceneMessage>();
    protocol::NodeEdit node;
    node.node = 1;
    node.translation = {{0.25, 0.5, -0.125}};
    protocol::ResolveEdit shown;
    shown.exposure = 1.5f;
    protocol::MaterialEdit material;
    material.emission = {{0.1f, 0.2f, 0.3f}};
    protocol::CameraEdit camera{scene.view};
    camera.view.eye[0] += 0.25;
    const uint32_t seq = client.nextSeq();
    client.send(protocol::Batch{seq, {node, shown, material, camera, protocol::ImageEdit{80, 48}}});
    client.awaitReply<protocol::Ack>(seq);
    endAfter(client, 8);
    before = describe(client);
    kill(kept.daemon);
  }
  Kept kept(scratch);
  TestClient& client = kept.client;
  const auto after = describe(client);
  EXPECT_EQ(after.hash, before.hash);
  EXPECT_EQ(after.view, before.view);
  EXPECT_EQ(after.resolve, before.resolve);
  EXPECT_EQ(after.resolve.exposure, 1.5f);
  EXPECT_EQ(after.width, 80u);
  EXPECT_EQ(after.parameters, before.parameters);
}

TEST(LimndJournal, killedInAStreamOfEditsItHasAllThatWereAcknowledged) {
  const test::ScratchDirectory scratch;
  float least = 0.0f;                  // roughness that was acknowledged last
  float sent = 0.0f;
  for (const uint32_t acks : {1u, 7u, 23u}) {
    Kept kept(scratch);
    TestClient& client = kept.client;
    const float found = describe(client).materials.at(0).roughness;
    if (least > 0.0f) {
      EXPECT_GE(found, least);
      EXPECT_LE(found, sent);
    }
    uint32_t seq = 0;
    std::vector<std::pair<uint32_t, float>> edits;
    for (int i = 0; i < 40; ++i) {
      seq = client.nextSeq();
      sent += 1.0f / 256.0f;
      edits.emplace_back(seq, sent);
      client.send(setRoughness(seq, 0, sent));
    }
    client.awaitReply<protocol::Ack>(edits[acks - 1].first);
    least = edits[acks - 1].second;
    kill(kept.daemon);
  }
  Kept kept(scratch);
  TestClient& client = kept.client;
  EXPECT_GE(describe(client).materials.at(0).roughness, least);
}

TEST(LimndJournal, theSceneThatWasLoadedLastComesBack) {
  const test::ScratchDirectory scratch;
  protocol::Hash hash;
  {
    Kept kept(scratch);
    TestClient& client = kept.client;
    const uint32_t shown = client.nextSeq();
    client.send(protocol::Batch{shown, {protocol::ImageEdit{80, 48}, protocol::TechniqueEdit{"point-projection", {}}}});
    client.awaitReply<protocol::Ack>(shown);
    const uint32_t seq = client.nextSeq();
    client.send(protocol::Load{seq, "cornell-glossy.glb"});
    client.awaitReply<protocol::Loaded>(seq);
    const uint32_t edit = client.nextSeq();
    client.send(setRoughness(edit, 1, 0.625f));
    client.awaitReply<protocol::Ack>(edit);
    hash = describe(client).hash;
    kill(kept.daemon);
  }
  Kept kept(scratch);
  TestClient& client = kept.client;
  const auto scene = describe(client);
  EXPECT_EQ(scene.name, "cornell-glossy.glb");
  EXPECT_EQ(scene.hash, hash);
  EXPECT_EQ(scene.technique, "point-projection");
  EXPECT_EQ(scene.width, 80u);
}

}  // namespace
}  // namespace limn::server::testing
