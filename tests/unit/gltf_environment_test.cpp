// Environment images: Radiance HDR and OpenEXR, by their bytes and not by their names.
#include <limits>

#include "renderer/scene/environment_image.hpp"
#include "tests/unit/gltf_builder.hpp"
#include "tests/unit/gltf_images.hpp"

namespace limn::test {
namespace {

struct Loaded {
  Result<Image> image;
  std::vector<std::string> notes;
};

Loaded loadBytes(const std::vector<uint8_t>& bytes, const LoadLimits& limits = {},
                 const std::string& name = "sky.img") {
  const TempFolder folder;
  std::vector<std::string> notes;
  Result<Image> image = loadEnvironmentImage(folder.write(name, asString(bytes)), {{}, limits}, notes);
  return {std::move(image), std::move(notes)};
}

std::vector<uint8_t> exr(const std::vector<std::string>& channels, const std::vector<float>& texels, int width,
                         int height) {
  OIIO::ImageSpec spec(width, height, int(channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = channels;
  return imageBytes("openexr", spec, OIIO::TypeDesc::FLOAT, texels.data());
}

TEST(GltfEnvironment, OpenExr) {
  const Loaded sky = loadBytes(exr({"R", "G", "B"}, {1, 2, 3, 4, 5, 60000}, 2, 1));
  ASSERT_TRUE(sky.image.ok()) << sky.image.error().text();
  EXPECT_EQ(sky.image->name, "sky.img");
  EXPECT_EQ(sky.image->width, 2u);
  EXPECT_EQ(sky.image->rgbaF, (std::vector<float>{1, 2, 3, 1, 4, 5, 60000, 1}));
  EXPECT_TRUE(sky.image->rgba8.empty());
}

TEST(GltfEnvironment, ExrChannelsAreFoundByName) {
  const Loaded sky = loadBytes(exr({"depth.Z", "R", "G", "B"}, {9, 1, 2, 3}, 1, 1));
  ASSERT_TRUE(sky.image.ok()) << sky.image.error().text();
  EXPECT_EQ(sky.image->rgbaF, (std::vector<float>{1, 2, 3, 1}));
  const Loaded grey = loadBytes(exr({"Y"}, {7}, 1, 1));
  EXPECT_EQ(grey.image->rgbaF, (std::vector<float>{7, 7, 7, 1}));
}

TEST(GltfEnvironment, RadianceHdr) {
  const std::vector<float> texels(16 * 8 * 3, 2.5f);
  const Loaded sky = loadBytes(
      imageBytes("hdr", OIIO::ImageSpec(16, 8, 3, OIIO::TypeDesc::FLOAT), OIIO::TypeDesc::FLOAT, texels.data()));
  ASSERT_TRUE(sky.image.ok()) << sky.image.error().text();
  EXPECT_EQ(sky.image->width, 16u);
  EXPECT_NEAR(sky.image->rgbaF[0], 2.5f, 0.02f);
  EXPECT_EQ(sky.image->rgbaF[3], 1.0f);
}

TEST(GltfEnvironment, BrokenValuesBecomeZeroAndAreCounted) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Loaded sky = loadBytes(exr({"R", "G", "B"}, {nan, 2, -1, inf, 5, 6}, 2, 1));
  ASSERT_TRUE(sky.image.ok());
  EXPECT_EQ(sky.image->rgbaF, (std::vector<float>{0, 2, 0, 1, 0, 5, 6, 1}));
  ASSERT_EQ(sky.notes.size(), 1u);
  EXPECT_TRUE(sky.notes[0].starts_with("3 values"));
}

TEST(GltfEnvironment, LimitsHoldBothWays) {
  const std::vector<uint8_t> bytes = exr({"R", "G", "B"}, std::vector<float>(4 * 2 * 3, 1.0f), 4, 2);
  LoadLimits limits;
  limits.maxImageSide = 4;
  limits.maxImageBytes = 4 * 2 * 16;
  EXPECT_TRUE(loadBytes(bytes, limits).image.ok());
  limits.maxImageSide = 3;
  EXPECT_EQ(loadBytes(bytes, limits).image.error().code, "limit");
  limits.maxImageSide = 4;
  limits.maxImageBytes = 4 * 2 * 16 - 1;
  EXPECT_EQ(loadBytes(bytes, limits).image.error().code, "limit");
}

TEST(GltfEnvironment, OtherFilesAreRefusedWithTheirName) {
  const Loaded png = loadBytes(pngBytes(2, 2, 3), {}, "sky.hdr");  // the name does not decide
  EXPECT_EQ(png.image.error().code, "unsupported");
  EXPECT_EQ(png.image.error().place, "sky.hdr");
  std::vector<uint8_t> cut = exr({"R", "G", "B"}, std::vector<float>(64 * 64 * 3, 1.0f), 64, 64);
  cut.resize(cut.size() / 2);
  EXPECT_EQ(loadBytes(cut).image.error().code, "bad-file");
  std::vector<std::string> notes;
  EXPECT_EQ(loadEnvironmentImage("/nowhere/sky.exr", {}, notes).error().code, "io");
}

TEST(GltfEnvironment, DeepAndMultiPartFilesAreRefused) {
  std::vector<uint8_t> deep = exr({"R", "G", "B"}, {1, 2, 3}, 1, 1);
  deep[5] |= 0x08;  // version field: non-image parts
  EXPECT_EQ(loadBytes(deep).image.error().code, "unsupported");
  std::vector<uint8_t> parts = exr({"R", "G", "B"}, {1, 2, 3}, 1, 1);
  parts[5] |= 0x10;  // version field: multi-part
  EXPECT_EQ(loadBytes(parts).image.error().code, "unsupported");
}

/// A square whose extras name an environment, in a folder with a sky of 2x1 texels at skies/sky.exr.
Result<LoadedScene> loadNaming(const nlohmann::json& extras, const LoadOptions& options = {}) {
  const TempFolder folder;
  folder.write("room/skies/sky.exr", asString(exr({"R", "G", "B"}, {1, 2, 3, 4, 5, 6}, 2, 1)));
  folder.write("room/notes.txt", "no image");
  folder.write("outside.exr", asString(exr({"R", "G", "B"}, {1, 2, 3}, 1, 1)));
  GltfBuilder b;
  b.square();
  b.doc["extras"] = extras;
  return loadGltf(folder.write("room/room.glb", b.glb()), options);
}

nlohmann::json naming(const nlohmann::json& uri) { return {{"limn", {{"environment", uri}}}}; }

TEST(GltfEnvironment, ExtrasOfTheRootNameIt) {
  const Result<LoadedScene> loaded = loadNaming(naming("skies/sky%2Eexr"));
  ASSERT_TRUE(loaded.ok()) << loaded.error().text();
  const Environment& environment = loaded->scene.environment;
  ASSERT_NE(environment.image, nullptr);
  EXPECT_EQ(environment.image->name, "skies/sky.exr");
  EXPECT_EQ(environment.image->rgbaF, (std::vector<float>{1, 2, 3, 1, 4, 5, 6, 1}));
  EXPECT_EQ(environment.radiance, glm::vec3(1.0f));
  EXPECT_EQ(loaded->report.notes[0], "environment image: \"skies/sky.exr\", 2x1");
  EXPECT_EQ(loaded->report.imageBytes, 2u * 16u);
  for (const std::string& note : loaded->report.notes) EXPECT_EQ(note.find("no light"), std::string::npos) << note;
}

TEST(GltfEnvironment, WhatAFileNamesIsConfinedAndChecked) {
  const std::pair<nlohmann::json, const char*> cases[] = {
      {"../outside.exr", "path"}, {"/etc/passwd", "path"},         {"http://host/sky.exr", "path"},
      {"skies", "path"},          {"skies/none.exr", "io"},        {"notes.txt", "unsupported"},
      {7, "bad-file"},            {"data:;base64,AAAA", "unsupported"}};
  for (const auto& [uri, code] : cases) {
    const Result<LoadedScene> loaded = loadNaming(naming(uri));
    ASSERT_FALSE(loaded.ok()) << uri;
    EXPECT_EQ(loaded.error().code, code) << uri;
    EXPECT_EQ(loaded.error().place, "room.glb#/extras/limn/environment") << uri;
  }
  LoadOptions options;
  options.limits.maxImageBytes = 2 * 16;
  EXPECT_TRUE(loadNaming(naming("skies/sky.exr"), options).ok());
  options.limits.maxImageBytes = 2 * 16 - 1;
  EXPECT_EQ(loadNaming(naming("skies/sky.exr"), options).error().code, "limit");
}

TEST(GltfEnvironment, OtherExtrasAreSomebodyElses) {
  for (const nlohmann::json& extras : {nlohmann::json(3), nlohmann::json("limn"), nlohmann::json{{"limn", 1}},
                                       nlohmann::json{{"limn", {{"else", "x"}}}}, nlohmann::json{{"environment", 1}}}) {
    const Result<LoadedScene> loaded = loadNaming(extras);
    ASSERT_TRUE(loaded.ok()) << extras;
    EXPECT_EQ(loaded->scene.environment.image, nullptr) << extras;
  }
}

TEST(GltfEnvironment, FilesAreConfinedToTheAssetRoot) {
  const TempFolder folder;
  const std::string sky = asString(exr({"R", "G", "B"}, {1, 2, 3}, 1, 1));
  const std::filesystem::path inside = folder.write("root/skies/sky.exr", sky), outside = folder.write("sky.exr", sky);
  std::vector<std::string> notes;
  const LoadOptions options{folder.path() / "root", {}};
  const Result<Image> image = loadEnvironmentImage(inside, options, notes);
  ASSERT_TRUE(image.ok()) << image.error().text();
  EXPECT_EQ(image->name, "skies/sky.exr");
  EXPECT_EQ(loadEnvironmentImage(outside, options, notes).error().code, "path");
}

}  // namespace
}  // namespace limn::test
