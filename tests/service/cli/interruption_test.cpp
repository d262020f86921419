#include "server/limn/interruption.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

namespace limn {
namespace {

/// A process of its own a death: libraries that are linked in have started threads.
class InterruptionDeathTest : public testing::Test {
 protected:
  InterruptionDeathTest() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST(Interruption, TheFirstSignalIsNoted) {
  for (const int number : {SIGINT, SIGTERM}) {
    const Interruption interruption;
    EXPECT_EQ(Interruption::signal(), 0);
    std::raise(number);
    EXPECT_EQ(Interruption::signal(), number);
  }
  EXPECT_EQ(Interruption::signal(), SIGTERM) << "the exit code is made of it afterwards";
}

void raiseBoth(int first, int second) {
  const Interruption interruption;
  std::raise(first);
  if (Interruption::signal() == first) std::raise(second);
  std::exit(0);
}

TEST_F(InterruptionDeathTest, TheSecondSignalEndsTheProcessAtOnce) {
  for (const int first : {SIGINT, SIGTERM})
    for (const int second : {SIGINT, SIGTERM})
      EXPECT_EXIT(raiseBoth(first, second), testing::KilledBySignal(second), "") << first << " " << second;
}

TEST_F(InterruptionDeathTest, AfterItTheFirstSignalEndsTheProcess) {
  { const Interruption interruption; }
  EXPECT_EXIT(std::raise(SIGINT), testing::KilledBySignal(SIGINT), "");
}

TEST(Interruption, AnIgnoredSignalStaysIgnored) {
  void (*const before)(int) = std::signal(SIGINT, SIG_IGN);
  {
    const Interruption interruption;
    std::raise(SIGINT);
    EXPECT_EQ(Interruption::signal(), 0);
  }
  EXPECT_EQ(std::signal(SIGINT, before), SIG_IGN);
}

}  // namespace
}  // namespace limn
