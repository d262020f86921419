// Which files a scene may reach, and how their bytes come in.
#include <sys/stat.h>

#include <atomic>
#include <thread>

#include "renderer/scene/asset_files.hpp"
#include "tests/unit/gltf_builder.hpp"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

/// A .gltf of one square whose buffer is named by `uri`, beside "data/square.bin" that holds its bytes.
struct Assets {
  TempFolder folder;
  GltfBuilder builder;

  Assets() {
    builder.square();
    folder.write("outside.bin", std::string(4096, '\0'));
    folder.write("root/data/square.bin", builder.binary);
    folder.write("root/data/a b.bin", builder.binary);
  }
  fs::path root() const { return folder.path() / "root"; }

  std::string loadWith(const std::string& uri, const std::string& at = "root/scene.gltf",
                       const LoadOptions& options = {}) const {
    nlohmann::json doc = builder.doc;
    doc["buffers"] = {{{"byteLength", builder.binary.size()}, {"uri", uri}}};
    const Result<LoadedScene> loaded = loadGltf(folder.write(at, doc.dump()), options);
    return loaded ? "loaded" : loaded.error().code + " " + loaded.error().place;
  }
};

std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

TEST(GltfFiles, RelativeUrisDataUrisAndPercentEncoding) {
  const Assets assets;
  EXPECT_EQ(assets.loadWith("data/square.bin"), "loaded");
  EXPECT_EQ(assets.loadWith("./data/../data/square.bin"), "loaded");
  EXPECT_EQ(assets.loadWith("data/a%20b.bin"), "loaded");
  EXPECT_EQ(assets.loadWith("data:application/octet-stream;base64," + base64(assets.builder.binary)), "loaded");
}

TEST(GltfFiles, TheRootMayLieAboveTheFile) {
  const Assets assets;
  LoadOptions options;
  options.assetRoot = assets.root();
  EXPECT_EQ(assets.loadWith("../data/square.bin", "root/scenes/scene.gltf", options), "loaded");
  EXPECT_EQ(assets.loadWith("../../outside.bin", "root/scenes/scene.gltf", options), "path scene.gltf#/buffers/0/uri");
  EXPECT_EQ(assets.loadWith("../data/square.bin", "root/scenes/scene.gltf"), "path scene.gltf#/buffers/0/uri");
}

TEST(GltfFiles, TheFileItselfMustLieBelowTheRoot) {
  const Assets assets;
  LoadOptions options;
  options.assetRoot = assets.root();
  EXPECT_EQ(assets.loadWith("root/data/square.bin", "scene.gltf", options), "path scene.gltf");
  options.assetRoot = assets.folder.path() / "nowhere";
  EXPECT_EQ(assets.loadWith("data/square.bin", "root/scene.gltf", options), "io scene.gltf");
}

TEST(GltfFiles, NothingElseIsOpened) {
  const Assets assets;
  fs::create_symlink("../outside.bin", assets.root() / "link.bin");
  fs::create_directory_symlink("..", assets.root() / "up");
  fs::create_symlink("data/square.bin", assets.root() / "inner.bin");
  ASSERT_EQ(mkfifo((assets.root() / "fifo.bin").c_str(), 0600), 0);
  for (const char* uri : {"../outside.bin", "data/../../outside.bin", "%2e%2e/outside.bin", "/etc/passwd",
                          "file:///etc/passwd", "http://localhost/x.bin", "link.bin", "up/outside.bin", "inner.bin",
                          "data", "fifo.bin", "data/square.bin%00x", ""}) {
    EXPECT_EQ(assets.loadWith(uri), "path scene.gltf#/buffers/0/uri") << uri;
  }
  EXPECT_EQ(assets.loadWith("data/missing.bin"), "io scene.gltf#/buffers/0/uri");
  EXPECT_EQ(assets.loadWith("data/square.bin/x"), "io scene.gltf#/buffers/0/uri");
  EXPECT_EQ(assets.loadWith(std::string(5000, 'x')), "io scene.gltf#/buffers/0/uri");
}

/// What opening gives, by the kernel's check and by our own walk.
std::pair<std::string, std::string> bothWays(const AssetRoot& root, const std::string& name) {
  const auto text = [](const Result<FileReader>& r) { return r ? "opened" : r.error().code; };
  return {text(root.openFile(name, 1 << 20)), text(root.openFileByComponents(name, 1 << 20))};
}

TEST(GltfFiles, TheWalkByComponentsDecidesAsTheKernelDoes) {
  const Assets assets;
  fs::create_symlink("../outside.bin", assets.root() / "link.bin");
  fs::create_directory_symlink("..", assets.root() / "up");
  ASSERT_EQ(mkfifo((assets.root() / "fifo.bin").c_str(), 0600), 0);
  const Result<AssetRoot> root = AssetRoot::open(assets.root());
  ASSERT_TRUE(root.ok());
  const std::pair<const char*, const char*> cases[] = {{"data/square.bin", "opened"},
                                                       {"data/../data/square.bin", "opened"},
                                                       {"../outside.bin", "path"},
                                                       {"data/../../outside.bin", "path"},
                                                       {"link.bin", "path"},
                                                       {"up/outside.bin", "path"},
                                                       {"fifo.bin", "path"},
                                                       {"data", "path"},
                                                       {".", "path"},
                                                       {"/etc/passwd", "path"},
                                                       {"", "path"},
                                                       {"missing", "io"},
                                                       {"missing/square.bin", "io"}};
  for (const auto& [name, expected] : cases) {
    const auto [kernel, walk] = bothWays(*root, name);
    EXPECT_EQ(kernel, expected) << name;
    EXPECT_EQ(walk, expected) << name;
  }
}

TEST(GltfFiles, SizeLimitHoldsBothWays) {
  const Assets assets;
  const uint64_t size = fs::file_size(assets.root() / "data/square.bin");
  const Result<AssetRoot> root = AssetRoot::open(assets.root());
  EXPECT_TRUE(root->openFile("data/square.bin", size).ok());
  EXPECT_EQ(root->openFile("data/square.bin", size - 1).error().code, "limit");
}

TEST(GltfFiles, RenamingAFolderMeanwhileNeverOpensTheOutside) {
  const Assets assets;
  fs::create_directory_symlink("..", assets.root() / "trap");
  assets.folder.write("square.bin", "outside");  // what root/trap/square.bin would be
  const Result<AssetRoot> root = AssetRoot::open(assets.root());
  std::atomic<bool> stop{false};
  std::thread swapper([&] {
    const fs::path data = assets.root() / "data", trap = assets.root() / "trap", aside = assets.root() / "aside";
    while (!stop) {
      fs::rename(data, aside);
      fs::rename(trap, data);
      fs::rename(data, trap);
      fs::rename(aside, data);
    }
  });
  uint64_t opened = 0;
  for (int i = 0; i < 20000; ++i) {
    const Result<FileReader> file =
        i % 2 ? root->openFile("data/square.bin", 1 << 20) : root->openFileByComponents("data/square.bin", 1 << 20);
    if (!file) continue;
    ++opened;
    ASSERT_EQ(file->size(), assets.builder.binary.size());
  }
  stop = true;
  swapper.join();
  EXPECT_GT(opened, 0u);
}

TEST(GltfFiles, BuffersMayBeLongerThanTheySayButNotShorter) {
  Assets assets;
  assets.folder.write("root/data/long.bin", assets.builder.binary + "more");
  assets.folder.write("root/data/short.bin", assets.builder.binary.substr(1));
  EXPECT_EQ(assets.loadWith("data/long.bin"), "loaded");
  EXPECT_EQ(assets.loadWith("data/short.bin"), "out-of-range scene.gltf#/buffers/0/byteLength");
}

TEST(GltfFiles, FileSizeLimitsCoverTheFileAndItsBuffers) {
  const Assets assets;
  LoadOptions options;
  options.limits.maxFileBytes = 16;
  EXPECT_EQ(assets.loadWith("data/square.bin", "root/scene.gltf", options), "limit scene.gltf");
  options.limits.maxFileBytes = 1 << 20;
  GltfBuilder huge;
  huge.square();
  huge.doc["buffers"] = {{{"byteLength", 1 << 21}}};
  EXPECT_EQ(huge.refusal(options), "limit test.glb#/buffers/0/byteLength");
}

TEST(GltfFiles, TheJsonHasALimitOfItsOwn) {
  GltfBuilder b;
  b.square();
  const std::string glb = b.glb();
  uint32_t chunk = 0;
  std::memcpy(&chunk, glb.data() + 12, sizeof chunk);
  ASSERT_LT(chunk, glb.size());
  LoadOptions options;
  options.limits.maxJsonBytes = chunk;
  EXPECT_TRUE(b.load(options).ok());
  options.limits.maxJsonBytes = chunk - 1;
  EXPECT_EQ(b.refusal(options), "limit test.glb");

  GltfBuilder empty;
  const TempFolder folder;
  const fs::path file = folder.write("empty.gltf", empty.doc.dump());
  options.limits.maxJsonBytes = fs::file_size(file);
  EXPECT_TRUE(loadGltf(file, options).ok());
  options.limits.maxJsonBytes -= 1;
  EXPECT_EQ(loadGltf(file, options).error().code, "limit");
}

TEST(GltfFiles, MissingFilesAndFoldersAreErrors) {
  const TempFolder folder;
  const auto code = [&](const char* name) { return loadGltf(folder.path() / name).error().code; };
  EXPECT_EQ(code("missing.glb"), "io");
  fs::create_directory(folder.path() / "folder.glb");
  EXPECT_EQ(code("folder.glb"), "path");
}

TEST(GltfFiles, ByteOrderMarkIsSkipped) {
  GltfBuilder b;
  const TempFolder folder;
  const Result<LoadedScene> loaded = loadGltf(folder.write("bom.gltf", "\xef\xbb\xbf" + b.doc.dump()));
  EXPECT_TRUE(loaded.ok()) << loaded.error().text();
}

}  // namespace
}  // namespace limn::test
