// The plug is pulled at any moment: what was acknowledged is there again.
#include <sys/resource.h>

#include <algorithm>
#include <csignal>

#include "renderer/base/clock.hpp"
#include "tests/service/cli/run_program.hpp"
#include "tests/service/daemon_fixture.hpp"

namespace limn::server::testing {
namespace {

namespace fs = std::filesystem;

/// A daemon with its journal in a directory, and a client of it that does not watch.
struct Kept {
  explicit Kept(const test::ScratchDirectory& scratch, const std::string& scenes = kScenes)
      : daemon({"--scene", scenes + "/cornell-box.glb", "--listen", "127.0.0.1:0", "--size", "64x64", "--state-dir",
                LIMN_BUILD_DIR "/tests/state", "--asset-root", scenes, "--journal", scratch.file("journal")},
               {}),
        client(daemon.port) {
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

void load(TestClient& client, const std::string& uri) {
  const uint32_t seq = client.nextSeq();
  client.send(protocol::Load{seq, uri});
  client.awaitReply<protocol::Loaded>(seq);
}

void edit(TestClient& client, uint32_t material, float roughness) {
  const uint32_t seq = client.nextSeq();
  client.send(setRoughness(seq, material, roughness));
  client.awaitReply<protocol::Ack>(seq);
}

/// The file that is being kept in the directory.
std::string journalIn(const test::ScratchDirectory& scratch) {
  for (const auto& entry : fs::directory_iterator(scratch.file("journal")))
    if (entry.path().extension() == ".edits") return test::readText(entry.path());
  return "";
}

/// No file of the daemon may grow beyond so many bytes, as if the disk were full; nothing: any may.
void limitFiles(const Daemon& daemon, std::optional<rlim_t> bytes) {
  rlimit limit{};
  ASSERT_EQ(prlimit(daemon.process.pid(), RLIMIT_FSIZE, nullptr, &limit), 0);
  limit.rlim_cur = bytes.value_or(limit.rlim_max);
  ASSERT_EQ(prlimit(daemon.process.pid(), RLIMIT_FSIZE, &limit, nullptr), 0);
}

/// What was set aside of the only journal in the directory.
std::string setAside(const test::ScratchDirectory& scratch) {
  for (const auto& entry : fs::directory_iterator(scratch.file("journal")))
    if (entry.path().extension() == ".1") return test::readText(entry.path());
  return "";
}

void kill(Daemon& daemon) {
  daemon.process.signal(SIGKILL);
  EXPECT_EQ(daemon.process.wait(), -SIGKILL);
}

/// An asset root with a scene to begin with, and one that may change, which was loaded and edited by a daemon that has ended.
std::string editedLoadedScene(const test::ScratchDirectory& scratch) {
  const std::string scenes = scratch.file("scenes");
  fs::create_directories(scenes);
  fs::copy_file(kScene, scenes + "/cornell-box.glb");
  fs::copy_file(kScenes + "/cornell-glossy.glb", scenes + "/loaded.glb");
  Kept kept(scratch, scenes);
  load(kept.client, "loaded.glb");
  edit(kept.client, 1, 0.625f);
  kill(kept.daemon);
  return scenes;
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
    EXPECT_NE(journalIn(scratch).find(R"("technique":"path-tracing","parameters":{"maxSamples":8})"), std::string::npos)
        << "whose parameter it is";
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
    load(client, "cornell-glossy.glb");
    edit(client, 1, 0.625f);
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

TEST(LimndJournal, aLoadedSceneThatHasChangedKeepsNoneOfItsEdits) {
  const test::ScratchDirectory scratch;
  const std::string scenes = editedLoadedScene(scratch);
  {
    Kept kept(scratch, scenes);
    EXPECT_EQ(describe(kept.client).materials.at(1).roughness, 0.625f) << "it has not changed yet";
    kill(kept.daemon);
  }
  fs::copy_file(kScene, scenes + "/loaded.glb", fs::copy_options::overwrite_existing);
  for (int starts = 0; starts < 2; ++starts) {
    Kept kept(scratch, scenes);
    const auto scene = describe(kept.client);
    EXPECT_EQ(scene.name, "loaded.glb");
    EXPECT_NE(scene.materials.at(1).roughness, 0.625f);
    EXPECT_NE(setAside(scratch).find("0.625"), std::string::npos) << "nothing is thrown away";
    kill(kept.daemon);
  }
}

/// As after an update of the program: a parameter that it accepted is none any more.
TEST(LimndJournal, aParameterThatIsGoneTakesNothingElseAlong) {
  const test::ScratchDirectory scratch;
  {
    const auto journal = Journal::open(journalFileFor(scratch.file(""), kScene).take()).take();
    const Result<void> kept = journal->append(std::vector<Accepted>{
        {protocol::Batch{1, {protocol::ImageEdit{80, 48}}}},
        {protocol::Batch{1, {protocol::TechniqueEdit{"path-tracing", {{{"gone", 1.0}, {"maxSamples", 8.0}}}}}}}});
    ASSERT_TRUE(kept.ok());
  }
  for (const bool again : {false, true}) {
    Daemon daemon({"--asset-root", kScenes, "--journal", scratch.file("")});
    TestClient client(daemon.port);
    client.greet(false);
    const auto asHoped = [](const protocol::SceneMessage& scene) {
      const auto isSet = [](const auto& parameter) { return parameter.first == "maxSamples" && parameter.second == 8.0; };
      return scene.width == 80 && std::any_of(scene.parameters.begin(), scene.parameters.end(), isSet);
    };
    auto scene = describe(client);
    for (const double end = nowSeconds() + RawClient::kPatience; !asHoped(scene) && nowSeconds() < end;) scene = describe(client);
    EXPECT_TRUE(asHoped(scene));
    daemon.process.signal(SIGTERM);
    EXPECT_EQ(daemon.process.wait(), 0);
    EXPECT_EQ(daemon.process.errors().find("does not fit any more") == std::string::npos, again) << daemon.process.errors();
  }
}

TEST(LimndJournal, whatAFullDiskKeptOutIsWrittenOnceThereIsRoom) {
  const test::ScratchDirectory scratch;
  std::signal(SIGXFSZ, SIG_IGN);       // the daemon inherits it
  Kept kept(scratch);
  const auto written = [&] { return journalIn(scratch).find("0.625") != std::string::npos; };
  limitFiles(kept.daemon, 20);
  edit(kept.client, 1, 0.625f);
  EXPECT_FALSE(written());
  limitFiles(kept.daemon, std::nullopt);
  const double end = nowSeconds() + RawClient::kPatience;
  while (!written() && nowSeconds() < end) describe(kept.client);
  EXPECT_TRUE(written()) << "nobody edits any more";
}

TEST(LimndJournal, aLoadedSceneThatIsSpoiltKeepsNoDaemonFromStarting) {
  const test::ScratchDirectory scratch;
  const std::string scenes = editedLoadedScene(scratch);
  std::ofstream(scenes + "/loaded.glb") << "no glTF any more";
  Kept kept(scratch, scenes);
  const auto scene = describe(kept.client);
  EXPECT_EQ(scene.name, "cornell-box.glb");
  EXPECT_NE(scene.materials.at(1).roughness, 0.625f) << "an edit of another scene";
  EXPECT_NE(setAside(scratch).find("0.625"), std::string::npos) << "nothing is thrown away";
  kept.daemon.process.signal(SIGTERM);
  EXPECT_EQ(kept.daemon.process.wait(), 0);
  EXPECT_NE(kept.daemon.process.errors().find("the scene that was loaded last cannot be begun with"), std::string::npos)
      << kept.daemon.process.errors();
}

}  // namespace
}  // namespace limn::server::testing
