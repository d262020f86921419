#include "tests/support/rich_scene.hpp"

#include <cmath>

namespace limn::test {
namespace {

/// A checker whose dark squares have little alpha.
Image checker() {
  Image image;
  image.name = "checker";
  image.width = image.height = 8;
  for (uint32_t i = 0; i < 64; ++i) {
    const bool bright = ((i / 8 + i % 8) & 1) == 0;
    for (const uint8_t v : {bright ? 230 : 90, bright ? 200 : 60, bright ? 150 : 120, bright ? 255 : 70}) image.rgba8.push_back(v);
  }
  return image;
}

Image bumps() {
  Image image;
  image.name = "bumps";
  image.width = image.height = 4;
  for (uint32_t i = 0; i < 16; ++i)
    for (const uint32_t v : {118u + 20u * (i % 2), 118u + 20u * (i / 4 % 2), 250u, 255u}) image.rgba8.push_back(uint8_t(v));
  return image;
}

/// The unit square in z = 0 about the origin, with every attribute.
Primitive card(uint32_t material, bool colors) {
  Primitive p;
  p.material = int32_t(material);
  p.positions = {{-0.5f, -0.5f, 0.0f}, {0.5f, -0.5f, 0.0f}, {0.5f, 0.5f, 0.0f}, {-0.5f, 0.5f, 0.0f}};
  p.normals.assign(4, {0.0f, 0.0f, 1.0f});
  p.tangents.assign(4, {1.0f, 0.0f, 0.0f, 1.0f});
  p.uv0 = {{0.0f, 1.0f}, {1.0f, 1.0f}, {1.0f, 0.0f}, {0.0f, 0.0f}};
  if (colors) p.colors = {{1, 1, 1, 1}, {1, 0.5f, 0.5f, 1}, {0.5f, 1, 0.5f, 1}, {0.5f, 0.5f, 1, 1}};
  p.indices = {0, 1, 2, 0, 2, 3};
  return p;
}

void adopt(Scene& scene, uint32_t parent, uint32_t child) {
  scene.nodes[child].parent = int32_t(parent);
  scene.nodes[parent].children.push_back(child);
  std::erase(scene.roots, child);
}

}  // namespace

std::shared_ptr<const Image> skyImage(uint32_t sun) {
  Image image;
  image.name = "sky-" + std::to_string(sun) + ".hdr";
  image.width = 8;
  image.height = 4;
  for (uint32_t i = 0; i < 32; ++i) {
    const float value = i == sun ? 6.0f : 0.2f + 0.05f * float(i % 5);
    for (const float v : {value, value * 0.9f, value * 1.1f, 1.0f}) image.rgbaF.push_back(v);
  }
  return std::make_shared<const Image>(std::move(image));
}

RichScene richScene() {
  SceneBuilder b;
  RichScene r;
  b.scene.images = {checker(), bumps()};
  b.scene.environment.image = skyImage(11);
  b.scene.environment.radiance = glm::vec3(0.4f);

  r.floor = b.diffuse({0.7f, 0.7f, 0.7f});
  b.scene.materials[r.floor].specular = 1.0f;
  b.scene.materials[r.floor].roughness = 0.4f;
  b.scene.materials[r.floor].normalTexture.image = 1;
  Material glass;
  glass.metallic = 0.0f;
  glass.roughness = 0.2f;
  glass.transmission = 1.0f;
  glass.thickness = 0.3f;
  glass.attenuationColor = {0.6f, 0.9f, 0.7f};
  glass.attenuationDistance = 0.5f;
  r.glass = b.material(glass);
  Material cutout;
  cutout.metallic = 0.0f;
  cutout.roughness = 0.8f;
  cutout.alphaMode = AlphaMode::mask;
  cutout.doubleSided = true;
  cutout.baseColorTexture.image = 0;
  r.cutout = b.material(cutout);
  r.coated = b.diffuse({0.6f, 0.1f, 0.1f});
  b.scene.materials[r.coated].clearcoat = 0.8f;
  b.scene.materials[r.coated].clearcoatRoughness = 0.1f;
  r.lamp = b.emitter({6.0f, 5.0f, 4.0f});
  r.metal = b.metal({0.9f, 0.8f, 0.5f}, 0.25f);

  const uint32_t floorNode = b.mesh(card(r.floor, true));
  b.scene.nodes[floorNode].parentFromLocal.rotation = glm::dquat(std::sqrt(0.5), -std::sqrt(0.5), 0.0, 0.0);
  b.scene.nodes[floorNode].parentFromLocal.translation = {0.0, -0.5, 0.0};
  b.scene.nodes[floorNode].parentFromLocal.scale = {3.0, 3.0, 1.0};
  r.group = floorNode;
  r.glassNode = b.sphere(r.glass, {0.0f, 0.0f, 0.0f}, 0.35f, 6);
  r.metalNode = b.box(r.metal, {-0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, 0.2f});
  const uint32_t cardNode = b.mesh(card(r.cutout, false));
  const uint32_t coatNode = b.sphere(r.coated, {0.7f, -0.25f, -0.4f}, 0.25f, 5);
  r.lampNode = b.quad(r.lamp, {-0.2f, 0.95f, -0.2f}, {0.2f, 0.95f, -0.2f}, {0.2f, 0.95f, 0.2f}, {-0.2f, 0.95f, 0.2f});
  b.scene.nodes[r.metalNode].parentFromLocal.translation = {-0.6, -0.3, -0.3};
  b.scene.nodes[cardNode].parentFromLocal.translation = {0.3, 0.1, 0.6};
  adopt(b.scene, r.metalNode, coatNode);

  b.pointLight({0.8f, 0.6f, 0.8f}, {1.0f, 0.9f, 0.8f}, 1.0f);
  b.spotLight({-0.8f, 0.8f, 0.5f}, {0.6f, -0.8f, -0.4f}, 2.0f, 0.2f, 0.5f);
  b.directionalLight({0.2f, -1.0f, -0.3f}, {1.0f, 1.0f, 1.0f}, 0.5f);
  b.look({0.0, 0.4, 2.6}, {0.0, -0.1, 0.0}, 0.7f);
  r.scene = b.scene;
  return r;
}

Scene plainScene() {
  SceneBuilder b;
  const uint32_t white = b.diffuse({0.7f, 0.7f, 0.7f}), red = b.diffuse({0.6f, 0.1f, 0.1f});
  b.quad(white, {-1, -1, 1}, {1, -1, 1}, {1, -1, -1}, {-1, -1, -1});
  b.quad(white, {-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1});
  b.quad(red, {-1, -1, 1}, {-1, -1, -1}, {-1, 1, -1}, {-1, 1, 1});
  b.box(red, {-0.3f, -1.0f, -0.3f}, {0.3f, -0.4f, 0.3f});
  b.pointLight({0.2f, 0.8f, 0.6f}, {1.0f, 1.0f, 1.0f}, 3.0f);
  b.look({0.2, 0.0, 3.2}, {0.0, -0.2, 0.0}, 0.7f);
  return b.scene;
}

}  // namespace limn::test
