// Each feature of a material or light raises its own flag, and only when a node shows it.
#include "renderer/scene/scene_needs.hpp"

#include <functional>

#include <gtest/gtest.h>

namespace limn {
namespace {

/// One triangle of a diffuse material: no specular lobe at all, so nothing is needed.
Scene diffuseScene() {
  Scene scene;
  Primitive p;
  p.material = 0;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.normals.assign(3, {0, 0, 1});
  p.indices = {0, 1, 2};
  scene.meshes.push_back({"", {p}});
  scene.materials.resize(1);
  scene.materials[0].metallic = 0.0f;
  scene.materials[0].specular = 0.0f;
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  scene.roots = {0};
  return scene;
}

std::vector<std::string> needsAfter(const std::function<void(Scene&)>& change) {
  Scene scene = diffuseScene();
  change(scene);
  return describe(sceneNeeds(scene));
}
std::vector<std::string> needsOf(const std::function<void(Material&)>& change) {
  return needsAfter([&](Scene& scene) { change(scene.materials[0]); });
}
using Names = std::vector<std::string>;

TEST(SceneNeeds, ADiffuseSceneNeedsNothing) {
  EXPECT_EQ(needsAfter([](Scene&) {}), Names{});
}

TEST(SceneNeeds, MaterialFeatures) {
  EXPECT_EQ(needsOf([](Material& m) { m.emission = {0, 1, 0}; }), Names{"emissiveTriangles"});
  EXPECT_EQ(needsOf([](Material& m) { m.alphaMode = AlphaMode::mask; }), Names{"alpha"});
  EXPECT_EQ(needsOf([](Material& m) { m.alphaMode = AlphaMode::blend; }), Names{"alpha"});
  EXPECT_EQ(needsOf([](Material& m) { m.specular = 0.5f; }), Names{"glossy"});
  EXPECT_EQ(needsOf([](Material& m) { m.metallic = 0.5f; }), Names{"glossy"});
  EXPECT_EQ(needsOf([](Material& m) { m.metallic = 1, m.roughness = 0; }), (Names{"glossy", "mirror", "sharp"}));
  EXPECT_EQ(needsOf([](Material& m) { m.transmission = 1; }), (Names{"transmission", "glossy", "sharp"}));
  EXPECT_EQ(needsOf([](Material& m) { m.transmission = 1, m.roughness = 0; }),
            (Names{"transmission", "panes", "glossy", "mirror", "sharp"}));
  EXPECT_EQ(needsOf([](Material& m) { m.transmission = 1, m.ior = 1; }), (Names{"transmission", "panes", "glossy", "sharp"}));
  EXPECT_EQ(needsOf([](Material& m) { m.transmission = 1, m.ior = 0.9995f, m.thickness = 1; }),
            (Names{"transmission", "panes", "glossy", "sharp"}));
  EXPECT_EQ(needsOf([](Material& m) { m.transmission = 1, m.metallicRoughnessTexture.image = 0; }),
            (Names{"textures", "transmission", "panes", "glossy", "mirror", "sharp"}));
  EXPECT_EQ(needsOf([](Material& m) { m.transmission = 1, m.roughness = 0, m.thickness = 1; }),
            (Names{"transmission", "glossy", "mirror", "sharp"}));
  EXPECT_EQ(needsOf([](Material& m) { m.clearcoat = 1, m.clearcoatRoughness = 0.5f; }), (Names{"clearcoat", "glossy", "sharp"}));
  EXPECT_EQ(needsOf([](Material& m) { m.clearcoat = 1; }), (Names{"clearcoat", "glossy", "mirror", "sharp"}));
  EXPECT_EQ(needsOf([](Material& m) { m.baseColorTexture.image = 0; }), Names{"textures"});
  EXPECT_EQ(needsOf([](Material& m) { m.normalTexture.image = 0; }), (Names{"textures", "normalMaps"}));
  EXPECT_EQ(needsOf([](Material& m) { m.roughness = 0; }), Names{});  // nothing specular to be smooth
}

TEST(SceneNeeds, LightsAtAPlaceAreCountedWhereverTheyAreShown) {
  const auto lamps = [](LightType type, uint64_t count) {
    return needsAfter([&](Scene& scene) {
      scene.lights.resize(1);
      scene.lights[0].type = type;
      scene.nodes.resize(1 + count);
      for (uint64_t i = 1; i <= count; ++i) scene.nodes[i].light = 0;
    });
  };
  EXPECT_EQ(lamps(LightType::point, kFewLights), Names{"punctualLights"});
  EXPECT_EQ(lamps(LightType::spot, kFewLights + 1), (Names{"punctualLights", "manyLights"}));
  EXPECT_EQ(lamps(LightType::directional, kFewLights + 1), Names{"punctualLights"});
  const auto panels = [](bool unlit) {
    return needsAfter([&](Scene& scene) {
      scene.materials[0].emission = {0, 1, 0};
      scene.materials[0].unlit = unlit;
      scene.nodes.resize(1 + kFewLights);
      for (Node& node : scene.nodes) node.mesh = 0;
    });
  };
  EXPECT_EQ(panels(false), (Names{"emissiveTriangles", "manyLights"}));
  EXPECT_EQ(panels(true), Names{});
}

TEST(SceneNeeds, ATextureMayMakeAnyRoughnessSmooth) {
  const Names needs = needsOf([](Material& m) { m.metallic = 1, m.metallicRoughnessTexture.image = 0; });
  EXPECT_EQ(needs, (Names{"textures", "glossy", "mirror", "sharp"}));
}

TEST(SceneNeeds, UnlitMaterialsTransportNothing) {
  EXPECT_EQ(needsOf([](Material& m) {
              m.unlit = true, m.metallic = 1, m.emission = {1, 1, 1}, m.transmission = 1;
            }),
            Names{});
}

TEST(SceneNeeds, TheDefaultMaterialIsMetal) {
  EXPECT_EQ(needsAfter([](Scene& s) { s.meshes[0].primitives[0].material = kNone; }), Names{"glossy"});
}

TEST(SceneNeeds, WhatNoNodeShowsIsNotNeeded) {
  EXPECT_EQ(needsAfter([](Scene& s) { s.materials[0].emission = {1, 1, 1}, s.nodes[0].mesh = kNone; }), Names{});
  EXPECT_EQ(needsAfter([](Scene& s) { s.materials.push_back({}), s.materials[1].transmission = 1; }), Names{});
  EXPECT_EQ(needsAfter([](Scene& s) { s.lights.resize(1); }), Names{});
}

TEST(SceneNeeds, LightsAndEnvironment) {
  const auto light = [](float intensity) {
    return needsAfter([&](Scene& s) {
      s.lights.resize(1);
      s.lights[0].intensity = intensity;
      s.nodes[0].light = 0;
    });
  };
  EXPECT_EQ(light(1), Names{"punctualLights"});
  EXPECT_EQ(light(0), Names{});
  EXPECT_EQ(needsAfter([](Scene& s) { s.environment.radiance = {0, 0, 1}; }), Names{"environment"});
  EXPECT_EQ(needsAfter([](Scene& s) { s.environment.image = std::make_shared<const Image>(); }), Names{});
  EXPECT_EQ(needsAfter([](Scene& s) {
              s.environment.image = std::make_shared<const Image>(), s.environment.radiance = {0, 0, 1};
            }),
            (Names{"environment", "environmentImage"}));
  EXPECT_EQ(needsAfter([](Scene& s) { s.meshes[0].primitives[0].colors.resize(3); }), Names{"vertexColors"});
}

}  // namespace
}  // namespace limn
