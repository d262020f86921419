// What the process of the daemon costs, and how it ends when the device does not go on.
#include <unistd.h>

#include <fstream>

#include "renderer/base/clock.hpp"
#include "tests/service/daemon_fixture.hpp"
#include "tests/support/environment_variable.hpp"

namespace limn::server::testing {
namespace {

/// Processor time of another process, all its threads [s]. proc(5), fields 14 and 15 of stat.
double processorSecondsOf(pid_t process) {
  std::ifstream in("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(in, text);
  std::istringstream fields(text.substr(text.rfind(')') + 2));   // the name before it may hold anything
  double ticks[2] = {};
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  fields >> ticks[0] >> ticks[1];
  return (ticks[0] + ticks[1]) / double(sysconf(_SC_CLK_TCK));
}

/// The share of one processor that the daemon takes for a second.
double shareWhileAtRest(const Daemon& daemon, TestClient& client) {
  constexpr double kWatched = 1.0;   // [s]
  const double spent = processorSecondsOf(daemon.process.pid()), begin = nowSeconds();
  const auto asked = [&] { return nowSeconds() - begin; };
  while (asked() < kWatched) (void)client.socket.receive(kWatched - asked());
  return (processorSecondsOf(daemon.process.pid()) - spent) / asked();
}

constexpr double kShareAtRest = 0.05;   // the event loop wakes twenty times a second for its timers

/// Whether the daemon comes to rest: after the first picture it warms up the pipelines of the other techniques.
bool comesToRest(const Daemon& daemon, TestClient& client) {
  constexpr int kMostSeconds = 60;
  for (int i = 0; i < kMostSeconds; ++i)
    if (shareWhileAtRest(daemon, client) < kShareAtRest) return true;
  return false;
}

TEST(LimndProcess, unwatchedItCostsNoProcessor) {
  Daemon daemon;
  TestClient client(daemon.port);
  client.greet(false);
  client.await<protocol::SceneMessage>();
  client.send(protocol::Ping{client.nextSeq()});
  client.await<protocol::Pong>();
  EXPECT_TRUE(comesToRest(daemon, client));
}

TEST(LimndProcess, convergedItCostsNoProcessor) {
  Daemon daemon;
  TestClient client(daemon.port);
  client.greet();
  endAfter(client, 4);
  pictureAtRest(client, 2);
  client.send(protocol::Ping{client.nextSeq()});
  client.await<protocol::Pong>();
  EXPECT_TRUE(comesToRest(daemon, client));
}

TEST(LimndProcess, aDeviceThatIsLostWhileStartingIsExit75) {
  const test::EnvironmentVariable lose("LIMN_LOSE_DEVICE_AT", "1");
  ChildProcess process(kProgram, Daemon::defaults());
  EXPECT_EQ(process.readLine(), "") << "it never listened";
  EXPECT_EQ(process.wait(), 75);
  EXPECT_NE(process.errors().find("limnd: vkQueueSubmit2 failed with VK_ERROR_DEVICE_LOST"), std::string::npos)
      << process.errors();
}

TEST(LimndProcess, aDeviceThatIsLostWhileRenderingIsToldToClientsAndExit75) {
  const test::EnvironmentVariable lose("LIMN_LOSE_DEVICE_AT", "200");
  Daemon daemon;
  TestClient client(daemon.port);
  client.greet();
  EXPECT_EQ(client.await<protocol::ErrorMessage>().code, "device-lost");
  while (client.step()) {
  }
  EXPECT_EQ(client.closeCode, 1011);
  EXPECT_EQ(daemon.process.wait(), 75) << daemon.process.errors();
}

TEST(LimndProcess, theValidationLayerIsOnInTheseTests) {
  Daemon daemon;
  daemon.process.signal(SIGTERM);
  EXPECT_EQ(daemon.process.wait(), 0);
  EXPECT_NE(daemon.process.errors().find("validation layer on"), std::string::npos) << daemon.process.errors();
}

}  // namespace
}  // namespace limn::server::testing
