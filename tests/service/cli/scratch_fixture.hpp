#pragma once
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "tests/service/cli/run_program.hpp"
#include "tests/support/environment_variable.hpp"

namespace limn::test {

/// Tests that share one directory, and in it what programs keep between runs, so that only the first compiles pipelines.
class ScratchFixture : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    s_scratch.emplace();
    s_cache.emplace("XDG_CACHE_HOME", file("cache"));
  }
  static void TearDownTestSuite() {
    s_cache.reset();
    s_scratch.reset();
  }
  static std::string file(const std::string& name) { return s_scratch->file(name); }

 private:
  static inline std::optional<ScratchDirectory> s_scratch;
  static inline std::optional<EnvironmentVariable> s_cache;
};

}  // namespace limn::test
