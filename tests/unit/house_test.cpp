// The house stays small enough to read: no file that somebody wrote passes 400 lines.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace limn {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxLines = 400;

const std::string kRoot = LIMN_SOURCE_DIR;
const std::vector<std::string> kHouses{"renderer", "server", "shaders", "protocol", "web/src", "web/dev", "web/test",
                                      "tests", "deploy"};
const std::set<std::string> kSources{".cpp", ".hpp", ".h", ".comp", ".glsl", ".py", ".ts", ".mjs", ".css", ".html", ".cmake", ".sh"};

bool isSource(const fs::path& file) {
  if (file.filename().string().find(".gen.") != std::string::npos) return false;  // made by protocol/generate.py
  if (kSources.contains(file.extension())) return true;
  if (!file.extension().empty()) return file.filename() == "CMakeLists.txt";
  // Commands without an ending: deploy/run, tests/run.
  std::ifstream in(file);
  std::string first;
  return std::getline(in, first) && first.starts_with("#!");
}

std::vector<fs::path> ourFiles() {
  std::vector<fs::path> files;
  for (const std::string& house : kHouses) {
    for (auto it = fs::recursive_directory_iterator(kRoot + "/" + house); it != fs::recursive_directory_iterator(); ++it) {
      if (it->is_directory() && it->path().filename() == "node_modules") it.disable_recursion_pending();
      if (it->is_regular_file() && isSource(it->path())) files.push_back(it->path());
    }
  }
  return files;
}

size_t linesOf(const fs::path& file) {
  std::ifstream in(file);
  size_t count = 0;
  for (std::string line; std::getline(in, line);) ++count;
  return count;
}

TEST(House, NoFilePasses400Lines) {
  const std::vector<fs::path> files = ourFiles();
  EXPECT_GT(files.size(), 200u) << "the sources were not found";
  for (const fs::path& file : files) EXPECT_LE(linesOf(file), kMaxLines) << fs::relative(file, kRoot);
}

TEST(House, NothingIsLeftForLater) {
  const std::string marks[] = {std::string("TO") + "DO", std::string("FIX") + "ME"};
  for (const fs::path& file : ourFiles()) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
      for (const std::string& mark : marks)
        EXPECT_EQ(line.find(mark), std::string::npos) << fs::relative(file, kRoot) << ": " << line;
  }
}

TEST(House, TheTopLevelIsFixed) {
  for (const char* name : {"CMakeLists.txt", "README.md", "LICENSE", "CHANGELOG.md", ".ci", "server", "renderer", "shaders",
                           "protocol", "web", "tests", "deploy"})
    EXPECT_TRUE(fs::exists(fs::path(kRoot) / name)) << name;
}

}  // namespace
}  // namespace limn
