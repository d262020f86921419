// Nodes, cameras, lights, skins, morph targets, instances, and what is added so that a scene can be seen.
#include <cmath>

#include "tests/unit/gltf_builder.hpp"

namespace limn::test {
namespace {

using nlohmann::json;

glm::dvec3 at(const glm::dmat4& m, const glm::dvec3& p) { return glm::dvec3(m * glm::dvec4(p, 1.0)); }

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-9) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

TEST(GltfNodes, HierarchyOfTranslationRotationScale) {
  GltfBuilder b;
  b.square();
  b.doc["nodes"][0] = {
      {"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}};
  b.push("nodes", {{"name", "Child"}, {"mesh", 0}, {"translation", {1, 0, 0}}, {"scale", {2, 3, 4}}});
  const Scene scene = b.mustLoad().scene;
  ASSERT_EQ(scene.nodes.size(), 2u);
  EXPECT_EQ(scene.nodes[1].parent, 0);
  EXPECT_EQ(scene.nodes[0].children, std::vector<uint32_t>{1});
  EXPECT_EQ(scene.roots, std::vector<uint32_t>{0});
  expectNear(at(scene.worldFromNodes()[1], {1, 1, 1}), {7, 3, 4});  // (3,3,4) turned by 90 degrees about z, moved by 10
}

TEST(GltfNodes, MatrixBecomesTrsWhenItCan) {
  GltfBuilder b;
  b.square();
  b.doc["nodes"][0]["matrix"] = {0, 2, 0, 0, 3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1};  // mirrored: x to y, y to x
  const Scene scene = b.mustLoad().scene;
  const Transform& t = scene.nodes[0].parentFromLocal;
  EXPECT_FALSE(t.matrix.has_value());
  EXPECT_LT(t.scale.x * t.scale.y * t.scale.z, 0.0);
  expectNear(at(t.toMatrix(), {1, 1, 1}), {8, 8, 11});
}

TEST(GltfNodes, ShearedMatrixIsKept) {
  GltfBuilder b;
  b.square();
  b.doc["nodes"][0]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const Scene scene = b.mustLoad().scene;
  ASSERT_TRUE(scene.nodes[0].parentFromLocal.matrix.has_value());
  expectNear(at(scene.worldFromNodes()[0], {0, 1, 0}), {0.5, 1, 0});
}

TEST(GltfNodes, OnlyTheDefaultSceneIsShown) {
  GltfBuilder b;
  b.square();
  b.push("nodes", {{"name", "Elsewhere"}, {"mesh", 0}});
  b.push("nodes", {{"name", "Shown"}, {"mesh", 0}});
  b.doc["scenes"] = {{{"nodes", {0}}}, {{"nodes", {2}}}};
  b.doc["scene"] = 1;
  const Scene scene = b.mustLoad().scene;
  ASSERT_EQ(scene.nodes.size(), 1u);
  EXPECT_EQ(scene.nodes[0].name, "Shown");
  EXPECT_EQ(scene.meshes.size(), 1u);
}

TEST(GltfNodes, WithoutScenesAllNodesAreShown) {
  GltfBuilder b;
  b.square();
  b.doc.erase("scenes");
  const LoadedScene loaded = b.mustLoad();
  EXPECT_EQ(loaded.scene.roots.size(), 1u);
  EXPECT_TRUE(hasNote(loaded.report, "names no scene"));
}

TEST(GltfNodes, AChainOfAHundredThousandNodesIsFine) {
  GltfBuilder b;
  b.square();
  constexpr int kLength = 100'000;
  for (int i = 1; i < kLength; ++i) b.push("nodes", {{"translation", {0, 0, 1}}});
  for (int i = 0; i + 1 < kLength; ++i) b.doc["nodes"][size_t(i)]["children"] = {i + 1};
  const Scene scene = b.mustLoad().scene;
  EXPECT_EQ(scene.worldFromNodes().back()[3].z, kLength - 1);
}

TEST(GltfNodes, NodeLimit) {
  GltfBuilder b;
  b.square();
  b.root({{"name", "Two"}});
  LoadOptions options;
  options.limits.maxNodes = 2;
  EXPECT_EQ(b.refusal(options), "loaded");
  options.limits.maxNodes = 1;
  EXPECT_EQ(b.refusal(options), "limit test.glb#/nodes");
}

TEST(GltfNodes, FlattenedNodesShowNoMesh) {
  GltfBuilder b;
  b.square();
  b.doc["nodes"][0]["scale"] = {1, 0, 1};
  const LoadedScene loaded = b.mustLoad();
  EXPECT_EQ(loaded.scene.nodes[0].mesh, kNone);
  EXPECT_TRUE(hasNote(loaded.report, "scale is zero"));
}

TEST(GltfNodes, PlacesBeyondTheRangeOfNumbersAreRefused) {
  GltfBuilder b;
  b.square();
  b.doc["nodes"][0]["translation"] = {1e200, 0, 0};
  EXPECT_EQ(b.refusal(), "out-of-range test.glb#/nodes/0");
}

TEST(GltfCameras, FirstCameraGivesTheView) {
  GltfBuilder b;
  b.square();
  b.push("cameras",
         {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 9}}}});
  b.push("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}});
  b.root({{"camera", 1}, {"translation", {0.5, 0.5, 4}}});
  b.root({{"camera", 0}, {"translation", {0.5, 0.5, 2}}, {"rotation", {0, 1, 0, 0}}});
  const Scene scene = b.mustLoad().scene;
  EXPECT_FALSE(scene.view.lens.perspective);
  EXPECT_EQ(scene.view.lens.ymag, 3.0f);
  expectNear(scene.view.eye, {0.5, 0.5, 2});
  expectNear(scene.view.target, {0.5, 0.5, 4});  // turned about y: looks along +z, as far as the scene's centre is
  const auto second = scene.viewOfCamera(1);
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->lens.yfov, 0.5f);
  EXPECT_EQ(second->lens.znear, 0.25f);
  expectNear(second->target, {0.5, 0.5, 0});
  expectNear(second->up, {0, 1, 0});
  EXPECT_FALSE(scene.viewOfCamera(2).has_value());
}

TEST(GltfCameras, WithoutACameraTheSceneIsFramed) {
  GltfBuilder b;
  b.square();
  const LoadedScene loaded = b.mustLoad();
  EXPECT_TRUE(hasNote(loaded.report, "no camera"));
  expectNear(loaded.scene.view.target, {0.5, 0.5, 0});
  const double distance = glm::length(loaded.scene.view.eye - loaded.scene.view.target);
  EXPECT_NEAR(distance * std::sin(double(loaded.scene.view.lens.yfov) / 2), std::sqrt(0.5), 1e-6);
}

TEST(GltfCameras, BadLensesAreRefused) {
  const auto refusal = [](const json& camera) {
    GltfBuilder b;
    b.square();
    b.push("cameras", camera);
    return b.refusal();
  };
  EXPECT_EQ(refusal({{"type", "perspective"}, {"perspective", {{"yfov", 4}, {"znear", 0.1}}}}),
            "out-of-range test.glb#/cameras/0/perspective/yfov");
  EXPECT_EQ(refusal({{"type", "perspective"}, {"perspective", {{"yfov", 1}}}}),
            "bad-file test.glb#/cameras/0/perspective");
  EXPECT_EQ(
      refusal({{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 0}, {"znear", 0}, {"zfar", 1}}}}),
      "out-of-range test.glb#/cameras/0/orthographic/ymag");
  EXPECT_EQ(refusal({{"type", "fisheye"}}), "bad-file test.glb#/cameras/0/type");
}

GltfBuilder withLight(const json& light) {
  GltfBuilder b;
  b.square();
  b.doc["extensions"]["KHR_lights_punctual"]["lights"] = {light};
  b.root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  return b;
}

TEST(GltfLights, PointSpotDirectional) {
  const Light point = withLight({{"type", "point"}, {"color", {1, 0.5, 0.25}}, {"intensity", 40}, {"range", 7}})
                          .mustLoad()
                          .scene.lights.at(0);
  EXPECT_EQ(point.type, LightType::point);
  EXPECT_EQ(point.color, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(point.intensity, 40.0f);
  EXPECT_EQ(point.range, 7.0f);
  const Light spot = withLight({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}})
                         .mustLoad()
                         .scene.lights.at(0);
  EXPECT_EQ(spot.type, LightType::spot);
  EXPECT_EQ(spot.innerConeAngle, 0.1f);
  EXPECT_EQ(spot.outerConeAngle, 0.2f);
  EXPECT_EQ(spot.intensity, 1.0f);
  const Scene sun = withLight({{"type", "directional"}}).mustLoad().scene;
  EXPECT_EQ(sun.lights.at(0).type, LightType::directional);
  EXPECT_EQ(sun.nodes[1].light, 0);
  EXPECT_EQ(sun.environment.radiance, glm::vec3(0));
}

TEST(GltfLights, ColoursAboveOneMoveIntoTheIntensity) {
  const Light light =
      withLight({{"type", "point"}, {"color", {4, 2, 1}}, {"intensity", 10}}).mustLoad().scene.lights.at(0);
  EXPECT_EQ(light.color, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(light.intensity, 40.0f);
}

TEST(GltfLights, BadLightsAreRefused) {
  const std::string place = "test.glb#/extensions/KHR_lights_punctual/lights/0";
  EXPECT_EQ(withLight({{"type", "point"}, {"intensity", -1}}).refusal(), "out-of-range " + place + "/intensity");
  EXPECT_EQ(withLight({{"type", "spot"}}).refusal(), "bad-file " + place);
  EXPECT_EQ(withLight({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}}).refusal(),
            "out-of-range " + place + "/spot");
  EXPECT_EQ(withLight({{"type", "spot"}, {"spot", {{"outerConeAngle", 2}}}}).refusal(),
            "out-of-range " + place + "/spot/outerConeAngle");
  EXPECT_EQ(withLight({{"type", "point"}, {"color", {0, -1, 0}}}).refusal(), "out-of-range " + place + "/color/1");
}

TEST(GltfLights, WithoutLightANeutralEnvironmentIsAdded) {
  GltfBuilder b;
  b.square()["material"] = 0;
  b.push("materials", json::object());
  const LoadedScene dark = b.mustLoad();
  EXPECT_EQ(dark.scene.environment.radiance, glm::vec3(1));
  EXPECT_TRUE(hasNote(dark.report, "no light"));
  b.doc["materials"][0]["emissiveFactor"] = {1, 1, 1};
  const LoadedScene glowing = b.mustLoad();
  EXPECT_EQ(glowing.scene.environment.radiance, glm::vec3(0));
  EXPECT_FALSE(hasNote(glowing.report, "no light"));
}

GltfBuilder withMorph() {
  GltfBuilder b;
  json& primitive = b.square();
  const int up = b.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3),
            right = b.accessor<float>({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, 3);
  primitive["targets"] = {{{"POSITION", up}}, {{"POSITION", right}}};
  return b;
}

TEST(GltfMorph, WeightsOfTheNodeGoBeforeThoseOfTheMesh) {
  GltfBuilder b = withMorph();
  b.doc["meshes"][0]["weights"] = {0.5, 0};
  b.root({{"mesh", 0}, {"weights", {0, 2}}});
  b.root({{"mesh", 0}});
  b.root({{"mesh", 0}, {"weights", {0, 0}}});
  const Scene scene = b.mustLoad().scene;
  ASSERT_EQ(scene.meshes.size(), 3u);  // nodes 0 and 2 share one
  EXPECT_EQ(scene.nodes[0].mesh, scene.nodes[2].mesh);
  const auto first = [&](size_t node) {
    return scene.meshes[size_t(scene.nodes[node].mesh)].primitives[0].positions[0];
  };
  EXPECT_EQ(first(0), glm::vec3(0, 0, 0.5f));
  EXPECT_EQ(first(1), glm::vec3(2, 0, 0));
  EXPECT_EQ(first(3), glm::vec3(0));
  const auto rest = [&](size_t node) {
    return scene.meshes[size_t(scene.nodes[node].mesh)].primitives[0].restPositions;
  };
  ASSERT_EQ(rest(0).size(), 4u);
  EXPECT_EQ(rest(0)[0], glm::vec3(0));
  EXPECT_TRUE(rest(3).empty());  // nothing bends it
}

TEST(GltfMorph, TheWorkOfManyTargetsIsLimited) {
  GltfBuilder b = withMorph();
  b.doc["meshes"][0]["weights"] = {1, 1};
  LoadOptions options;
  options.limits.maxVertices = 8;
  EXPECT_EQ(b.refusal(options), "loaded");
  options.limits.maxVertices = 7;
  EXPECT_EQ(b.refusal(options), "limit test.glb#/meshes/0/primitives/0/targets");
}

TEST(GltfMorph, FlatNormalsFollowTheMorphedShape) {
  GltfBuilder b = withMorph();
  json& primitive = b.doc["meshes"][0]["primitives"][0];
  primitive["attributes"].erase("NORMAL");
  primitive["targets"][0]["POSITION"] =
      b.accessor<float>({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1}, 3);  // lifts the far edge
  b.doc["meshes"][0]["weights"] = {1, 0};
  const Scene scene = b.mustLoad().scene;
  expectNear(glm::dvec3(scene.meshes[0].primitives[0].normals[0]), glm::dvec3(0, -std::sqrt(0.5), std::sqrt(0.5)),
             1e-6);
  EXPECT_EQ(scene.meshes[0].primitives[0].restPositions.size(), 6u);  // split as the posed vertices are
}

/// The square on two joints: the left vertices on joint node 1, the right ones on joint node 2, which is moved by (0,
/// 0, 3).
GltfBuilder withSkin() {
  GltfBuilder b;
  json& primitive = b.square();
  primitive["attributes"]["JOINTS_0"] = b.accessor<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, 4);
  primitive["attributes"]["WEIGHTS_0"] = b.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0, 0, 0, 1, 0, 0, 0}, 4);
  b.root({{"translation", {0, 0, 0}}});
  b.root({{"translation", {0, 0, 3}}});
  b.push("skins", {{"joints", {1, 2}}});
  b.doc["nodes"][0]["skin"] = 0;
  return b;
}

TEST(GltfSkin, VerticesFollowTheirJointsWhereverTheNodeIs) {
  GltfBuilder b = withSkin();
  b.doc["nodes"][0]["translation"] = {100, 0, 0};
  const Scene scene = b.mustLoad().scene;
  const Primitive& p = scene.meshes[size_t(scene.nodes[0].mesh)].primitives[0];
  const glm::dmat4 world = scene.worldFromNodes()[0];
  expectNear(at(world, p.positions[0]), {0, 0, 0}, 1e-5);
  expectNear(at(world, p.positions[1]), {1, 0, 3}, 1e-5);
  expectNear(at(world, p.positions[2]), {1, 1, 3}, 1e-5);  // its weights sum to one half and count relative to that
  EXPECT_EQ(p.restPositions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
}

TEST(GltfSkin, InverseBindMatricesApplyFirst) {
  GltfBuilder b = withSkin();
  std::vector<float> matrices;
  for (int joint = 0; joint < 2; ++joint)
    matrices.insert(matrices.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -3.0f * float(joint), 1});
  b.doc["skins"][0]["inverseBindMatrices"] = b.accessor(matrices, 16);
  const Scene scene = b.mustLoad().scene;
  const Primitive& p = scene.meshes[0].primitives[0];
  expectNear(glm::dvec3(p.positions[1]), {1, 0, 0}, 1e-6);
}

TEST(GltfSkin, TheWorkOfManyJointsIsLimited) {
  GltfBuilder b = withSkin();
  b.doc["skins"][0]["joints"] = std::vector<int>(9, 1);
  LoadOptions options;
  options.limits.maxVertices = 9;
  EXPECT_EQ(b.refusal(options), "loaded");
  options.limits.maxVertices = 8;
  EXPECT_EQ(b.refusal(options), "limit test.glb#/nodes/0/skin");
}

TEST(GltfSkin, JointsBeyondTheSkinAreRefused) {
  GltfBuilder b = withSkin();
  b.doc["skins"][0]["joints"] = {1};
  EXPECT_EQ(b.refusal(), "out-of-range test.glb#/meshes/0/primitives/0/attributes/JOINTS_0");
}

GltfBuilder withInstances() {
  GltfBuilder b;
  b.square();
  const int translations = b.accessor<float>({1, 0, 0, 2, 0, 0, 3, 0, 0}, 3),
            scales = b.accessor<float>({1, 1, 1, 2, 2, 2, 0, 1, 1}, 3);
  b.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", translations},
                                                                              {"SCALE", scales}};
  return b;
}

TEST(GltfInstancing, InstancesBecomeChildNodes) {
  const Scene scene = withInstances().mustLoad().scene;
  ASSERT_EQ(scene.nodes.size(), 3u);  // the third instance is flat
  EXPECT_EQ(scene.nodes[0].mesh, kNone);
  EXPECT_EQ(scene.nodes[0].children, (std::vector<uint32_t>{1, 2}));
  EXPECT_EQ(scene.nodes[1].mesh, scene.nodes[2].mesh);
  expectNear(at(scene.worldFromNodes()[2], {1, 1, 0}), {4, 2, 0});
}

TEST(GltfInstancing, CountsAgainstTheNodeLimit) {
  LoadOptions options;
  options.limits.maxNodes = 3;
  EXPECT_EQ(withInstances().refusal(options), "limit test.glb#/nodes/0");
}

}  // namespace
}  // namespace limn::test
