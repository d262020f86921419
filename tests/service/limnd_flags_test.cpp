// Every flag of limnd does what it says, in the real program.
#include <functional>
#include <fstream>

#include "tests/service/cli/run_program.hpp"
#include "tests/service/daemon_fixture.hpp"

namespace limn::server::testing {
namespace {

const std::string kHost = "Host: localhost";
const std::string kToken = "a-token-of-the-test";

int statusOf(const Daemon& daemon, const std::string& path, std::vector<std::string> headers = {}) {
  headers.push_back(kHost);
  return RawClient(daemon.port).request("GET " + path + " HTTP/1.1", std::move(headers)).status;
}

/// What the daemon says of its scene to one who joins.
protocol::SceneMessage sceneOf(const Daemon& daemon) {
  TestClient client(daemon.port);
  client.greet(false);
  return client.await<protocol::SceneMessage>();
}

std::string deviceOf(const Daemon& daemon) {
  TestClient client(daemon.port);
  return client.greet(false).device;
}

struct FlagCase {
  const char* name;
  std::vector<std::string> flags;
  std::function<void(Daemon&)> check;
};
void PrintTo(const FlagCase& flag, std::ostream* out) { *out << flag.name; }

/// Files that flags name, made once.
const test::ScratchDirectory& files() {
  static const test::ScratchDirectory folder;
  return folder;
}
std::string file(const std::string& name, const std::string& text) {
  std::ofstream(files().file(name)) << text;
  return files().file(name);
}

void expectTechniqueAndSize(Daemon& daemon) {
  const protocol::SceneMessage scene = sceneOf(daemon);
  EXPECT_EQ(scene.technique, "point-projection");
  EXPECT_EQ(scene.width, 48u);
  EXPECT_EQ(scene.height, 40u);
}

void expectToken(Daemon& daemon) {
  EXPECT_EQ(statusOf(daemon, "/metrics"), 401);
  EXPECT_EQ(statusOf(daemon, "/metrics", {"Authorization: Bearer " + kToken}), 200);
  EXPECT_EQ(statusOf(daemon, "/?token=" + kToken), 303);
  EXPECT_EQ(RawClient().upgrade(daemon.port), 401);
  EXPECT_EQ(RawClient().upgrade(daemon.port, {{"Authorization", "Bearer " + kToken}}), 101);
  daemon.process.signal(SIGTERM);
  EXPECT_EQ(daemon.process.wait(), 0);
  EXPECT_EQ(daemon.process.errors().find(kToken), std::string::npos) << "tokens are not logged";
}

void expectOrigins(Daemon& daemon) {
  EXPECT_EQ(RawClient().upgrade(daemon.port, {{"Origin", "https://one.example"}}), 101);
  EXPECT_EQ(RawClient().upgrade(daemon.port, {{"Origin", "https://two.example"}}), 101);
  EXPECT_EQ(RawClient().upgrade(daemon.port, {{"Origin", "https://three.example"}}), 403);
}

void expectOneClient(Daemon& daemon) {
  RawClient first;
  EXPECT_EQ(first.upgrade(daemon.port), 101);
  EXPECT_EQ(RawClient().upgrade(daemon.port), 503);
}

void expectBasePath(Daemon& daemon) {
  EXPECT_TRUE(daemon.line.ends_with("/look/dev/")) << daemon.line;
  RawClient page(daemon.port);
  const RawClient::Reply reply = page.request("GET /look/dev/ HTTP/1.1", {kHost});
  EXPECT_EQ(reply.status, 200);
  EXPECT_NE(reply.body.find("<html"), std::string::npos);
  RawClient metrics(daemon.port);
  // What looks after the daemon asks it directly, past the proxy.
  EXPECT_NE(metrics.request("GET /metrics HTTP/1.1", {kHost}).body.find("limn_clients "), std::string::npos);
  EXPECT_EQ(statusOf(daemon, "/healthz"), 200);
  EXPECT_EQ(statusOf(daemon, "/readyz"), 200);
  EXPECT_EQ(RawClient().upgrade(daemon.port, {}, "/look/dev/ws"), 101);
  for (const char* outside : {"/", "/look/", "/look/device/"}) EXPECT_EQ(statusOf(daemon, outside), 404);
  EXPECT_EQ(RawClient().upgrade(daemon.port, {}, "/ws"), 404);
}

void expectItEndsAlone(Daemon& daemon) { EXPECT_EQ(daemon.process.wait(), 0) << daemon.process.errors(); }

const std::vector<FlagCase>& flagCases() {
  static const std::vector<FlagCase> cases{
      {"technique", {"--technique", "point-projection", "--size", "48x40"}, expectTechniqueAndSize},
      {"config",
       {"--config", file("limnd.json", R"({"technique":"point-projection","size":"48x40"})")},
       expectTechniqueAndSize},
      {"flagsGoBeforeConfig",
       {"--config", file("first.json", R"({"technique":"path-tracing","max-clients":1})"), "--technique",
        "point-projection", "--size", "48x40"},
       [](Daemon& daemon) {
         expectTechniqueAndSize(daemon);
         expectOneClient(daemon);
       }},
      {"tokenFile", {"--token-file", file("token", kToken + "\n")}, expectToken},
      {"allowOrigin",
       {"--allow-origin", "https://one.example", "--allow-origin", "https://two.example"},
       expectOrigins},
      {"maxClients", {"--max-clients", "1"}, expectOneClient},
      {"basePath", {"--base-path", "/look/dev"}, expectBasePath},
      {"idleExit", {"--idle-exit", "2"}, expectItEndsAlone}};
  return cases;
}

class LimndFlag : public ::testing::TestWithParam<FlagCase> {};
INSTANTIATE_TEST_SUITE_P(Each, LimndFlag, ::testing::ValuesIn(flagCases()),
                         [](const auto& flag) { return std::string(flag.param.name); });

TEST_P(LimndFlag, doesWhatItSays) {
  std::vector<std::string> flags{"--scene",     kScene, "--listen", "127.0.0.1:0",
                                 "--state-dir", LIMN_BUILD_DIR "/tests/state"};
  Daemon daemon(flags, GetParam().flags);
  if (daemon.port != 0) GetParam().check(daemon);
}

TEST(LimndFlags, theDeviceIsChosenByNameAndByIndex) {
  Daemon first({"--device", "0"});
  const std::string name = deviceOf(first);
  ASSERT_FALSE(name.empty());
  Daemon second({"--device", name});
  EXPECT_EQ(deviceOf(second), name);
}

}  // namespace
}  // namespace limn::server::testing
