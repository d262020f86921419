// What becomes of vertices and indices: modes, storage, normals, degenerate triangles, limits.
#include "tests/unit/gltf_builder.hpp"

#include <limits>

namespace limn::test {
namespace {

const std::vector<float> kFive = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 0.5f, 0};

std::vector<uint32_t> indicesOf(int mode, const std::vector<float>& positions) {
  GltfBuilder b;
  std::vector<float> normals;
  for (size_t i = 0; i < positions.size(); i += 3) normals.insert(normals.end(), {0, 0, 1});
  b.show({{"POSITION", b.accessor(positions, 3)}, {"NORMAL", b.accessor(normals, 3)}})["mode"] = mode;
  return onlyPrimitive(b.mustLoad()).indices;
}

TEST(GltfGeometry, TrianglesWithoutIndicesTakeVerticesInOrderAndDropTheRest) {
  EXPECT_EQ(indicesOf(4, kFive), (std::vector<uint32_t>{0, 1, 2}));
}

TEST(GltfGeometry, StripKeepsTheWinding) {
  EXPECT_EQ(indicesOf(5, kFive), (std::vector<uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
}

TEST(GltfGeometry, FanKeepsTheWinding) {
  EXPECT_EQ(indicesOf(6, kFive), (std::vector<uint32_t>{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST(GltfGeometry, PointsAndLinesAreListedWithTheirMaterialAndLeftOut) {
  for (int mode = 0; mode < 4; ++mode) {
    GltfBuilder b;
    b.push("materials", {{"name", "Wire"}});
    nlohmann::json& primitive = b.show({{"POSITION", b.accessor(kFive, 3)}});
    primitive["mode"] = mode;
    primitive["material"] = 0;
    const LoadedScene loaded = b.mustLoad();
    const char* const names[] = {"POINTS", "LINES", "LINE_LOOP", "LINE_STRIP"};
    const LoadReport::Item* item = unsupportedItem(loaded.report, std::string("primitive mode ") + names[mode]);
    ASSERT_NE(item, nullptr) << mode;
    EXPECT_EQ(item->materials, std::vector<std::string>{"Wire"});
    EXPECT_TRUE(loaded.scene.meshes.empty());
    EXPECT_TRUE(hasNote(loaded.report, "no triangle"));
  }
}

template <class T>
void expectIndices() {
  GltfBuilder b;
  const int positions = b.accessor(kFive, 3);
  b.show({{"POSITION", positions}, {"NORMAL", b.accessor<float>(std::vector<float>(15, 1.0f), 3)}},
         b.accessor<T>({T(0), T(2), T(4)}, 1));
  EXPECT_EQ(onlyPrimitive(b.mustLoad()).indices, (std::vector<uint32_t>{0, 2, 4}));
}

TEST(GltfGeometry, IndicesOfAllWidths) {
  expectIndices<uint8_t>();
  expectIndices<uint16_t>();
  expectIndices<uint32_t>();
}

TEST(GltfGeometry, IndexBeyondTheVerticesIsRefused) {
  GltfBuilder b;
  b.show({{"POSITION", b.accessor(kFive, 3)}}, b.accessor<uint16_t>({0, 1, 5}, 1));
  EXPECT_EQ(b.refusal(), "out-of-range test.glb#/meshes/0/primitives/0/indices");
}

TEST(GltfGeometry, InterleavedAttributes) {
  GltfBuilder b;
  // position, normal, uv of three vertices side by side
  const std::vector<float> data = {0, 0, 0,    0,    0, 1, 0.25f, 0.5f, 2, 0, 0,     0,
                                   0, 1, 0.5f, 0.5f, 0, 2, 0,     0,    0, 1, 0.75f, 1};
  const int view = b.view(data, 32);
  const auto part = [&](const char* type, int offset) {
    return b.push(
        "accessors",
        {{"bufferView", view}, {"byteOffset", offset}, {"componentType", 5126}, {"count", 3}, {"type", type}});
  };
  b.show({{"POSITION", part("VEC3", 0)}, {"NORMAL", part("VEC3", 12)}, {"TEXCOORD_0", part("VEC2", 24)}});
  const LoadedScene loaded = b.mustLoad();
  const Primitive& p = onlyPrimitive(loaded);
  EXPECT_EQ(p.positions, (std::vector<glm::vec3>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}));
  EXPECT_EQ(p.normals[1], glm::vec3(0, 0, 1));
  EXPECT_EQ(p.uv0, (std::vector<glm::vec2>{{0.25f, 0.5f}, {0.5f, 0.5f}, {0.75f, 1}}));
}

TEST(GltfGeometry, SparseReplacesElementsOfADenseAndOfAnEmptyAccessor) {
  for (const bool dense : {true, false}) {
    GltfBuilder b;
    b.square();
    nlohmann::json& position = b.doc["accessors"][0];
    if (!dense) position.erase("bufferView");
    const int indices = b.view<uint8_t>({1, 2}), values = b.view<float>({5, 0, 0, 5, 5, 0});
    position["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                          {"values", {{"bufferView", values}}}};
    const LoadedScene loaded = b.mustLoad();
    const Primitive& p = onlyPrimitive(loaded);
    EXPECT_EQ(p.positions[1], glm::vec3(5, 0, 0));
    EXPECT_EQ(p.positions[2], glm::vec3(5, 5, 0));
    EXPECT_EQ(p.positions[3], dense ? glm::vec3(0, 1, 0) : glm::vec3(0));
  }
}

TEST(GltfGeometry, SparseIndicesMustIncrease) {
  GltfBuilder b;
  b.square();
  const int indices = b.view<uint8_t>({2, 1}), values = b.view<float>({5, 0, 0, 5, 5, 0});
  b.doc["accessors"][0]["sparse"] = {{"count", 2},
                                     {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                     {"values", {{"bufferView", values}}}};
  EXPECT_EQ(b.refusal(), "bad-file test.glb#/accessors/0/sparse/indices");
}

TEST(GltfGeometry, QuantizedIntegersAreDecodedAsKhrMeshQuantizationSays) {
  GltfBuilder b;
  b.doc["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int positions = b.accessor<int16_t>({-32768, 0, 0, 32767, 0, 0, 0, 32767, 0, 0, 0, 0}, 3, true);
  const int normals = b.accessor<int8_t>({0, 0, 127, 0, 0, 127, 0, 0, 127, 0, 0, 127}, 3, true);
  const int uvs = b.accessor<uint16_t>({0, 3, 1, 2, 65535, 0, 7, 7}, 2);
  // Vertices of three shorts or bytes need padding to a multiple of 4; the helper packs them, so one view each is
  // stated.
  b.doc["accessors"][size_t(positions)]["count"] = 3;
  b.doc["accessors"][size_t(normals)]["count"] = 3;
  b.doc["accessors"][size_t(uvs)]["count"] = 3;
  b.show({{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}});
  const LoadedScene loaded = b.mustLoad();
  const Primitive& p = onlyPrimitive(loaded);
  EXPECT_EQ(p.positions, (std::vector<glm::vec3>{{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(p.normals[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(p.uv0, (std::vector<glm::vec2>{{0, 3}, {1, 2}, {65535, 0}}));
}

TEST(GltfGeometry, VertexColoursOfAllTypes) {
  const auto colorsOf = [](auto make) {
    GltfBuilder b;
    nlohmann::json& primitive = b.square();
    primitive["attributes"]["COLOR_0"] = make(b);
    return onlyPrimitive(b.mustLoad()).colors;
  };
  const auto bytes = colorsOf([](GltfBuilder& b) {
    return b.accessor<uint8_t>({255, 0, 51, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 4, true);
  });
  EXPECT_EQ(bytes[0], glm::vec4(1, 0, 0.2f, 1));
  const auto shorts = colorsOf([](GltfBuilder& b) {
    return b.accessor<uint16_t>({65535, 0, 13107, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 3, true);
  });
  EXPECT_EQ(shorts[0], glm::vec4(1, 0, 0.2f, 1));
  const auto floats = colorsOf([](GltfBuilder& b) {
    return b.accessor<float>({2, 0.5f, -0.1f, 1, 1, 1, 1, 1, 1, 1, 1, 1}, 3);
  });
  EXPECT_EQ(floats[0], glm::vec4(1, 0.5f, 0, 1)) << "glTF 2.0 wants components cut off at 0 and 1";
}

TEST(GltfGeometry, MissingNormalsGiveFlatUnsharedTriangles) {
  GltfBuilder b;
  b.square(false);
  const LoadedScene loaded = b.mustLoad();
  const Primitive& p = onlyPrimitive(loaded);
  EXPECT_EQ(p.positions.size(), 6u);
  EXPECT_EQ(p.uv0.size(), 6u);
  EXPECT_EQ(p.indices, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
  for (const glm::vec3& n : p.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
  EXPECT_TRUE(hasNote(loaded.report, "got flat ones"));
}

TEST(GltfGeometry, BrokenNormalsAreReplacedAndLongOnesNormalised) {
  GltfBuilder b;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  b.show({{"POSITION", b.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3)},
          {"NORMAL", b.accessor<float>({0, 0, 0, nan, 0, 1, 0, 0, 7, 0, 1, 0}, 3)}},
         b.accessor<uint16_t>({0, 1, 2, 0, 2, 3}, 1));
  const LoadedScene loaded = b.mustLoad();
  EXPECT_EQ(onlyPrimitive(loaded).normals, (std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 1, 0}}));
  EXPECT_TRUE(hasNote(loaded.report, "2 zero or broken normals"));
  EXPECT_TRUE(hasNote(loaded.report, "1 normals were not of unit length"));
}

TEST(GltfGeometry, TrianglesWithoutAreaAreCountedAndDropped) {
  GltfBuilder b;
  std::vector<float> positions = kFive;
  positions.insert(positions.end(), {2, 0, 0});  // on the line through vertices 0 and 1
  b.show({{"POSITION", b.accessor(positions, 3)}}, b.accessor<uint16_t>({0, 1, 1, 0, 1, 5, 0, 1, 2, 3, 3, 3}, 1));
  const LoadedScene loaded = b.mustLoad();
  EXPECT_EQ(loaded.report.triangles, 1u);
  EXPECT_EQ(loaded.report.degenerateTriangles, 3u);
  EXPECT_TRUE(hasNote(loaded.report, "3 triangles without area"));
}

TEST(GltfGeometry, ThinTrianglesStay) {
  GltfBuilder b;
  b.show({{"POSITION", b.accessor<float>({0, 0, 0, 1, 0, 0, 0.5f, 1e-6f, 0}, 3)}});
  EXPECT_EQ(b.mustLoad().report.triangles, 1u);
}

TEST(GltfGeometry, PositionsMustBeFiniteAndNear) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
    GltfBuilder b;
    b.show({{"POSITION", b.accessor<float>({0, 0, 0, 1, bad, 0, 0, 1, 0}, 3)}});
    EXPECT_EQ(b.refusal(),
              std::isfinite(bad) ? "out-of-range test.glb#/accessors/0" : "bad-file test.glb#/accessors/0");
  }
}

TEST(GltfGeometry, OtherAttributesMayHoldNonsense) {
  GltfBuilder b;
  nlohmann::json& primitive = b.square();
  const float inf = std::numeric_limits<float>::infinity();
  primitive["attributes"]["TEXCOORD_0"] = b.accessor<float>({0, inf, 1, 1, 1, -inf, 0, 0}, 2);
  const LoadedScene loaded = b.mustLoad();
  EXPECT_EQ(onlyPrimitive(loaded).uv0[0], glm::vec2(0));
  EXPECT_TRUE(hasNote(loaded.report, "2 texture coordinates that were not finite"));
}

TEST(GltfGeometry, LimitsAreHeldBothWays) {
  GltfBuilder b;
  b.square();
  LoadOptions options;
  options.limits.maxTriangles = 2;
  options.limits.maxVertices = 4;
  EXPECT_EQ(b.refusal(options), "loaded");
  options.limits.maxTriangles = 1;
  EXPECT_EQ(b.refusal(options), "limit test.glb#/meshes/0/primitives/0");
  options.limits.maxTriangles = 2;
  options.limits.maxVertices = 3;
  EXPECT_EQ(b.refusal(options), "limit test.glb#/meshes/0/primitives/0");
}

TEST(GltfGeometry, TrianglesOverAllNodesAreLimited) {
  GltfBuilder b;
  b.square();
  for (int i = 0; i < 9; ++i) b.root({{"mesh", 0}});
  EXPECT_EQ(b.mustLoad().report.instancedTriangles, 20u);
  LoadOptions options;
  options.limits.maxTriangles = 19;
  EXPECT_EQ(b.refusal(options), "limit test.glb#/nodes");
}

TEST(GltfGeometry, AnEmptyAccessorOfAbsurdSizeIsRefusedBeforeItIsAllocated) {
  GltfBuilder b;
  b.show({{"POSITION",
           b.push("accessors", {{"componentType", 5126}, {"count", 4'000'000'000'000ull}, {"type", "VEC3"}})}});
  EXPECT_EQ(b.refusal(), "limit test.glb#/accessors/0/count");
}

TEST(GltfGeometry, MisalignedDataAreRefused) {
  GltfBuilder b;
  b.square();
  b.doc["accessors"][0]["byteOffset"] = 2;
  b.doc["accessors"][0]["count"] = 3;
  EXPECT_EQ(b.refusal(), "bad-file test.glb#/accessors/0");
}

}  // namespace
}  // namespace limn::test
