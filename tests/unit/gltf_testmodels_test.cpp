// All glTF 2 models of Debian's assimp-testmodels: each loads, or is refused with a reason, as listed here.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/scene/gltf_loader.hpp"

namespace limn {
namespace {

namespace fs = std::filesystem;

/// Place of the package's models that are glTF 2; its folder "glTF" holds version 1.
const fs::path kModels = "/usr/share/assimp/models/glTF2";

/// Triangles that are shown, or the code and pointer of the refusal.
struct Expected {
  uint64_t triangles = 0;
  const char* code = nullptr;
  const char* pointer = "";
};

const std::map<std::string, Expected> kExpected = {
    {"2CylinderEngine-glTF-Binary/2CylinderEngine.glb", {65311}},
    {"BoxBadNormals-glTF-Binary/BoxBadNormals.glb", {12}},
    {"BoxTexcoords-glTF/boxTexcoords.gltf", {12}},
    {"BoxTextured-glTF-Binary/BoxTextured.glb", {12}},
    {"BoxTextured-glTF-Embedded/BoxTextured.gltf", {12}},
    {"BoxTextured-glTF-pbrSpecularGlossiness/BoxTextured.gltf", {12}},
    {"BoxTextured-glTF-techniqueWebGL/BoxTextured.gltf", {0, "unsupported", "/extensionsRequired/0"}},
    {"BoxTextured-glTF/BoxTextured.gltf", {12}},
    {"BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", {0, "bad-file", "/accessors/2"}},
    {"ClearCoat-glTF/ClearCoatTest.gltf", {37116}},
    {"IncorrectVertexArrays/Cube.gltf", {0, "out-of-range", "/bufferViews/2/byteLength"}},
    {"IndexOutOfRange/AllIndicesOutOfRange.gltf", {0, "out-of-range", "/meshes/0/primitives/0/indices"}},
    {"IndexOutOfRange/IndexOutOfRange.gltf", {0, "out-of-range", "/meshes/0/primitives/0/indices"}},
    {"MissingBin/BoxTextured.gltf", {0, "io", "/buffers/0/uri"}},
    {"RecursiveNodes/RecursiveNodes.gltf", {0, "bad-file", "/nodes/0/children"}},
    {"SchemaFailures/sceneWrongType.gltf", {0, "bad-file", "/scene"}},
    {"TestNoRootNode/NoScene.gltf", {0, "out-of-range", "/scene"}},
    {"TestNoRootNode/SceneWithoutNodes.gltf", {0}},
    {"cameras/Cameras.gltf", {2}},
    {"draco/2CylinderEngine.gltf", {0, "unsupported", "/extensionsRequired/0"}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_00.gltf", {0}},  // points
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_01.gltf", {0}},  // lines
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_02.gltf", {0}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_03.gltf", {0}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_04.gltf", {2}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_05.gltf", {2}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_06.gltf", {2}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_07.gltf", {0}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_08.gltf", {0}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_09.gltf", {0}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_10.gltf", {0}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_11.gltf", {2}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_12.gltf", {2}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_13.gltf", {2}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_14.gltf", {2}},
    {"glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_15.gltf", {2}},
    {"glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf", {12}},
    {"issue_3269/texcoord_crash.gltf", {10}},
    {"simple_skin/simple_skin.gltf", {8}},
    {"textureTransform/TextureTransformTest.gltf", {18}},
    {"wrongTypes/badArray.gltf", {0, "bad-file", "/meshes/0/primitives"}},
    {"wrongTypes/badExtension.gltf",
     {0, "bad-file", "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform"}},
    {"wrongTypes/badNumber.gltf", {0, "bad-file", "/materials/0/normalTexture"}},
    {"wrongTypes/badObject.gltf", {0, "bad-file", "/materials/0/pbrMetallicRoughness"}},
    {"wrongTypes/badString.gltf", {0, "bad-file", "/scenes/0/name"}},
    {"wrongTypes/badUint.gltf", {0, "out-of-range", "/materials/0/pbrMetallicRoughness/baseColorTexture/index"}},
};

void printLine(const std::string& name, const Result<LoadedScene>& loaded) {
  if (!loaded) {
    std::printf("%-70s refused  %s  %s\n", name.c_str(), loaded.error().code.c_str(), loaded.error().text().c_str());
    return;
  }
  std::string unsupported;
  for (const LoadReport::Item& item : loaded->report.unsupported) unsupported += "  -" + item.feature;
  std::printf("%-70s loaded   %lu triangles%s\n", name.c_str(), static_cast<unsigned long>(loaded->report.triangles),
              unsupported.c_str());
}

void expectAsListed(const std::string& name, const Expected& expected, const Result<LoadedScene>& loaded) {
  if (!expected.code) {
    ASSERT_TRUE(loaded.ok()) << name << ": " << loaded.error().text();
    EXPECT_EQ(loaded->report.triangles, expected.triangles) << name;
    EXPECT_TRUE(expected.triangles > 0 || !loaded->report.notes.empty()) << name;
    return;
  }
  ASSERT_FALSE(loaded.ok()) << name;
  EXPECT_EQ(loaded.error().code, expected.code) << name;
  EXPECT_FALSE(loaded.error().message.empty()) << name;
  EXPECT_EQ(loaded.error().place, fs::path(name).filename().string() + "#" + expected.pointer) << name;
}

std::vector<std::string> modelNames() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kModels)) {
    const std::string extension = entry.path().extension().string();
    const bool model = entry.is_regular_file() && (extension == ".gltf" || extension == ".glb");
    if (model) names.push_back(entry.path().lexically_relative(kModels).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST(GltfTestmodels, EveryModelLoadsOrIsRefusedWithAReason) {
  ASSERT_TRUE(fs::is_directory(kModels)) << "the package assimp-testmodels is part of the test set-up";
  const std::vector<std::string> names = modelNames();
  for (const std::string& name : names) {
    const Result<LoadedScene> loaded = loadGltf(kModels / name);
    printLine(name, loaded);
    const auto expected = kExpected.find(name);
    ASSERT_NE(expected, kExpected.end()) << name << " is not listed";
    expectAsListed(name, expected->second, loaded);
  }
  EXPECT_EQ(names.size(), kExpected.size()) << "a listed model is missing";
}

}  // namespace
}  // namespace limn
