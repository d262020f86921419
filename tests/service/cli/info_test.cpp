#include "server/limn/info_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limn {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

LoadedScene exampleScene() {
  LoadedScene loaded;
  Scene& scene = loaded.scene;
  scene.name = "example.glb";
  Material material;
  material.name = "lamp";
  material.emission = {17.0f, 12.0f, 4.0f};
  material.baseColorTexture.image = 0;
  scene.materials = {material, Material{}};
  scene.images = {{"checker", 4, 2, std::vector<uint8_t>(4 * 2 * 4, 255), {}}};
  Light light;
  light.name = "sun";
  light.type = LightType::directional;
  light.intensity = 3.0f;
  scene.lights = {light};
  Primitive primitive;
  primitive.material = 0;
  primitive.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
  primitive.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  primitive.indices = {0, 1, 2};
  scene.meshes = {{"triangle", {primitive}}};
  Node node;
  node.mesh = 0;
  scene.nodes = {node, node};
  scene.roots = {0, 1};
  loaded.report.triangles = 1;
  loaded.report.vertices = 3;
  loaded.report.unsupported = {{"KHR_materials_iridescence", {"lamp"}, "it is shown without it"}};
  loaded.report.notes = {"no camera: one was added that frames the scene"};
  return loaded;
}

TEST(Info, TellsContentsCostAndWhatIsNotSupported) {
  const std::string text = infoText(exampleScene());
  EXPECT_THAT(text, HasSubstr("example.glb, hash "));
  EXPECT_THAT(text, HasSubstr("triangles: 1 (0 without area), vertices: 3, meshes: 1, nodes: 2\n"));
  EXPECT_THAT(text, HasSubstr("bounds: (0, 0, 0) to (2, 3, 0) m\n"));
  EXPECT_THAT(text, HasSubstr("  0 lamp: base colour (1, 1, 1, 1), metallic 1, roughness 1, emission (17, 12, 4)"));
  EXPECT_THAT(text, HasSubstr("textures: base colour\n"));
  EXPECT_THAT(text, HasSubstr("  1 (no name): "));
  EXPECT_THAT(text, HasSubstr("  0 checker: 4x2, 8-bit\n"));
  EXPECT_THAT(text, HasSubstr("  0 sun: directional, 3 W/m2"));
  EXPECT_THAT(text, HasSubstr("cameras: 0\n"));
  EXPECT_THAT(text, HasSubstr("  KHR_materials_iridescence (lamp): it is shown without it\n"));
  EXPECT_THAT(text, HasSubstr("note: no camera: one was added"));
  EXPECT_THAT(text, HasSubstr("cost: 2 triangles over all nodes; memory for path-tracing at 512x512 pixels:\n"));
}

TEST(Info, MemoryIsToldByOwnerForTheTechniqueAndSizeAskedFor) {
  SessionConfig config;
  config.width = 1024;
  config.height = 512;
  config.technique = "point-projection";
  const std::string text = infoText(exampleScene(), config);
  EXPECT_THAT(text, HasSubstr("memory for point-projection at 1024x512 pixels:\n"));
  // Five planes of four floats, of the picture's pixels and of the audit's, four bytes of display, and a hundredth for the error.
  EXPECT_THAT(text, HasSubstr("  film                     43.30 MiB\n"));
  for (const char* owner : {"audit ", "scene ", "textures ", "lights ", "environment ", "visibility ", "point-light ", "surface-points ",
                            "device in all ", "mirror ", "bvh ", "host in all "})
    EXPECT_THAT(text, HasSubstr("  " + std::string(owner))) << owner;
  EXPECT_THAT(text, Not(HasSubstr("path-tracing")));
}

TEST(Info, AnEmptySceneIsToldToo) {
  const std::string text = infoText({});
  EXPECT_THAT(text, HasSubstr("triangles: 0"));
  EXPECT_THAT(text, HasSubstr("not supported: nothing of this file\n"));
  EXPECT_THAT(text, HasSubstr("environment: none\n"));
}

}  // namespace
}  // namespace limn
