// Every file of the malformed corpus is answered with its code and place; and random damage never crashes.
#include <random>

#include "tests/unit/gltf_builder.hpp"
#include "tests/unit/gltf_images.hpp"

namespace limn::test {
namespace {

std::filesystem::path corpus() { return std::filesystem::path(LIMN_BUILD_DIR) / "scenes" / "malformed"; }

TEST(GltfMalformed, CorpusIsRefusedWithCodeAndPointer) {
  std::ifstream listing(corpus() / "expected.json");
  ASSERT_TRUE(listing.good()) << "the target limn_scenes makes " << corpus();
  const nlohmann::json expected = nlohmann::json::parse(listing);
  ASSERT_GE(expected.at("cases").size(), 24u);
  for (const nlohmann::json& one : expected.at("cases")) {
    const std::filesystem::path file = corpus() / one.at("file").get<std::string>();
    const std::string pointer = one.at("pointer");
    const Result<LoadedScene> loaded = loadGltf(file);
    ASSERT_FALSE(loaded.ok()) << file;
    EXPECT_EQ(loaded.error().code, one.at("code")) << file << ": " << loaded.error().text();
    EXPECT_EQ(loaded.error().place, file.filename().string() + (pointer.empty() ? "" : "#" + pointer))
        << loaded.error().text();
    EXPECT_FALSE(loaded.error().message.empty()) << file;
  }
  const Result<LoadedScene> control = loadGltf(corpus() / expected.at("control").get<std::string>());
  EXPECT_TRUE(control.ok()) << control.error().text();
}

/// A small file that uses most of what the loader reads.
GltfBuilder everything() {
  GltfBuilder b;
  nlohmann::json& primitive = b.square();
  primitive["material"] = 0;
  primitive["attributes"]["COLOR_0"] = b.accessor<uint8_t>(std::vector<uint8_t>(16, 200), 4, true);
  primitive["attributes"]["JOINTS_0"] = b.accessor<uint8_t>(std::vector<uint8_t>(16, 0), 4);
  primitive["attributes"]["WEIGHTS_0"] = b.accessor<float>(std::vector<float>(16, 0.25f), 4);
  primitive["targets"] = {{{"POSITION", b.accessor<float>(std::vector<float>(12, 0.5f), 3)}}};
  b.doc["meshes"][0]["weights"] = {0.5};
  b.doc["nodes"][0]["skin"] = 0;
  const int indices = b.view<uint8_t>({1, 2}), values = b.view<float>({5, 0, 0, 5, 5, 0});
  b.doc["accessors"][0]["sparse"] = {{"count", 2},
                                     {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                     {"values", {{"bufferView", values}}}};
  b.push("images", {{"bufferView", b.view(pngBytes(4, 4, 3))}});
  b.push("textures", {{"source", 0}});
  b.push("materials",
         {{"normalTexture", {{"index", 0}}}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  b.push("skins", {{"joints", {1}}});
  b.push("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}});
  b.doc["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", {{"outerConeAngle", 0.2}}}}};
  b.root({{"camera", 0}, {"translation", {0, 0, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const int places = b.accessor<float>({1, 0, 0, 2, 0, 0}, 3);
  b.root({{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
  return b;
}

/// Tight limits keep the damage small in time and memory, as they would for a stranger's file.
LoadOptions tightLimits() {
  LoadOptions options;
  options.limits.maxFileBytes = 1 << 20;
  options.limits.maxTriangles = options.limits.maxVertices = 10'000;
  options.limits.maxNodes = 1000;
  options.limits.maxImageSide = 256;
  options.limits.maxImageBytes = 1 << 20;
  return options;
}

/// Whatever loads must be a scene that others can trust.
void expectSound(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    for (const Primitive& p : mesh.primitives) {
      ASSERT_EQ(p.normals.size(), p.positions.size());
      ASSERT_TRUE(p.material == kNone || size_t(p.material) < scene.materials.size());
      ASSERT_EQ(p.indices.size() % 3, 0u);
      for (const uint32_t index : p.indices) ASSERT_LT(index, p.positions.size());
      for (const glm::vec3& n : p.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-3f);
      for (const glm::vec3& v : p.positions) ASSERT_TRUE(std::isfinite(glm::length(v)));
      for (const size_t size : {p.tangents.size(), p.uv0.size(), p.uv1.size(), p.colors.size()}) {
        ASSERT_TRUE(size == 0 || size == p.positions.size());
      }
    }
  }
  for (const Image& image : scene.images) ASSERT_EQ(image.rgba8.size(), size_t(image.width) * image.height * 4);
  for (const Node& node : scene.nodes) ASSERT_TRUE(node.mesh == kNone || size_t(node.mesh) < scene.meshes.size());
  ASSERT_GT(glm::length(scene.view.target - scene.view.eye), 0.0);
  (void)scene.hash();
}

struct Outcome {
  int loaded = 0, refused = 0;
};

/// `damage` changes a copy of `whole` before each of `rounds` loads.
template <class Damage>
Outcome loadDamaged(const std::string& whole, int rounds, Damage damage) {
  std::mt19937 random(20240229);
  const TempFolder folder;
  Outcome outcome;
  for (int i = 0; i < rounds; ++i) {
    std::string bytes = whole;
    damage(bytes, random);
    const std::filesystem::path file = folder.write("damaged-" + std::to_string(i) + ".glb", bytes);
    const Result<LoadedScene> loaded = loadGltf(file, tightLimits());
    std::filesystem::remove(file);  // a new name each time: file systems flush a file that is written over
    if (loaded) {
      ++outcome.loaded;
      expectSound(loaded->scene);
    } else {
      ++outcome.refused;
      EXPECT_FALSE(loaded.error().code.empty() || loaded.error().message.empty() || loaded.error().place.empty());
    }
  }
  return outcome;
}

TEST(GltfFuzz, TheUndamagedFileLoads) {
  const LoadedScene loaded = everything().mustLoad(tightLimits());
  expectSound(loaded.scene);
  EXPECT_GT(loaded.report.triangles, 0u);
}

TEST(GltfFuzz, RandomBytesSeed20240229) {
  const Outcome outcome = loadDamaged(everything().glb(), 2000, [](std::string& bytes, std::mt19937& random) {
    const int count = 1 + int(random() % 4);
    for (int k = 0; k < count; ++k) bytes[random() % bytes.size()] = char(random());
  });
  EXPECT_GT(outcome.loaded, 0);
  EXPECT_GT(outcome.refused, 0);
}

TEST(GltfFuzz, RandomDigitsOfTheJsonSeed20240229) {
  const std::string whole = everything().glb();
  uint32_t jsonLength = 0;
  std::memcpy(&jsonLength, whole.data() + 12, 4);
  const Outcome outcome = loadDamaged(whole, 2000, [&](std::string& bytes, std::mt19937& random) {
    for (int k = 0; k < 3;) {
      char& c = bytes[20 + random() % jsonLength];
      if (c < '0' || c > '9') continue;
      c = "0123456789-.e"[random() % 13];
      ++k;
    }
  });
  EXPECT_GT(outcome.loaded, 0);
  EXPECT_GT(outcome.refused, 0);
}

TEST(GltfFuzz, EveryTruncationIsRefused) {
  const std::string whole = everything().glb();
  const TempFolder folder;
  for (size_t length = 0; length < whole.size(); length += 7) {
    const std::string name = "cut-" + std::to_string(length) + ".glb";
    EXPECT_FALSE(loadGltf(folder.write(name, whole.substr(0, length)), tightLimits()).ok()) << length;
  }
}

}  // namespace
}  // namespace limn::test
