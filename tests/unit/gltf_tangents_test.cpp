// Generated and given tangents: glTF's bitangent is cross(normal, tangent) * w and points to smaller v.
#include "renderer/scene/mesh_repair.hpp"
#include "tests/unit/gltf_builder.hpp"
#include "tests/unit/gltf_images.hpp"

namespace limn::test {
namespace {

/// The builder's square; u to the right, v down when seen from +z.
Primitive squareOf(std::vector<glm::vec2> uv) {
  Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  p.normals.assign(4, {0, 0, 1});
  p.uv0 = uv;
  p.indices = {0, 1, 2, 0, 2, 3};
  generateTangents(p, std::move(uv));
  return p;
}

TEST(GltfTangents, UprightTextureHasTangentAlongUAndBitangentUp) {
  const Primitive p = squareOf({{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  ASSERT_EQ(p.tangents.size(), 4u);
  for (const glm::vec4& t : p.tangents) EXPECT_EQ(t, glm::vec4(1, 0, 0, 1));
}

TEST(GltfTangents, MirroredTextureHasNegativeHandedness) {
  const Primitive p = squareOf({{1, 1}, {0, 1}, {0, 0}, {1, 0}});
  for (const glm::vec4& t : p.tangents) EXPECT_EQ(t, glm::vec4(-1, 0, 0, -1));
}

TEST(GltfTangents, VerticesBetweenMirroredHalvesAreSplit) {
  // Two squares side by side that share the edge x = 1, the right one mirrored.
  Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
  p.normals.assign(6, {0, 0, 1});
  p.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0, 1}, {0, 0}};
  p.indices = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
  generateTangents(p, p.uv0);
  ASSERT_EQ(p.positions.size(), 8u);
  ASSERT_EQ(p.uv0.size(), 8u);
  for (size_t i = 0; i < p.indices.size(); ++i) {
    const glm::vec4 expected = i < 6 ? glm::vec4(1, 0, 0, 1) : glm::vec4(-1, 0, 0, -1);
    EXPECT_EQ(p.tangents[p.indices[i]], expected) << i;
  }
}

TEST(GltfTangents, EqualVerticesShareTheirTangent) {
  // A ridge of two unindexed triangles pairs with smooth normals: the copies on the edge must agree.
  Primitive p;
  const glm::vec3 n = glm::normalize(glm::vec3(0, 0, 1));
  p.positions = {{0, 0, 0}, {1, 0, 1}, {0, 1, 0}, {1, 0, 1}, {2, 0, 0}, {1, 1, 1}};
  p.normals.assign(6, n);
  std::vector<glm::vec2> uv = {{0, 1}, {1, 1}, {0, 0}, {1, 1}, {2, 1}, {1, 0}};
  p.indices = {0, 1, 2, 3, 4, 5};
  generateTangents(p, uv);
  EXPECT_EQ(p.tangents[1], p.tangents[3]);
  EXPECT_NEAR(glm::length(glm::vec3(p.tangents[1])), 1.0f, 1e-6f);
  EXPECT_NEAR(glm::dot(glm::vec3(p.tangents[1]), n), 0.0f, 1e-6f);
}

TEST(GltfTangents, ConstantTextureCoordinatesStillGiveAFrame) {
  const Primitive p = squareOf(std::vector<glm::vec2>(4, {0.5f, 0.5f}));
  for (const glm::vec4& t : p.tangents) {
    EXPECT_NEAR(glm::length(glm::vec3(t)), 1.0f, 1e-6f);
    EXPECT_NEAR(t.z, 0.0f, 1e-6f);
  }
}

GltfBuilder withNormalMap() {
  GltfBuilder b;
  b.square()["material"] = 0;
  const int image = b.push("images", {{"bufferView", b.view(pngBytes(2, 2, 3))}, {"mimeType", "image/png"}});
  b.push("textures", {{"source", image}});
  b.push("materials", {{"normalTexture", {{"index", 0}}}});
  return b;
}

TEST(GltfTangents, AreMadeOnlyForMaterialsWithANormalMap) {
  GltfBuilder plain;
  plain.square();
  EXPECT_TRUE(onlyPrimitive(plain.mustLoad()).tangents.empty());
  const LoadedScene mapped = withNormalMap().mustLoad();
  EXPECT_EQ(onlyPrimitive(mapped).tangents, std::vector<glm::vec4>(4, {1, 0, 0, 1}));
  EXPECT_TRUE(hasNote(mapped.report, "got generated ones"));
}

TEST(GltfTangents, GivenOnesStayAndBrokenOnesAreReplaced) {
  GltfBuilder b = withNormalMap();
  b.doc["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
      b.accessor<float>({0, 1, 0, -1, 0, 2, 0, 1, 0, 0, 0, 1, 0, 1, 0, 1}, 4);
  const LoadedScene loaded = b.mustLoad();
  const Primitive& p = onlyPrimitive(loaded);
  EXPECT_EQ(p.tangents[0], glm::vec4(0, 1, 0, -1));
  EXPECT_EQ(p.tangents[1], glm::vec4(0, 1, 0, 1));
  EXPECT_NEAR(glm::length(glm::vec3(p.tangents[2])), 1.0f, 1e-6f);
  EXPECT_TRUE(hasNote(loaded.report, "1 zero or broken tangents"));
}

TEST(GltfTangents, WithoutNormalsGivenTangentsAreIgnored) {
  GltfBuilder b = withNormalMap();
  nlohmann::json& attributes = b.doc["meshes"][0]["primitives"][0]["attributes"];
  attributes["TANGENT"] = b.accessor<float>({0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}, 4);
  attributes.erase("NORMAL");
  const LoadedScene loaded = b.mustLoad();
  for (const glm::vec4& t : onlyPrimitive(loaded).tangents) EXPECT_EQ(t, glm::vec4(1, 0, 0, 1));
}

}  // namespace
}  // namespace limn::test
