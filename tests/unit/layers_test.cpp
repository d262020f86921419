// Includes point leftward only: base <- vk, base <- scene <- gpu <- visibility <- the slots <- film <- techniques <- session <- server.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace limn {
namespace {

namespace fs = std::filesystem;

using Layers = std::set<std::string>;

const std::string kRoot = LIMN_SOURCE_DIR;
const Layers kSlots{"direct", "cache", "placement", "gather", "reconstruct"};

Layers joined(Layers a, const Layers& b) {
  a.insert(b.begin(), b.end());
  return a;
}

/// What each folder of renderer/ may include of the others. A folder that is not listed here has no place in the house.
std::map<std::string, Layers> rendererLayers() {
  std::map<std::string, Layers> may;
  may["base"] = {};
  may["vk"] = {"base"};
  may["scene"] = {"base"};
  may["gpu"] = {"base", "vk", "scene"};
  may["visibility"] = joined(may["gpu"], {"gpu"});
  for (const std::string& slot : kSlots) may[slot] = joined(may["visibility"], joined({"visibility"}, kSlots));
  may["film"] = joined(may["visibility"], joined({"visibility"}, kSlots));
  may["techniques"] = joined(may["film"], {"film"});
  may["session"] = joined(may["techniques"], {"techniques"});
  return may;
}

std::vector<fs::path> sourcesUnder(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot + "/" + folder)) {
    const std::string extension = entry.path().extension();
    if (entry.is_regular_file() && (extension == ".cpp" || extension == ".hpp")) files.push_back(entry.path());
  }
  return files;
}

/// Targets of the file's #include "..." lines. Every header of ours is included by its path from the root: were it
/// written otherwise, the rules below would not see it.
std::vector<std::string> includesOf(const fs::path& file) {
  std::vector<std::string> found;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::string start = "#include \"";
    if (line.starts_with(start)) found.push_back(line.substr(start.size(), line.find('"', start.size()) - start.size()));
  }
  return found;
}

std::string shown(const fs::path& file) { return fs::relative(file, kRoot).string(); }

/// "vk" of "renderer/vk/buffer.hpp"; empty when the path has no such folder.
std::string folderIn(const std::string& path, const std::string& house) {
  if (!path.starts_with(house + "/")) return "";
  const size_t begin = house.size() + 1, end = path.find('/', begin);
  return end == path.npos ? "" : path.substr(begin, end - begin);
}

TEST(Layers, RendererIncludesLeftwardOnly) {
  const auto may = rendererLayers();
  for (const fs::path& file : sourcesUnder("renderer")) {
    const std::string own = folderIn(shown(file), "renderer");
    ASSERT_TRUE(may.contains(own)) << shown(file) << " stands in no layer";
    for (const std::string& include : includesOf(file)) {
      EXPECT_FALSE(include.starts_with("server/") || include.starts_with("protocol/") || include.starts_with("tests/"))
          << shown(file) << " includes " << include;
      const std::string other = folderIn(include, "renderer");
      if (other.empty() || other == own) continue;
      EXPECT_TRUE(may.at(own).contains(other)) << shown(file) << " includes " << include;
    }
  }
}

/// What the other tests look at is all there is: every quoted include is found, and names a file of ours or one made in
/// the build.
TEST(Layers, EveryQuotedIncludeNamesAFile) {
  for (const std::string house : {"renderer", "protocol", "server"})
    for (const fs::path& file : sourcesUnder(house)) {
      std::ifstream in(file);
      size_t quoted = 0;
      for (std::string line; std::getline(in, line);) quoted += line.find("#include \"") != std::string::npos;
      const std::vector<std::string> includes = includesOf(file);
      EXPECT_EQ(includes.size(), quoted) << shown(file);
      for (const std::string& include : includes)
        EXPECT_TRUE(fs::exists(kRoot + "/" + include) || fs::exists(LIMN_BUILD_DIR "/" + include))
            << shown(file) << " includes " << include;
    }
}

TEST(Layers, ProtocolKnowsTheBaseAlone) {
  for (const fs::path& file : sourcesUnder("protocol"))
    for (const std::string& include : includesOf(file)) {
      EXPECT_TRUE(include.starts_with("protocol/") || include.starts_with("renderer/base/"))
          << shown(file) << " includes " << include;
    }
}

TEST(Layers, NothingIncludesTestsButTests) {
  for (const std::string house : {"renderer", "protocol", "server"})
    for (const fs::path& file : sourcesUnder(house))
      for (const std::string& include : includesOf(file)) {
        EXPECT_FALSE(include.starts_with("tests/")) << shown(file) << " includes " << include;
      }
}

/// The server speaks to the renderer through its session; only the daemon and the command own a device and a film's file.
TEST(Layers, TheServiceMeetsTheRendererInTheBoxesAlone) {
  const Layers allowed{"base", "scene", "session", "techniques", "film"};
  for (const auto& entry : fs::directory_iterator(kRoot + "/server")) {
    if (!entry.is_regular_file()) continue;
    for (const std::string& include : includesOf(entry.path())) {
      const std::string layer = folderIn(include, "renderer");
      EXPECT_TRUE(layer.empty() || allowed.contains(layer)) << shown(entry.path()) << " includes " << include;
    }
  }
}

TEST(Layers, SharedHeadersOfShadersIncludeNoRenderer) {
  for (const auto& entry : fs::recursive_directory_iterator(kRoot + "/shaders"))
    if (entry.is_regular_file() && entry.path().extension() != ".cpp")
      for (const std::string& include : includesOf(entry.path())) {
        EXPECT_TRUE(include.starts_with("shaders/")) << shown(entry.path()) << " includes " << include;
      }
}

}  // namespace
}  // namespace limn
