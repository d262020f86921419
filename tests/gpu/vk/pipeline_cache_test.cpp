#include "tests/gpu/vk/vk_fixture.hpp"

#include <fstream>
#include <iterator>

#include "tests/gpu/vk/count.spv.hpp"

namespace limn::vk {
namespace {

class PipelineCacheTest : public testing::Test {
 protected:
  DeviceOptions options() const {
    DeviceOptions result;
    result.cacheDir = directory.path() + "/cache";
    return result;
  }
  static void makePipeline(Device& device) {
    PipelineDesc desc;
    desc.name = "count";
    desc.spirv = countSpirv;
    desc.layout = {{0, BindingKind::storage}};
    must(ComputePipeline::create(device, desc));
  }
  /// One run of the program: the path of its cache file.
  std::string run(bool expectLoaded) {
    const ValidatedDevice device(options());
    EXPECT_EQ(device->pipelineCacheLoaded(), expectLoaded);
    makePipeline(*device);
    return device->pipelineCachePath();
  }
  static std::string read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {(std::istreambuf_iterator<char>(file)), {}};
  }
  static void write(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  }

  TemporaryDirectory directory;
};

TEST_F(PipelineCacheTest, TheSecondRunLoadsWhatTheFirstWrote) {
  const std::string path = run(false);
  ASSERT_TRUE(std::filesystem::exists(path));
  EXPECT_EQ(run(true), path);
  for (const auto& entry : std::filesystem::directory_iterator(options().cacheDir)) {
    const bool ours = entry.path().filename().string().rfind("pipelines_", 0) == 0;
    EXPECT_TRUE(!ours || entry.path().string() == path) << entry.path() << " was left";
  }
}

TEST_F(PipelineCacheTest, SavingWhileTheDeviceLivesIsAllowed) {
  const ValidatedDevice device(options());
  makePipeline(*device);
  must(device->savePipelineCache());
  EXPECT_TRUE(std::filesystem::exists(device->pipelineCachePath()));
}

TEST_F(PipelineCacheTest, ADamagedFileIsIgnoredAndReplaced) {
  const std::string path = run(false);
  const std::string whole = read(path);
  std::string altered = whole;
  altered.back() = char(altered.back() ^ 1);
  std::string foreign = whole;
  foreign[30] = char(foreign[30] ^ 1);
  for (const std::string& bytes : {std::string(), whole.substr(0, 10), whole.substr(0, whole.size() - 1), whole + "x",
                                   altered, foreign, std::string(100000, '\xff')}) {
    write(path, bytes);
    run(false);
    run(true);
  }
}

TEST_F(PipelineCacheTest, WithoutADirectoryNothingIsWritten) {
  const ValidatedDevice device;
  EXPECT_EQ(device->pipelineCachePath(), "");
  EXPECT_FALSE(device->pipelineCacheLoaded());
  must(device->savePipelineCache());
}

TEST_F(PipelineCacheTest, ADirectoryThatCannotBeMadeIsAnErrorOfSavingOnly) {
  DeviceOptions blocked = options();
  write(directory.path() + "/file", "not a directory");
  blocked.cacheDir = directory.path() + "/file/cache";
  const ValidatedDevice device(blocked);
  const auto saved = device->savePipelineCache();
  ASSERT_FALSE(saved.ok());
  EXPECT_EQ(saved.error().code, "io");
}

}  // namespace
}  // namespace limn::vk
