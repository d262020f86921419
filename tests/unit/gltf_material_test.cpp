// Materials, their extensions, textures, samplers, images, and what the report says about the rest.
#include "renderer/scene/image_file.hpp"
#include "tests/unit/gltf_builder.hpp"
#include "tests/unit/gltf_images.hpp"

namespace limn::test {
namespace {

/// A square with one material, and one 4x2 image behind texture 0.
GltfBuilder withMaterial(const nlohmann::json& material) {
  GltfBuilder b;
  b.square()["material"] = 0;
  b.push("images", {{"bufferView", b.view(pngBytes(4, 2, 4))}, {"name", "Picture"}});
  b.push("textures", {{"source", 0}});
  b.push("materials", material);
  return b;
}

Material load(const nlohmann::json& material) {
  LoadedScene loaded = withMaterial(material).mustLoad();
  return loaded.scene.materials.empty() ? Material{} : loaded.scene.materials[0];
}

TEST(GltfMaterial, DefaultsAreThoseOfTheSpecification) {
  const Material m = load(nlohmann::json::object());
  EXPECT_EQ(m.baseColor, glm::vec4(1));
  EXPECT_EQ(m.metallic, 1.0f);
  EXPECT_EQ(m.roughness, 1.0f);
  EXPECT_EQ(m.emission, glm::vec3(0));
  EXPECT_EQ(m.alphaMode, AlphaMode::opaque);
  EXPECT_EQ(m.alphaCutoff, 0.5f);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.specular, 1.0f);
  EXPECT_EQ(m.specularColor, glm::vec3(1));
  EXPECT_FALSE(m.doubleSided || m.unlit || m.baseColorTexture.present());
}

TEST(GltfMaterial, CoreFactors) {
  const Material m =
      load({{"name", "Paint"},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.6}}},
            {"emissiveFactor", {0.25, 0.5, 0.75}},
            {"alphaMode", "MASK"},
            {"alphaCutoff", 0.3},
            {"doubleSided", true},
            {"normalTexture", {{"index", 0}, {"scale", 0.7}}}});
  EXPECT_EQ(m.name, "Paint");
  EXPECT_EQ(m.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.6f);
  EXPECT_EQ(m.emission, glm::vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(m.alphaMode, AlphaMode::mask);
  EXPECT_EQ(m.alphaCutoff, 0.3f);
  EXPECT_TRUE(m.doubleSided);
  EXPECT_EQ(m.normalScale, 0.7f);
  EXPECT_TRUE(m.normalTexture.present());
}

TEST(GltfMaterial, Extensions) {
  const nlohmann::json texture = {{"index", 0}};
  const Material m =
      load({{"emissiveFactor", {1, 0.5, 0}},
            {"extensions",
             {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5'000'000'000}}},
              {"KHR_materials_ior", {{"ior", 1.33}}},
              {"KHR_materials_transmission", {{"transmissionFactor", 0.9}, {"transmissionTexture", texture}}},
              {"KHR_materials_volume",
               {{"thicknessFactor", 0.2}, {"attenuationDistance", 3}, {"attenuationColor", {0.1, 0.2, 0.3}}}},
              {"KHR_materials_specular",
               {{"specularFactor", 0.4},
                {"specularColorFactor", {2, 1, 0}},
                {"specularTexture", texture},
                {"specularColorTexture", texture}}},
              {"KHR_materials_clearcoat",
               {{"clearcoatFactor", 0.8},
                {"clearcoatRoughnessFactor", 0.1},
                {"clearcoatTexture", texture},
                {"clearcoatRoughnessTexture", texture},
                {"clearcoatNormalTexture", {{"index", 0}, {"scale", 0.5}}}}},
              {"KHR_materials_unlit", nlohmann::json::object()}}}});
  EXPECT_EQ(m.emission, glm::vec3(5e9f, 2.5e9f, 0));  // does not fit a 32-bit integer
  EXPECT_EQ(m.ior, 1.33f);
  EXPECT_EQ(m.transmission, 0.9f);
  EXPECT_EQ(m.thickness, 0.2f);
  EXPECT_EQ(m.attenuationDistance, 3.0f);
  EXPECT_EQ(m.attenuationColor, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(m.specular, 0.4f);
  EXPECT_EQ(m.specularColor, glm::vec3(2, 1, 0));
  EXPECT_EQ(m.clearcoat, 0.8f);
  EXPECT_EQ(m.clearcoatRoughness, 0.1f);
  EXPECT_EQ(m.clearcoatNormalScale, 0.5f);
  EXPECT_TRUE(m.unlit);
  for (const TextureRef* t : {&m.transmissionTexture, &m.specularTexture, &m.specularColorTexture, &m.clearcoatTexture,
                              &m.clearcoatRoughnessTexture, &m.clearcoatNormalTexture}) {
    EXPECT_EQ(t->image, 0);
  }
}

TEST(GltfMaterial, FactorsOutOfRangeAreClampedAndNoted) {
  const LoadedScene loaded =
      withMaterial({{"pbrMetallicRoughness", {{"metallicFactor", 1.5}, {"roughnessFactor", -0.1}}}}).mustLoad();
  EXPECT_EQ(loaded.scene.materials[0].metallic, 1.0f);
  EXPECT_EQ(loaded.scene.materials[0].roughness, 0.0f);
  EXPECT_TRUE(hasNote(loaded.report, "2 material factors out of their range"));
}

TEST(GltfMaterial, TextureTransformAndSampler) {
  GltfBuilder b =
      withMaterial({{"pbrMetallicRoughness",
                     {{"baseColorTexture",
                       {{"index", 0},
                        {"extensions",
                         {{"KHR_texture_transform",
                           {{"offset", {0.1, 0.2}}, {"scale", {2, 3}}, {"rotation", 0.5}, {"texCoord", 1}}}}}}}}}});
  b.push("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
  b.doc["textures"][0]["sampler"] = 0;
  const TextureRef t = b.mustLoad().scene.materials[0].baseColorTexture;
  EXPECT_EQ(t.offset, glm::vec2(0.1f, 0.2f));
  EXPECT_EQ(t.scale, glm::vec2(2, 3));
  EXPECT_EQ(t.rotation, 0.5f);
  EXPECT_EQ(t.texCoord, 1u);
  EXPECT_EQ(t.wrapS, Wrap::clampToEdge);
  EXPECT_EQ(t.wrapT, Wrap::mirroredRepeat);
  EXPECT_TRUE(t.nearest);
}

TEST(GltfMaterial, HigherTextureCoordinatesAreListed) {
  const LoadedScene loaded =
      withMaterial({{"name", "Far"}, {"emissiveTexture", {{"index", 0}, {"texCoord", 2}}}}).mustLoad();
  const LoadReport::Item* item = unsupportedItem(loaded.report, "TEXCOORD_2");
  ASSERT_NE(item, nullptr);
  EXPECT_EQ(item->materials, std::vector<std::string>{"Far"});
  EXPECT_FALSE(loaded.scene.materials[0].emissiveTexture.present());
}

TEST(GltfMaterial, UnsupportedExtensionsNameEveryAffectedMaterial) {
  GltfBuilder b = withMaterial({{"extensions", {{"KHR_materials_iridescence", {{"iridescenceFactor", 1}}}}}});
  b.push(
      "materials",
      {{"name", "Cloth"},
       {"extensions",
        {{"KHR_materials_sheen", nlohmann::json::object()}, {"KHR_materials_iridescence", nlohmann::json::object()}}}});
  b.doc["extensionsUsed"] = {"KHR_materials_sheen", "KHR_materials_iridescence", "KHR_xmp", "KHR_materials_ior"};
  const LoadReport report = b.mustLoad().report;
  ASSERT_NE(unsupportedItem(report, "KHR_materials_iridescence"), nullptr);
  EXPECT_EQ(unsupportedItem(report, "KHR_materials_iridescence")->materials, (std::vector<std::string>{"#0", "Cloth"}));
  EXPECT_EQ(unsupportedItem(report, "KHR_materials_sheen")->materials, std::vector<std::string>{"Cloth"});
  ASSERT_NE(unsupportedItem(report, "KHR_xmp"), nullptr);
  EXPECT_TRUE(unsupportedItem(report, "KHR_xmp")->materials.empty());
  EXPECT_EQ(unsupportedItem(report, "KHR_materials_ior"), nullptr);
}

TEST(GltfMaterial, TexturesWithoutAPngOrJpegAreListedAndLeftOut) {
  GltfBuilder b = withMaterial({{"name", "Basis"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  b.doc["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  const LoadedScene loaded = b.mustLoad();
  EXPECT_FALSE(loaded.scene.materials[0].baseColorTexture.present());
  EXPECT_EQ(unsupportedItem(loaded.report, "KHR_texture_basisu")->materials, std::vector<std::string>{"Basis"});
  EXPECT_NE(unsupportedItem(loaded.report, "texture without a PNG or JPEG image"), nullptr);
}

TEST(GltfMaterial, ForeignImageFormatsAreRefusedByName) {
  GltfBuilder b = withMaterial({{"emissiveTexture", {{"index", 0}}}});
  b.doc["images"][0] = {{"uri", "data:image/webp;base64,UklGRiQAAABXRUJQVlA4IBgAAAAwAQCdASoBAAEAAgA0JaQAA3AA/vuUAAA="}};
  EXPECT_EQ(b.refusal(), "unsupported test.glb#/images/0");
}

TEST(GltfMaterial, OcclusionTexturesAreNeitherUsedNorRead) {
  GltfBuilder b = withMaterial({{"occlusionTexture", {{"index", 0}}}});
  b.doc["images"][0] = {{"uri", "not-there.png"}};
  const LoadedScene loaded = b.mustLoad();
  EXPECT_TRUE(loaded.scene.images.empty());
  EXPECT_TRUE(hasNote(loaded.report, "occlusion textures are not used"));
}

TEST(GltfMaterial, OneImageForManySlotsIsReadOnce) {
  const LoadedScene loaded =
      withMaterial({{"emissiveTexture", {{"index", 0}}}, {"normalTexture", {{"index", 0}}}}).mustLoad();
  ASSERT_EQ(loaded.scene.images.size(), 1u);
  EXPECT_EQ(loaded.scene.images[0].name, "Picture");
  EXPECT_EQ(loaded.report.imageBytes, 4u * 2 * 4);
}

TEST(GltfImage, PngOfOneToFourChannels) {
  for (int channels = 1; channels <= 4; ++channels) {
    const std::vector<uint8_t> bytes = pngBytes(4, 2, channels);
    const auto header = readImageHeader(bytes);
    ASSERT_TRUE(header.ok());
    EXPECT_EQ(header->width, 4u);
    EXPECT_EQ(header->height, 2u);
    const auto image = decodeImage(bytes, *header);
    ASSERT_TRUE(image.ok()) << image.error().text();
    const uint8_t* texel = &image->rgba8[(1 * 4 + 3) * 4];  // x = 3, y = 1: value 70 + channel
    const std::vector<std::array<int, 4>> expected = {
        {70, 70, 70, 255}, {70, 70, 70, 71}, {70, 71, 72, 255}, {70, 71, 72, 73}};
    for (size_t c = 0; c < 4; ++c)
      EXPECT_EQ(texel[c], expected[size_t(channels) - 1][c]) << channels << " channels, " << c;
  }
}

TEST(GltfImage, ColourUnderZeroAlphaSurvives) {
  OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const uint8_t texel[4] = {200, 100, 50, 0};
  const std::vector<uint8_t> bytes = imageBytes("png", spec, OIIO::TypeDesc::UINT8, texel);
  const auto image = decodeImage(bytes, *readImageHeader(bytes));
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(image->rgba8, (std::vector<uint8_t>{200, 100, 50, 0}));
}

TEST(GltfImage, SixteenBitsBecomeEightAndAreNoted) {
  GltfBuilder b = withMaterial({{"emissiveTexture", {{"index", 0}}}});
  b.doc["images"][0]["bufferView"] = b.view(pngBytes(4, 2, 3, true));
  const LoadedScene loaded = b.mustLoad();
  EXPECT_EQ(loaded.scene.images[0].rgba8[(1 * 4 + 3) * 4 + 2], 72);
  EXPECT_TRUE(hasNote(loaded.report, "1 16-bit images"));
}

TEST(GltfImage, CutPngsNeverReachTheDecoder) {
  const std::vector<uint8_t> whole = pngBytes(4, 2, 3);
  ASSERT_TRUE(readImageHeader(whole).ok());
  for (size_t length = 8; length < whole.size(); ++length) {
    const auto header = readImageHeader(std::span(whole).first(length));
    ASSERT_FALSE(header.ok()) << length;
    EXPECT_EQ(header.error().code, "bad-file") << length;
  }
}

TEST(GltfImage, Jpeg) {
  const std::vector<uint8_t> grey(8 * 8 * 3, 128);
  const std::vector<uint8_t> bytes =
      imageBytes("jpeg", OIIO::ImageSpec(8, 8, 3, OIIO::TypeDesc::UINT8), OIIO::TypeDesc::UINT8, grey.data());
  const auto header = readImageHeader(bytes);
  ASSERT_TRUE(header.ok());
  EXPECT_EQ(header->format, ImageHeader::Format::jpeg);
  EXPECT_EQ(header->width, 8u);
  const auto image = decodeImage(bytes, *header);
  ASSERT_TRUE(image.ok()) << image.error().text();
  EXPECT_NEAR(image->rgba8[0], 128, 2);
  EXPECT_EQ(image->rgba8[3], 255);
}

TEST(GltfImage, LimitsAreLookedAtBeforeDecoding) {
  const GltfBuilder b = withMaterial({{"emissiveTexture", {{"index", 0}}}});
  LoadOptions options;
  options.limits.maxImageSide = 4;
  options.limits.maxImageBytes = 32;
  EXPECT_EQ(b.refusal(options), "loaded");
  options.limits.maxImageSide = 3;
  EXPECT_EQ(b.refusal(options), "limit test.glb#/images/0");
  options.limits.maxImageSide = 4;
  options.limits.maxImageBytes = 31;
  EXPECT_EQ(b.refusal(options), "limit test.glb#/images/0");
}

}  // namespace
}  // namespace limn::test
