#include "server/daemon/daemon_options.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limn::server {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class DaemonOptionsTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(m_directory); }
  void TearDown() override { fs::remove_all(m_directory); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(m_directory / name) << text;
    return (m_directory / name).string();
  }
  static Error errorOf(const std::vector<std::string>& words) {
    const auto options = readDaemonOptions(words);
    EXPECT_FALSE(options.ok());
    return options.ok() ? Error{} : options.error();
  }

  fs::path m_directory = fs::temp_directory_path() / ("limn-options-" + std::to_string(getpid()));
};

TEST_F(DaemonOptionsTest, defaultsAreLocal) {
  const auto options = readDaemonOptions({"--scene", "scenes/room.glb"});
  ASSERT_TRUE(options.ok());
  EXPECT_EQ(options->listenHost, "127.0.0.1");
  EXPECT_EQ(options->port, 8080);
  EXPECT_EQ(options->assetRoot, "scenes");
  EXPECT_EQ(options->width, 512u);
  EXPECT_EQ(readDaemonOptions({"--scene", "room.glb"})->assetRoot, ".");
}

TEST_F(DaemonOptionsTest, everyFlagIsRead) {
  const std::string token = file("token", "s3cret-token\n");
  const auto options = readDaemonOptions({"--scene",
                                          "a.glb",
                                          "--listen",
                                          "[::1]:0",
                                          "--token-file",
                                          token,
                                          "--allow-origin",
                                          "https://a",
                                          "--allow-origin=https://b",
                                          "--asset-root",
                                          "/srv",
                                          "--device",
                                          "llvmpipe",
                                          "--technique",
                                          "path-tracing",
                                          "--size",
                                          "640x360",
                                          "--max-clients",
                                          "3",
                                          "--idle-exit",
                                          "900",
                                          "--state-dir",
                                          "/var/limn",
                                          "--journal",
                                          "/var/edits",
                                          "--base-path",
                                          "/s/7/"});
  ASSERT_TRUE(options.ok()) << options.error().text();
  EXPECT_EQ(options->listenHost, "::1");
  EXPECT_EQ(options->port, 0);
  EXPECT_EQ(options->token, "s3cret-token");
  EXPECT_THAT(options->allowedOrigins, ElementsAre("https://a", "https://b"));
  EXPECT_EQ(options->assetRoot, "/srv");
  EXPECT_EQ(options->height, 360u);
  EXPECT_EQ(options->maxClients, 3u);
  EXPECT_EQ(options->idleExitSeconds, 900.0);
  EXPECT_EQ(options->journalDir, "/var/edits");
  EXPECT_EQ(options->basePath, "/s/7");
}

TEST_F(DaemonOptionsTest, configurationFillsWhatWasNotGiven) {
  const std::string config = file("limnd.json", R"({"scene": "b.glb", "size": "320x200", "max-clients": 5,
    "allow-origin": ["https://a", "https://b"], "technique": "path-tracing"})");
  const auto options = readDaemonOptions({"--config", config, "--size", "640x480"});
  ASSERT_TRUE(options.ok()) << options.error().text();
  EXPECT_EQ(options->scene, "b.glb");
  EXPECT_EQ(options->width, 640u);
  EXPECT_EQ(options->maxClients, 5u);
  EXPECT_EQ(options->allowedOrigins.size(), 2u);
}

TEST_F(DaemonOptionsTest, wrongFlagsAreUsageErrors) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{},
                                             {"--scene", "a", "--nonsense"},
                                             {"--scene", "a", "--listen", "8080"},
                                             {"--scene", "a", "--listen", "host.example:80"},
                                             {"--scene", "a", "--listen", "127.0.0.1:70000"},
                                             {"--scene", "a", "--size", "0x7"},
                                             {"--scene", "a", "--size", "9000x7"},
                                             {"--scene", "a", "--max-clients", "0"},
                                             {"--scene", "a", "--idle-exit", "-1"},
                                             {"--scene", "a", "--base-path", "x"},
                                             {"--scene", "a", "--base-path", "/a/../b"},
                                             {"--scene", "a", "extra"},
                                             {"--scene"}})
    EXPECT_EQ(errorOf(words).code, "usage") << ::testing::PrintToString(words);
}

TEST_F(DaemonOptionsTest, wrongConfigurationsAreErrors) {
  EXPECT_EQ(errorOf({"--config", file("a.json", "[]")}).code, "usage");
  EXPECT_EQ(errorOf({"--config", file("b.json", "{")}).code, "usage");
  EXPECT_EQ(errorOf({"--config", file("c.json", R"({"scene":"a","colour":"red"})")}).code, "usage");
  EXPECT_EQ(errorOf({"--config", file("d.json", R"({"scene":{}})")}).code, "usage");
  EXPECT_EQ(errorOf({"--config", file("f.json", R"({"scene":true})")}).code, "usage");
  EXPECT_EQ(errorOf({"--config", file("e.json", R"({"config":"x"})")}).code, "usage");
  EXPECT_EQ(errorOf({"--config", (m_directory / "absent").string()}).code, "io");
}

TEST_F(DaemonOptionsTest, listeningBeyondThisMachineNeedsAToken) {
  EXPECT_EQ(errorOf({"--scene", "a", "--listen", "0.0.0.0:80"}).code, "token");
  EXPECT_TRUE(
      readDaemonOptions({"--scene", "a", "--listen", "0.0.0.0:80", "--token-file", file("t", "0123456789")}).ok());
}

TEST_F(DaemonOptionsTest, poorTokensAreRefused) {
  EXPECT_EQ(errorOf({"--scene", "a", "--token-file", file("short", "1234567")}).code, "io");
  EXPECT_EQ(errorOf({"--scene", "a", "--token-file", file("blank", "12345 6789")}).code, "io");
  EXPECT_EQ(errorOf({"--scene", "a", "--token-file", file("mark", "12345;6789")}).code, "io");
  EXPECT_EQ(errorOf({"--scene", "a", "--token-file", "/nowhere"}).code, "io");
}

TEST_F(DaemonOptionsTest, helpNamesEveryFlag) {
  const std::string text = helpText(daemonSpec());
  for (const Flag& flag : daemonSpec().flags) EXPECT_THAT(text, HasSubstr("--" + flag.name));
}

}  // namespace
}  // namespace limn::server
