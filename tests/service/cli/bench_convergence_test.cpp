// The benchmark's slope and spread of the path tracer, on a made room.
#include "server/limn/bench_convergence.hpp"

#include <gtest/gtest.h>

#include "server/limn/bench_growth.hpp"
#include "tests/service/cli/run_program.hpp"
#include "tests/support/shared_device.hpp"

namespace limn::bench {
namespace {

TEST(BenchConvergence, ThePathTracersErrorFallsAsItsSamplesFasterWithSobolPointsAndIsAsTold) {
  const test::ScratchDirectory scratch;
  BenchOptions options;
  options.references = scratch.file("references");
  options.convergence = 3;
  SessionConfig config;
  config.technique = "path-tracing";
  config.parameters = {{"adaptive", 0.0}};
  const LoadedScene room = growthScene(200, 4);
  for (const char* run : {"first", "with the reference kept"}) {
    SCOPED_TRACE(run);
    const Result<Convergence> measured =
        measureConvergence(test::SharedDevice::get(), room, options, "room", config);
    ASSERT_TRUE(measured.ok()) << measured.error().text();
    EXPECT_EQ(measured->seeds, 3u);
    ASSERT_TRUE(measured->independent && measured->spread);
    for (const Convergence::Fall& fall : {measured->own, *measured->independent}) {
      ASSERT_EQ(fall.levels.size(), 5u);
      for (size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(fall.levels[i].samples, double(kFewestSamples << i));
        EXPECT_GE(fall.levels[i].relMseAll, fall.levels[i].relMse);
      }
      ASSERT_TRUE(fall.slopeAll);
    }
    EXPECT_EQ(judgeSlope(*measured->independent->slopeAll), SlopeVerdict::met)
        << measured->independent->slopeAll->exponent;
    EXPECT_NE(judgeSlope(*measured->own.slopeAll), SlopeVerdict::flatter) << measured->own.slopeAll->exponent;
    EXPECT_GT(measured->own.slopeAll->exponent, -2.0);
    EXPECT_GT(*measured->gain(), 1.0);
    // Evenly spread points may differ by less than the film expects, and never by more.
    EXPECT_GT(measured->spread->ratio(), 0.5);
    EXPECT_LT(measured->spread->ratio(), 1.2);
  }
}

}  // namespace
}  // namespace limn::bench
