// The real daemon with the real renderer on the software device.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/service/daemon_fixture.hpp"

namespace limn::server::testing {
namespace {

namespace fs = std::filesystem;

TEST(Limnd, anEditShowsInThePictureAndItConvergesAgain) {
  Daemon daemon;
  TestClient client(daemon.port);
  const auto hello = client.greet();
  EXPECT_FALSE(hello.device.empty());
  EXPECT_EQ(hello.techniques.at(0).name, "path-tracing");
  const auto scene = client.await<protocol::SceneMessage>();
  ASSERT_FALSE(scene.materials.empty());
  endAfter(client, 8);
  const std::vector<uint8_t> before = pictureAtRest(client, 2);

  protocol::SetCamera camera;
  camera.seq = client.nextSeq();
  camera.view = scene.view;
  camera.view.eye[0] += 0.3 * (scene.boundsHigh[0] - scene.boundsLow[0]);
  client.send(camera);
  const auto ack = client.awaitReply<protocol::Ack>(camera.seq);
  EXPECT_NE(ack.cost, protocol::CostClass::none);
  const std::vector<uint8_t> after = pictureAtRest(client, camera.seq);
  EXPECT_NE(before, after);

  camera.seq = client.nextSeq();
  camera.view = scene.view;
  client.send(camera);
  EXPECT_EQ(pictureAtRest(client, camera.seq), before) << "the same scene and seed give the same bits";
}

TEST(Limnd, anEditThatChangesNothingRestartsNothing) {
  Daemon daemon;
  TestClient client(daemon.port);
  client.greet(false);
  const auto scene = client.await<protocol::SceneMessage>();
  const uint32_t seq = client.nextSeq();
  client.send(setRoughness(seq, 0, scene.materials.at(0).roughness));
  EXPECT_EQ(client.awaitReply<protocol::Ack>(seq).cost, protocol::CostClass::none);
}

TEST(Limnd, anotherSceneIsLoadedAndShown) {
  Daemon daemon({"--asset-root", kScenes});
  TestClient client(daemon.port);
  client.greet();
  const auto first = client.await<protocol::SceneMessage>();
  const uint32_t seq = client.nextSeq();
  client.send(protocol::Load{seq, "furnace-diffuse-05.glb"});
  const auto loaded = client.awaitReply<protocol::Loaded>(seq);
  EXPECT_NE(loaded.hash.value, first.hash.value);
  const auto picture = client.awaitPicture([&](const auto& h) { return h.sceneRevision >= loaded.sceneRevision; });
  EXPECT_GT(picture.header.gatheredShare, 0.0f);
}

TEST(Limnd, aFileOfTheFilmIsSaved) {
  Daemon daemon;
  TestClient client(daemon.port);
  client.greet();
  endAfter(client, 4);
  convergedHash(client);
  const uint32_t seq = client.nextSeq();
  client.send(protocol::Save{seq, std::nullopt});
  EXPECT_GT(client.awaitReply<protocol::Saved>(seq).bytes, 1000u);
  const auto file = client.awaitPicture([](const auto& h) { return h.kind == protocol::FrameKind::file; });
  const std::vector<uint8_t> magic{0x76, 0x2f, 0x31, 0x01};
  EXPECT_TRUE(std::equal(magic.begin(), magic.end(), file.payload.begin()));
}

TEST(Limnd, sigtermDrainsAndExitsWith0) {
  Daemon daemon;
  TestClient client(daemon.port);
  client.greet();
  client.awaitPicture();
  daemon.process.signal(SIGTERM);
  while (client.step()) {
  }
  EXPECT_EQ(client.closeCode, 1001);
  EXPECT_EQ(daemon.process.wait(), 0) << daemon.process.errors();
}

TEST(Limnd, aSecondSigtermEndsItAtOnce) {
  Daemon daemon;
  RawClient silent;   // never answers the close: the drain would wait for it
  ASSERT_EQ(silent.upgrade(daemon.port), 101);
  daemon.process.signal(SIGTERM);
  while (RawClient(daemon.port).request("GET /readyz HTTP/1.1", {"Host: localhost"}).status != 503) {
  }
  daemon.process.signal(SIGTERM);
  EXPECT_EQ(daemon.process.wait(), 1);
}

TEST(Limnd, aTakenPortIsOneLineAndExit1) {
  Daemon daemon;
  ChildProcess second(kProgram, {"--scene", kScene, "--listen", "127.0.0.1:" + std::to_string(daemon.port)});
  EXPECT_EQ(second.wait(), 1);
  EXPECT_NE(second.errors().find("limnd: 127.0.0.1:" + std::to_string(daemon.port)), std::string::npos)
      << second.errors();
}

TEST(Limnd, startUpFailuresAreOneLineAndExit1) {
  const fs::path bad = fs::temp_directory_path() / ("limnd-bad-" + std::to_string(getpid()) + ".glb");
  std::ofstream(bad) << "not glTF at all";
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"--scene", "/nowhere.glb"}, {"--scene", bad.string(), "--listen", "127.0.0.1:0"},
           {"--scene", kScene, "--device", "no such device"}, {"--scene", kScene, "--listen", "0.0.0.0:0"}}) {
    ChildProcess process(kProgram, words);
    EXPECT_EQ(process.readLine(), "") << "it never listened";
    EXPECT_EQ(process.wait(), 1) << words.back();
    const std::string errors = process.errors();
    EXPECT_NE(errors.find("limnd: "), std::string::npos) << errors;
    EXPECT_EQ(errors.find("check failed"), std::string::npos) << errors;
  }
  fs::remove(bad);
}

TEST(Limnd, usageErrorsExitWith64) {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {}, {"--scene", kScene, "--nonsense"}, {"--scene", kScene, "--technique", "magic"}}) {
    ChildProcess process(kProgram, words);
    EXPECT_EQ(process.wait(), 64);
    const std::string errors = process.errors();
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  }
}

TEST(Limnd, helpNamesTheFlags) {
  ChildProcess process(kProgram, {"--help"});
  EXPECT_EQ(process.readLine(), "usage: limnd --scene FILE [flags]");
  EXPECT_EQ(process.wait(), 0);
}

}  // namespace
}  // namespace limn::server::testing
