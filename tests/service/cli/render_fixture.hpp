#pragma once
#include <string>
#include <utility>
#include <vector>

#include "renderer/film/exr.hpp"
#include "tests/service/cli/scratch_fixture.hpp"

namespace limn::test {

/// Real renders, small ones, of the Cornell box.
class RenderFixture : public ScratchFixture {
 protected:
  static inline const std::string kScene = LIMN_BUILD_DIR "/scenes/cornell-box.glb";

  static ProgramRun run(const std::string& output, std::vector<std::string> flags = {}) {
    flags.insert(flags.begin(), {"render", kScene, "--output", file(output), "--size", "24x20"});
    return runProgram(LIMN_PROGRAM, flags);
  }
  /// The film of a render that must succeed.
  static FilmImage film(const std::string& output, std::vector<std::string> flags) {
    const ProgramRun done = run(output, std::move(flags));
    EXPECT_EQ(done.exitCode, 0) << done.err;
    Result<FilmImage> image = readExr(file(output));
    return image ? image.take() : FilmImage{};
  }
};

}  // namespace limn::test
