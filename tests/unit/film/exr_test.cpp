#include "renderer/film/exr.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "renderer/film/exr_layers.hpp"
#include "tests/unit/film/film_images.hpp"

namespace limn {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::filesystem::path scratch(const std::string& name) {
  std::filesystem::path directory = std::filesystem::temp_directory_path() / "limn-exr-";
  directory += std::to_string(getpid());
  std::filesystem::create_directories(directory);
  return directory / name;
}

/// A header attribute as it lies in the file.
std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  const uint32_t size = uint32_t(value.size());
  std::string bytes = name + '\0' + type + '\0';
  bytes.append(reinterpret_cast<const char*>(&size), 4);
  return bytes + value;
}

std::string integers(std::initializer_list<int32_t> values) {
  std::string bytes;
  for (const int32_t value : values) bytes.append(reinterpret_cast<const char*>(&value), 4);
  return bytes;
}

struct HeaderParts {
  uint32_t version = 2;
  std::string data = integers({0, 0, 7, 3});
  std::string display = integers({0, 0, 7, 3});
  int32_t channelType = 2;
  int32_t sampling = 1;
  int channelCount = 1;
};

std::vector<uint8_t> headerOf(const HeaderParts& parts) {
  std::string channels;
  for (int i = 0; i < parts.channelCount; ++i) {
    channels.append(std::to_string(i)).push_back('\0');
    channels.append(integers({parts.channelType, 0, parts.sampling, parts.sampling}));
  }
  channels += '\0';
  std::string bytes = integers({20000630, int32_t(parts.version)});
  bytes += attribute("channels", "chlist", channels) + attribute("dataWindow", "box2i", parts.data) +
           attribute("displayWindow", "box2i", parts.display) + '\0';
  return {bytes.begin(), bytes.end()};
}

std::string codeOf(const std::vector<uint8_t>& bytes, const ExrLimits& limits = {}) {
  const Result<FilmImage> image = decodeExr(bytes, "x.exr", limits);
  return image ? "ok" : image.error().code;
}

TEST(Exr, RoundTripKeepsEveryBitOfEveryLayerAndTheMetadata) {
  FilmImage image = test::noiseFilm(67, 41, 7);
  image.layers[0].data[0] = std::numeric_limits<float>::infinity();
  image.layers[0].data[1] = 1e30f;
  image.layers[0].data[2] = -0.0f;
  image.layers[5].data[0] = std::numeric_limits<float>::denorm_min();
  const std::filesystem::path file = scratch("round.exr");
  ASSERT_TRUE(writeExr(file, image).ok());
  const Result<FilmImage> read = readExr(file);
  ASSERT_TRUE(read.ok()) << read.error().text();

  EXPECT_EQ(read->width, image.width);
  EXPECT_EQ(read->height, image.height);
  EXPECT_EQ(read->layers.size(), image.layers.size());
  for (const FilmLayer& layer : image.layers) {
    const FilmLayer* back = read->find(layer.name);
    ASSERT_NE(back, nullptr) << layer.name;
    ASSERT_EQ(back->channels, layer.channels) << layer.name;
    EXPECT_EQ(std::memcmp(back->data.data(), layer.data.data(), layer.data.size() * 4), 0) << layer.name;
  }
  EXPECT_EQ(read->metadata, image.metadata);
  EXPECT_EQ(read->layers.front().name, "beauty");
}

TEST(Exr, TheSameImageGivesTheSameBytes) {
  const FilmImage image = test::noiseFilm(16, 9, 1);
  EXPECT_EQ(encodeExr(image).value(), encodeExr(image).value());
}

TEST(Exr, WritingLeavesNothingBesideTheFile) {
  const std::filesystem::path file = scratch("alone/beauty.exr");
  std::filesystem::create_directories(file.parent_path());
  ASSERT_TRUE(writeExr(file, test::noiseFilm(4, 4, 2)).ok());
  ASSERT_TRUE(writeExr(file, test::noiseFilm(4, 4, 3)).ok());
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(file.parent_path()))
    names.push_back(entry.path().filename());
  EXPECT_THAT(names, ElementsAre("beauty.exr"));
}

TEST(Exr, AFailedWriteNamesTheFileAndKeepsTheOldOne) {
  const Result<void> written = writeExr("/nonexistent/directory/a.exr", test::noiseFilm(2, 2, 1));
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().code, "io");
  EXPECT_THAT(written.error().text(), HasSubstr("/nonexistent/directory/a.exr"));
}

TEST(Exr, LayersWhoseSizeIsWrongAreRefused) {
  FilmImage image = test::noiseFilm(4, 4, 1);
  image.layers[1].data.pop_back();
  const Result<std::vector<uint8_t>> bytes = encodeExr(image);
  ASSERT_FALSE(bytes.ok());
  EXPECT_EQ(bytes.error().code, "bad-image");
}

TEST(Exr, ChannelsAreNamedAsOtherProgramsExpect) {
  EXPECT_THAT(exrChannelNames({"beauty", 3, {}}), ElementsAre("R", "G", "B"));
  EXPECT_THAT(exrChannelNames({"direct", 3, {}}), ElementsAre("direct.R", "direct.G", "direct.B"));
  EXPECT_THAT(exrChannelNames({"normal", 3, {}}), ElementsAre("normal.X", "normal.Y", "normal.Z"));
  EXPECT_THAT(exrChannelNames({"depth", 1, {}}), ElementsAre("depth.Z"));
  EXPECT_THAT(exrChannelNames({"samples", 1, {}}), ElementsAre("samples"));
}

TEST(Exr, ForeignChannelsAllFindALayer) {
  const std::vector<ExrLayerPlan> plans =
      planExrLayers({"A", "B", "G", "R", "ViewLayer.Combined.B", "ViewLayer.Combined.G", "ViewLayer.Combined.R",
                     "ViewLayer.Combined.A", "uv.U", "uv.V", "Z"});
  std::vector<std::string> names;
  size_t channels = 0;
  for (const ExrLayerPlan& plan : plans) {
    names.push_back(plan.name);
    channels += plan.sources.size();
  }
  EXPECT_EQ(channels, 11u);
  EXPECT_THAT(names, ElementsAre("beauty", "ViewLayer.Combined", "ViewLayer.Combined.A", "Z", "A", "uv.U", "uv.V"));
  EXPECT_THAT(plans[0].sources, ElementsAre(3, 2, 1));
}

TEST(Exr, RefusesByHeaderWhatItDoesNotRead) {
  HeaderParts parts;
  parts.version = 2 | 0x800;
  EXPECT_EQ(codeOf(headerOf(parts)), "unsupported") << "deep";
  parts.version = 2 | 0x1000;
  EXPECT_EQ(codeOf(headerOf(parts)), "unsupported") << "multi-part";
  parts = {};
  parts.data = integers({1, 0, 7, 3});
  EXPECT_EQ(codeOf(headerOf(parts)), "unsupported") << "cropped";
  parts = {};
  parts.channelType = 0;
  EXPECT_EQ(codeOf(headerOf(parts)), "unsupported") << "integers";
  parts = {};
  parts.sampling = 2;
  EXPECT_EQ(codeOf(headerOf(parts)), "unsupported") << "subsampled";
}

TEST(Exr, RefusesByHeaderWhatIsTooLarge) {
  HeaderParts parts;
  parts.data = parts.display = integers({0, 0, 1'999'999'999, 1'999'999'999});
  EXPECT_EQ(codeOf(headerOf(parts)), "limit");
  parts.data = parts.display = integers({0, 0, 59'999, 59'999});
  EXPECT_EQ(codeOf(headerOf(parts)), "limit");
  parts = {};
  parts.channelCount = 300;
  EXPECT_EQ(codeOf(headerOf(parts)), "limit");

  const std::vector<uint8_t> good = encodeExr(test::noiseFilm(8, 8, 1)).value();
  ExrLimits limits;
  limits.maxPixelBytes = 8 * 8 * 18 * 4;
  EXPECT_EQ(codeOf(good, limits), "ok") << "the limit itself is allowed";
  limits.maxPixelBytes -= 1;
  EXPECT_EQ(codeOf(good, limits), "limit");
}

TEST(Exr, RefusesContradictoryHeaders) {
  HeaderParts parts;
  parts.data = parts.display = integers({5, 0, 1, 3});
  EXPECT_EQ(codeOf(headerOf(parts)), "bad-file");
  constexpr int32_t kLeast = std::numeric_limits<int32_t>::min(), kMost = std::numeric_limits<int32_t>::max();
  parts.data = parts.display = integers({kLeast, 0, kMost, 3});
  EXPECT_EQ(codeOf(headerOf(parts)), "limit");
  parts = {};
  parts.channelCount = 0;
  EXPECT_EQ(codeOf(headerOf(parts)), "bad-file");
  EXPECT_EQ(codeOf({}), "bad-file");
  const std::string text = "this is not a picture at all";
  EXPECT_EQ(codeOf({text.begin(), text.end()}), "bad-file");
}

TEST(Exr, EveryTruncationIsAnErrorAndNeverACrash) {
  const std::vector<uint8_t> good = encodeExr(test::noiseFilm(5, 3, 1)).value();
  for (size_t size = 0; size < good.size(); ++size) {
    const std::vector<uint8_t> cut(good.begin(), good.begin() + std::ptrdiff_t(size));
    EXPECT_NE(codeOf(cut), "ok") << "cut at byte " << size;
  }
}

TEST(Exr, EveryDamagedHeaderByteIsSurvived) {
  const std::vector<uint8_t> good = encodeExr(test::noiseFilm(5, 3, 1)).value();
  ExrLimits limits;
  limits.maxPixelBytes = 1 << 20;
  for (size_t i = 0; i < 600 && i < good.size(); ++i)
    for (const uint8_t damage : {0x01, 0x80, 0xff}) {
      std::vector<uint8_t> bad = good;
      bad[i] ^= damage;
      const Result<FilmImage> image = decodeExr(bad, "damaged", limits);
      if (!image) continue;
      EXPECT_LE(size_t(image->width) * image->height * 4, limits.maxPixelBytes) << "byte " << i;
    }
}

TEST(Exr, DirectoriesAndAbsentFilesAreErrorsThatNameThem) {
  const Result<FilmImage> directory = readExr(std::filesystem::temp_directory_path());
  ASSERT_FALSE(directory.ok());
  EXPECT_EQ(directory.error().code, "io");
  const Result<FilmImage> absent = readExr("absent.exr");
  ASSERT_FALSE(absent.ok());
  EXPECT_THAT(absent.error().text(), HasSubstr("absent.exr"));
}

TEST(Png, BytesAreARealPngOfTheSizeAskedFor) {
  const std::vector<uint8_t> rgba(5 * 2 * 4, 200);
  const std::vector<uint8_t> bytes = encodePng(5, 2, rgba).value();
  ASSERT_GT(bytes.size(), 33u);
  EXPECT_EQ(std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", 8), 0);
  EXPECT_EQ(bytes[19], 5);  // width, big-endian, ends at byte 19
  EXPECT_EQ(bytes[23], 2);
  EXPECT_EQ(bytes[24], 8);  // bits
  EXPECT_EQ(bytes[25], 2);  // RGB without alpha
  EXPECT_FALSE(encodePng(5, 3, rgba).ok());
}

}  // namespace
}  // namespace limn
