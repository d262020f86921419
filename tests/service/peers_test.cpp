// Peers that are slow, that vanish, and that load scenes.
#include <filesystem>
#include <fstream>
#include <set>

#include "renderer/base/clock.hpp"
#include "tests/service/service_fixture.hpp"

namespace limn::server::testing {
namespace {

namespace fs = std::filesystem;

TestService::Options endlessLarge() {
  TestService::Options options;
  options.renderer.passes = 1u << 30;
  options.renderer.noisy = true;
  options.renderer.width = 512;
  options.renderer.height = 512;
  options.renderer.frameSeconds = 0.005;
  return options;
}

TEST(Peers, aReaderThatStopsIsCutOffAndOthersGoOn) {
  TestService::Options options = endlessLarge();
  options.configure = [](ServiceConfig& config) { config.transport.stalledSeconds = 0.5; };
  TestService server(options);
  TestClient stopped(server.port(), 4096), reads(server.port());
  stopped.acknowledges = false;
  stopped.greet(std::nullopt, std::vector<protocol::Encoding>{protocol::Encoding::png});
  reads.greet();
  // From here on `stopped` reads nothing: 900 KB of picture do not fit into its buffers.
  uint32_t pictures = 0;
  while (server.tryMetric("limn_stalled_total") != 1.0) {
    reads.awaitPicture();
    ++pictures;
    ASSERT_LT(pictures, 100000u);
  }
  EXPECT_GE(pictures, 1u);
  server.waitForMetric("limn_clients", 1.0);
  reads.awaitPicture();
}

TEST(Peers, whatWaitsForASlowReaderIsBounded) {
  TestService::Options options;
  options.configure = [](ServiceConfig& config) {
    config.transport.messagesPerSecond = 1e6;
    config.transport.messageBurst = 1e6;
    config.transport.byteBurst = 1e9;
  };
  TestService server(options);
  TestClient slow(server.port(), 4096);
  slow.greet(false);
  // Asks for files and never reads them: each is bounded to one at a time, so the queue cannot grow.
  for (uint32_t seq = 2; seq < 200; ++seq) slow.send(protocol::Save{seq, std::nullopt});
  TestClient other(server.port());
  other.greet();
  other.awaitPicture([](const auto& h) { return h.flags & protocol::kFrameFinal; });
  // Each is answered once: with its file, or with "busy", because the renderer has not answered an earlier one.
  std::set<uint32_t> answered;
  uint32_t saved = 0, files = 0;
  while ((answered.size() < 198 || files < saved) && slow.step()) {
    if (slow.picture) {
      EXPECT_EQ(slow.picture->header.kind, protocol::FrameKind::file);
      ++files;
    } else if (const auto* done = std::get_if<protocol::Saved>(&*slow.text)) {
      EXPECT_TRUE(answered.insert(done->seq).second) << done->seq;
      ++saved;
    } else if (const auto* error = std::get_if<protocol::ErrorMessage>(&*slow.text)) {
      EXPECT_EQ(error->code, "busy");
      EXPECT_TRUE(answered.insert(error->seq.value_or(0)).second) << error->seq.value_or(0);
    }
  }
  EXPECT_EQ(answered.size(), 198u);
  EXPECT_GE(saved, 1u);
  EXPECT_EQ(files, saved);
}

TEST(Peers, theyMayVanishAtAnyByte) {
  TestService server;
  const std::string hello =
      frameBytes(RawClient::Opcode::text, R"({"op":"hello","seq":1,"version":1,"client":"cut"})", true, true);
  const std::string edit = frameBytes(
      RawClient::Opcode::text, R"({"op":"set","seq":2,"target":"material","material":0,"roughness":0.5})", true, true);
  const std::string whole = RawClient::handshake(server.port()) + hello + edit;
  for (size_t cut = 0; cut <= whole.size(); cut += 7)
    for (const bool reset : {false, true}) {
      RawClient client(server.port());
      client.sendBytes(std::string_view(whole).substr(0, cut));
      if (reset) client.reset();
      else client.shut();
    }
  server.waitForMetric("limn_clients", 0.0);
  server.waitForMetric("limn_connections", 1.0);
  TestClient after(server.port());
  after.greet();
  after.awaitPicture();
}

TEST(Peers, theyMayVanishInTheMiddleOfAPicture) {
  TestService server(endlessLarge());
  for (int i = 0; i < 20; ++i) {
    TestClient client(server.port(), 4096);
    client.greet(std::nullopt, std::vector<protocol::Encoding>{protocol::Encoding::png});
    if (i % 2 == 0) client.socket.reset();
  }
  server.waitForMetric("limn_clients", 0.0);
  TestClient after(server.port());
  after.greet();
  after.awaitPicture();
}

TEST(Peers, theLastOneToLeavePutsTheRendererToSleep) {
  TestService server(endlessLarge());
  {
    TestClient client(server.port());
    client.greet();
    client.awaitPicture();
  }
  server.waitForMetric("limn_clients", 0.0);
  TestClient quiet(server.port());
  quiet.greet(false);
  const uint32_t seq = quiet.nextSeq();
  quiet.send(protocol::Describe{seq});   // behind the news that nobody watches
  quiet.await<protocol::SceneMessage>([&](const auto& s) { return s.seq == seq; });
  const uint64_t published = server.renderer->framesPublished();
  for (uint32_t i = 0; i < 5; ++i) {
    quiet.send(protocol::Describe{quiet.nextSeq()});
    quiet.await<protocol::SceneMessage>();
  }
  EXPECT_EQ(server.renderer->framesPublished(), published);
}

TEST(Peers, idleExitEndsTheLoop) {
  TestService::Options options;
  options.configure = [](ServiceConfig& config) { config.idleExitSeconds = 0.2; };
  TestService server(options);
  {
    TestClient client(server.port());
    client.greet();
  }
  server.loop.join();
  server.loop = std::thread([] {});
}

TEST(Peers, timeInWhichNobodyCanComeIsNotIdle) {
  constexpr double kIdle = 1.5;        // [s]
  TestService::Options options;
  options.ready = false;
  options.configure = [](ServiceConfig& config) { config.idleExitSeconds = kIdle; };
  TestService server(options);
  const double begin = nowSeconds();
  while (nowSeconds() < begin + 2.0 * kIdle) server.metric("limn_clients");
  server.service->setReady(true);
  TestClient client(server.port());
  client.greet();
}

/// The picture of the scene before is as good as one could wish.
TEST(Loading, aWaitForAnErrorIsAboutTheNewScene) {
  const fs::path root = fs::temp_directory_path() / ("limn-wait-" + std::to_string(getpid()));
  fs::create_directories(root);
  std::ofstream(root / "room.glb") << "glTF";
  TestService::Options options;
  options.renderer.frameSeconds = 0.05;
  options.configure = [&](ServiceConfig& config) {
    config.assetRoot = root;
    config.readers.scene = [](const fs::path&) -> Result<LoadedScene> { return LoadedScene{}; };
  };
  TestService server(options);
  TestClient client(server.port());
  client.greet();
  client.awaitPicture([](const protocol::FrameHeader& h) { return h.flags & protocol::kFrameFinal; });
  client.send(protocol::Load{10, "room.glb"});
  client.send(protocol::Wait{11, {}, 0.67f});
  client.awaitReply<protocol::Loaded>(10);
  client.send(protocol::Wait{12, {}, 0.67f});
  for (const uint32_t seq : {11u, 12u}) EXPECT_GE(client.awaitReply<protocol::Waited>(seq).steps, 3u) << seq;
  fs::remove_all(root);
}

TEST(Loading, aSceneUnderTheRootIsLoadedAndToldToAll) {
  const fs::path root = fs::temp_directory_path() / ("limn-load-" + std::to_string(getpid()));
  fs::create_directories(root / "sub");
  std::ofstream(root / "sub" / "room.glb") << "glTF";
  std::ofstream(root / "bad.glb") << "no";
  fs::create_symlink("/etc", root / "out");
  TestService::Options options;
  options.configure = [&](ServiceConfig& config) {
    config.assetRoot = root;
    config.readers.scene = [](const fs::path& file) -> Result<LoadedScene> {
      if (file.filename() == "bad.glb") return Error{"bad-file", "not glTF", "bad.glb#/asset"};
      LoadedScene loaded;
      loaded.scene.name = file.filename().string();
      return loaded;
    };
  };
  TestService server(options);
  TestClient asks(server.port()), other(server.port());
  asks.greet(false);
  other.greet(false);
  const auto before = other.await<protocol::SceneMessage>();
  asks.send(protocol::Load{10, "bad.glb"});
  const auto error = asks.await<protocol::ErrorMessage>();
  EXPECT_EQ(error.code, "bad-file");
  EXPECT_EQ(error.place, "bad.glb#/asset");
  EXPECT_EQ(error.seq, 10u);
  asks.send(protocol::Load{11, "out/passwd"});
  EXPECT_EQ(asks.await<protocol::ErrorMessage>().code, "path");

  asks.send(protocol::Load{12, "sub/room.glb"});
  const auto loaded = asks.awaitReply<protocol::Loaded>(12);
  EXPECT_NE(loaded.hash.value, before.hash.value);
  for (TestClient* client : {&asks, &other}) {
    const auto scene =
        client->await<protocol::SceneMessage>([](const auto& s) { return s.cause == protocol::SceneCause::loaded; });
    EXPECT_EQ(scene.name, "room.glb");
    EXPECT_EQ(scene.hash.value, loaded.hash.value);
  }
  fs::remove_all(root);
}

/// A service whose asset root has a "sky.hdr", which reads well, and a "bad.hdr", which does not.
struct SkyService {
  explicit SkyService(std::function<void()> beforeReading = [] {}) {
    fs::create_directories(root / "folder");
    for (const char* name : {"sky.hdr", "bad.hdr"}) std::ofstream(root / name) << "#?";
    TestService::Options options;
    options.configure = [this, beforeReading](ServiceConfig& config) {
      config.assetRoot = root;
      config.readers.image = [beforeReading](const fs::path& file) -> Result<Image> {
        beforeReading();
        if (file.filename() == "bad.hdr") return Error{"bad-file", "no texels", "bad.hdr"};
        Image image;
        image.name = file.filename().string();
        image.width = image.height = 1;
        image.rgbaF = {1.0f, 1.0f, 1.0f, 1.0f};
        return image;
      };
    };
    server = std::make_unique<TestService>(options);
  }
  ~SkyService() {
    server.reset();
    fs::remove_all(root);
  }

  const fs::path root = fs::temp_directory_path() / ("limn-sky-" + std::to_string(getpid()));
  std::unique_ptr<TestService> server;
};

protocol::SetMessage setSky(uint32_t seq, const std::string& uri) {
  protocol::EnvironmentEdit edit;
  edit.image = uri;
  return {seq, edit};
}

TEST(Loading, anEnvironmentImageIsReadAndThenSet) {
  const SkyService sky;
  TestClient client(sky.server->port());
  client.greet(false);
  const auto image = [&](uint32_t seq) {
    client.send(protocol::Describe{seq});
    return client.awaitReply<protocol::SceneMessage>(seq).environment;
  };
  client.send(setSky(10, "sky.hdr"));
  EXPECT_EQ(client.awaitReply<protocol::Ack>(10).cost, protocol::CostClass::relight);
  EXPECT_EQ(image(11).image, "sky.hdr");
  EXPECT_TRUE(image(12).hasImage);
  client.send(setSky(15, ""));
  EXPECT_EQ(client.awaitReply<protocol::Ack>(15).cost, protocol::CostClass::relight);
  EXPECT_FALSE(image(16).hasImage);
  EXPECT_EQ(image(17).image, "");
}

TEST(Loading, anEnvironmentImageThatCannotBeReadChangesNothing) {
  const SkyService sky;
  TestClient client(sky.server->port());
  client.greet(false);
  const auto before = client.await<protocol::SceneMessage>();
  const std::pair<const char*, const char*> cases[] = {
      {"none.hdr", "io"}, {"../sky.hdr", "path"}, {"/etc/passwd", "path"}, {"folder", "path"}, {"bad.hdr", "bad-file"}};
  uint32_t seq = 10;
  for (const auto& [uri, code] : cases) {
    client.send(protocol::Batch{++seq, {protocol::LightEdit{0, std::nullopt, 77.0f}, setSky(0, uri).edit}});
    const auto error = client.await<protocol::ErrorMessage>();
    EXPECT_EQ(error.seq, seq) << uri;
    EXPECT_EQ(error.code, code) << uri;
    EXPECT_EQ(error.place, "seq " + std::to_string(seq) + " /edits/1/image") << uri;
    EXPECT_NE(error.message.find(uri), std::string::npos) << error.message;
  }
  client.send(protocol::Describe{++seq});
  EXPECT_EQ(client.awaitReply<protocol::SceneMessage>(seq).hash.value, before.hash.value);
}

TEST(Loading, nothingWaitsForAnEnvironmentImageButItsEdit) {
  std::atomic<bool> go{false};
  const SkyService sky([&] { go.wait(false); });
  TestClient client(sky.server->port());
  client.greet(false);
  client.send(setSky(10, "sky.hdr"));
  client.send(setSky(11, "sky.hdr"));
  const auto busy = client.await<protocol::ErrorMessage>();
  EXPECT_EQ(busy.code, "busy");
  EXPECT_EQ(busy.seq, 11u);
  client.send(setRoughness(12, 0, 0.25f));
  client.awaitReply<protocol::Ack>(12);
  go = true;
  go.notify_all();
  client.awaitReply<protocol::Ack>(10);
  client.send(setSky(13, "sky.hdr"));
  client.awaitReply<protocol::Ack>(13);
}

TEST(Loading, oneAtATimePerClient) {
  std::atomic<bool> go{false};
  const fs::path root = fs::temp_directory_path() / ("limn-busy-" + std::to_string(getpid()));
  fs::create_directories(root);
  std::ofstream(root / "a.glb") << "glTF";
  TestService::Options options;
  options.configure = [&](ServiceConfig& config) {
    config.assetRoot = root;
    config.readers.scene = [&](const fs::path&) -> Result<LoadedScene> {
      go.wait(false);
      return LoadedScene{};
    };
  };
  TestService server(options);
  TestClient client(server.port());
  client.greet(false);
  client.send(protocol::Load{10, "a.glb"});
  client.send(protocol::Load{11, "a.glb"});
  const auto busy = client.await<protocol::ErrorMessage>();
  EXPECT_EQ(busy.code, "busy");
  EXPECT_EQ(busy.seq, 11u);
  client.send(protocol::Ping{12});
  client.awaitReply<protocol::Pong>(12);   // the loop does not wait for the file
  go = true;
  go.notify_all();
  client.awaitReply<protocol::Loaded>(10);
  fs::remove_all(root);
}

}  // namespace
}  // namespace limn::server::testing
