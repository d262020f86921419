#include "server/limn/output_file.hpp"

#include <gtest/gtest.h>

#include "renderer/base/file_bytes.hpp"
#include "tests/service/cli/run_program.hpp"

namespace limn {
namespace {

namespace fs = std::filesystem;

TEST(OutputFile, WhatCanBeWrittenIsLeftAsItWas) {
  const test::ScratchDirectory scratch;
  std::ofstream(scratch.file("old.exr")) << "kept";
  fs::create_symlink(scratch.file("old.exr"), scratch.file("link.exr"));
  for (const char* name : {"old.exr", "new.exr", "link.exr"})
    EXPECT_TRUE(checkWritable(scratch.file(name)).ok()) << name;
  EXPECT_EQ(test::readText(scratch.file("old.exr")), "kept");
  EXPECT_FALSE(fs::exists(scratch.file("new.exr")));
  const auto files = fs::directory_iterator(scratch.file("."));
  EXPECT_EQ(std::distance(fs::begin(files), fs::end(files)), 2) << "nothing is left beside them";
}

TEST(OutputFile, WhatCannotBeWrittenIsToldAsTheWriterWouldFindIt) {
  const test::ScratchDirectory scratch;
  fs::create_directory(scratch.file("directory.exr"));
  std::ofstream(scratch.file("plain")) << "a file";
  const std::vector<std::pair<std::string, std::string>> refusals = {
      {scratch.file("directory.exr"), "is a directory"},
      {scratch.file("absent/a.exr"), "no such directory"},
      {scratch.file("plain/a.exr"), "no such directory"},
      {scratch.file(std::string(250, 'n') + ".exr"), "File name too long"},
      {"/dev/full", "is not a regular file"},
      {"/proc/a.exr", "cannot be written"}};
  for (const auto& [file, says] : refusals) {
    const Result<void> checked = checkWritable(file);
    ASSERT_FALSE(checked.ok()) << file;
    EXPECT_EQ(checked.error().code, "io");
    EXPECT_NE(checked.error().message.find(says), std::string::npos) << checked.error().text();
    EXPECT_NE(file.find(checked.error().place), std::string::npos) << checked.error().place;
  }
  EXPECT_FALSE(writeFileAtomically("/proc/a.exr", {}).ok()) << "else the check is too strict";
}

}  // namespace
}  // namespace limn
