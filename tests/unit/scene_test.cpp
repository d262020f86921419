// The scene by itself: transforms, bounds, views, hash, memory.
#include "renderer/scene/scene.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "renderer/scene/scene_estimate.hpp"

namespace limn {
namespace {

/// One triangle at z = 0 in a mesh, shown by node 0.
Scene triangleScene() {
  Scene scene;
  Primitive p;
  p.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {100, 100, 100}};  // the last vertex is in no triangle
  p.normals.assign(4, {0, 0, 1});
  p.indices = {0, 1, 2};
  p.material = 0;
  scene.meshes.push_back({"Triangle", {p}});
  scene.materials.resize(1);
  scene.lights.resize(1);
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  scene.roots = {0};
  return scene;
}

TEST(Scene, TransformAppliesScaleThenRotationThenTranslation) {
  Transform t;
  t.translation = {1, 2, 3};
  t.rotation = glm::angleAxis(std::acos(-1.0) / 2, glm::dvec3(0, 0, 1));
  t.scale = {2, 3, 4};
  const glm::dvec3 p(t.toMatrix() * glm::dvec4(1, 1, 1, 1));
  EXPECT_NEAR(p.x, 1 - 3, 1e-12);
  EXPECT_NEAR(p.y, 2 + 2, 1e-12);
  EXPECT_NEAR(p.z, 3 + 4, 1e-12);
}

TEST(Scene, ParentsNeedNotPrecedeChildren) {
  Scene scene;
  scene.nodes.resize(3);
  scene.nodes[2].children = {0};
  scene.nodes[0].parent = 2;
  scene.nodes[0].children = {1};
  scene.nodes[1].parent = 0;
  for (Node& node : scene.nodes) node.parentFromLocal.translation = {1, 0, 0};
  const std::vector<glm::dmat4> world = scene.worldFromNodes();
  EXPECT_EQ(world[2][3].x, 1);
  EXPECT_EQ(world[0][3].x, 2);
  EXPECT_EQ(world[1][3].x, 3);
}

TEST(Scene, BoundsAreThoseOfTheTrianglesInTheWorld) {
  Scene scene = triangleScene();
  scene.nodes[0].parentFromLocal.translation = {1e6, 0, 0};
  const Bounds bounds = worldBounds(scene);
  EXPECT_EQ(bounds.low, glm::dvec3(1e6, 0, 0));
  EXPECT_EQ(bounds.high, glm::dvec3(1e6 + 2, 2, 0));
}

TEST(Scene, EmptyScenesHaveAUnitBox) {
  const Bounds bounds = worldBounds(Scene{});
  EXPECT_EQ(bounds.low, glm::dvec3(-0.5));
  EXPECT_EQ(bounds.high, glm::dvec3(0.5));
}

TEST(Scene, ManyInstancesAreBoundedByCornersAndNeverTooTight) {
  Scene scene = triangleScene();
  Primitive& p = scene.meshes[0].primitives[0];
  p.indices.clear();
  for (int i = 0; i < 100'000; ++i) p.indices.insert(p.indices.end(), {0, 1, 2});
  scene.nodes.resize(100, scene.nodes[0]);  // 30 million corners: above the limit of the exact way
  const Bounds bounds = worldBounds(scene);
  EXPECT_EQ(bounds.low, glm::dvec3(0));
  EXPECT_EQ(bounds.high, glm::dvec3(2, 2, 0));
}

TEST(Scene, FramingViewHoldsTheBoundingSphere) {
  const Bounds bounds{{1, 2, 3}, {4, 6, 9}};
  Camera lens;
  lens.yfov = 0.9f;
  const View view = framingView(bounds, lens);
  const double distance = glm::length(view.eye - view.target);
  EXPECT_EQ(view.target, bounds.center());
  EXPECT_NEAR(distance * std::sin(0.45), bounds.radius(), 1e-6);
  EXPECT_NEAR(glm::dot(view.up, view.eye - view.target), 0.0, 1e-9);
  EXPECT_LT(view.lens.znear, distance - bounds.radius());
}

TEST(Scene, FramingViewOfAPointIsStillAView) {
  const View view = framingView({{5, 5, 5}, {5, 5, 5}}, Camera{});
  EXPECT_GT(glm::length(view.eye - view.target), 0.0);
}

TEST(SceneHash, SeesEveryKindOfData) {
  const uint64_t base = triangleScene().hash();
  const auto changed = [&](auto change) {
    Scene scene = triangleScene();
    change(scene);
    return scene.hash() != base;
  };
  EXPECT_TRUE(changed([](Scene& s) { s.meshes[0].primitives[0].positions[1].x = 3; }));
  EXPECT_TRUE(changed([](Scene& s) { s.meshes[0].primitives[0].indices = {0, 2, 1}; }));
  EXPECT_TRUE(changed([](Scene& s) { s.meshes[0].primitives[0].uv0.resize(4); }));
  EXPECT_TRUE(changed([](Scene& s) { s.meshes[0].primitives[0].material = kNone; }));
  EXPECT_TRUE(changed([](Scene& s) { s.materials[0].clearcoatNormalTexture.image = 0; }));
  EXPECT_TRUE(changed([](Scene& s) { s.materials[0].doubleSided = true; }));
  EXPECT_TRUE(changed([](Scene& s) { s.lights[0].range = 1; }));
  EXPECT_TRUE(changed([](Scene& s) { s.nodes[0].parentFromLocal.matrix = glm::dmat4(1.0); }));
  EXPECT_TRUE(changed([](Scene& s) { s.nodes[0].parentFromLocal.rotation = {0, 1, 0, 0}; }));
  EXPECT_TRUE(changed([](Scene& s) { s.nodes[0].light = 0; }));
  EXPECT_TRUE(changed([](Scene& s) { s.environment.rotation = 1; }));
  EXPECT_TRUE(changed([](Scene& s) { s.images.push_back({"", 1, 1, {1, 2, 3, 4}, {}}); }));
}

TEST(SceneHash, IgnoresNamesTheViewAndTheSignOfZero) {
  Scene scene = triangleScene();
  const uint64_t before = scene.hash();
  scene.name = "other", scene.nodes[0].name = "other", scene.materials[0].name = "other";
  scene.view.eye = {9, 9, 9};
  scene.nodes[0].parentFromLocal.translation.x = -0.0;
  scene.materials[0].emission.y = -0.0f;
  EXPECT_EQ(scene.hash(), before);
}

TEST(SceneEstimate, CountsEveryNodesOwnCopy) {
  Scene scene = triangleScene();
  const uint64_t one = hostBytes(scene);
  EXPECT_EQ(instancedTriangles(scene), 1u);
  scene.nodes.resize(10, scene.nodes[0]);
  EXPECT_EQ(instancedTriangles(scene), 10u);
  EXPECT_EQ(hostBytes(scene), one + 9 * sizeof(Node));
  ASSERT_EQ(blockSizes(scene).size(), 10u);
  for (const BlockSize& block : blockSizes(scene)) {
    EXPECT_EQ(block.triangles, 1u);
    EXPECT_EQ(block.vertices, 4u);
    EXPECT_EQ(block.solidTriangles, 1u);
  }
  scene.images.push_back({"", 16, 16, std::vector<uint8_t>(16 * 16 * 4), {}});
  EXPECT_EQ(hostBytes(scene), one + 9 * sizeof(Node) + 1024);
}

TEST(SceneEstimate, TrianglesWithoutAreaAreToldApart) {
  Scene scene = triangleScene();
  Primitive& p = scene.meshes[0].primitives[0];
  p.indices.insert(p.indices.end(), {0, 1, 1});
  EXPECT_EQ(blockSizes(scene)[0].triangles, 2u);
  EXPECT_EQ(blockSizes(scene)[0].solidTriangles, 1u);
}

}  // namespace
}  // namespace limn
