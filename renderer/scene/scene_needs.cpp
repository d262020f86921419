#include "renderer/scene/scene_needs.hpp"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// Up to this perceptual roughness a lobe is a perfect mirror: GGX alpha = roughness² <= 1e-4, kMinAlpha of the
/// shaders.
constexpr float kMirrorRoughness = 0.01f;

bool shines(const glm::vec3& v) { return std::max({v.x, v.y, v.z}) > 0.0f; }

bool samplesImage(const Material& m) {
  for (const TextureRef* t : {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissiveTexture,
                              &m.transmissionTexture, &m.specularTexture, &m.specularColorTexture, &m.clearcoatTexture,
                              &m.clearcoatRoughnessTexture, &m.clearcoatNormalTexture}) {
    if (t->present()) return true;
  }
  return false;
}

bool reflectsSpecularly(const Material& m) {
  // glTF's F90 of a dielectric is `specular` alone: neither a black specular colour nor ior 1 takes the lobe away.
  return m.metallic > 0.0f || m.specular > 0.0f || m.clearcoat > 0.0f || m.transmission > 0.0f;
}

bool mayBeMirror(const Material& m) {
  const bool smooth = m.roughness <= kMirrorRoughness || m.metallicRoughnessTexture.present();
  const bool smoothCoat =
      m.clearcoat > 0.0f && (m.clearcoatRoughness <= kMirrorRoughness || m.clearcoatRoughnessTexture.present());
  return (reflectsSpecularly(m) && smooth) || smoothCoat;
}

/// Within this of 1 an index of refraction bends nothing: kNoIndexChange of the shaders.
constexpr float kNoIndexChange = 1e-3f;

bool mayBePane(const Material& m) {
  if (m.transmission <= 0.0f) return false;
  const bool smooth = m.roughness <= kMirrorRoughness || m.metallicRoughnessTexture.present();
  return std::abs(m.ior - 1.0f) < kNoIndexChange || (m.thickness <= 0.0f && smooth);
}

bool mayBeSharp(const Material& m) {
  const bool narrow = m.roughness < kSharpRoughness || m.metallicRoughnessTexture.present();
  return m.transmission > 0.0f || m.clearcoat > 0.0f || (reflectsSpecularly(m) && narrow);
}

void addMaterial(SceneNeeds& needs, const Material& m) {
  needs.textures |= samplesImage(m);
  needs.alpha |= m.alphaMode != AlphaMode::opaque;
  if (m.unlit) return;
  needs.emissiveTriangles |= shines(m.emission);
  needs.normalMaps |= m.normalTexture.present() || (m.clearcoat > 0.0f && m.clearcoatNormalTexture.present());
  needs.transmission |= m.transmission > 0.0f;
  needs.panes |= mayBePane(m);
  needs.clearcoat |= m.clearcoat > 0.0f;
  needs.glossy |= reflectsSpecularly(m);
  needs.mirror |= mayBeMirror(m);
  needs.sharp |= mayBeSharp(m);
}

/// Lights at a place, those without power or area too.
uint64_t placedLights(const Scene& scene) {
  uint64_t count = 0;
  for (const Node& node : scene.nodes) {
    count += node.light != kNone && scene.lights[size_t(node.light)].type != LightType::directional;
    if (node.mesh == kNone) continue;
    for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives) {
      if (primitive.material == kNone) continue;
      const Material& m = scene.materials[size_t(primitive.material)];
      if (!m.unlit && shines(m.emission)) count += primitive.indices.size() / 3;
    }
  }
  return count;
}

}  // namespace

SceneNeeds sceneNeeds(const Scene& scene) {
  SceneNeeds needs;
  std::vector<bool> meshSeen(scene.meshes.size(), false);
  std::vector<bool> materialSeen(scene.materials.size() + 1, false);  // the last is the default material
  for (const Node& node : scene.nodes) {
    if (node.light != kNone) {
      const Light& light = scene.lights[size_t(node.light)];
      needs.punctualLights |= light.intensity > 0.0f && shines(light.color);
    }
    if (node.mesh == kNone || meshSeen[size_t(node.mesh)]) continue;
    meshSeen[size_t(node.mesh)] = true;
    for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives) {
      if (primitive.indices.empty()) continue;
      needs.vertexColors |= !primitive.colors.empty();
      const size_t slot = primitive.material == kNone ? scene.materials.size() : size_t(primitive.material);
      if (materialSeen[slot]) continue;
      materialSeen[slot] = true;
      addMaterial(needs, primitive.material == kNone ? Material{} : scene.materials[slot]);
    }
  }
  needs.manyLights = placedLights(scene) > kFewLights;
  needs.environment = shines(scene.environment.radiance);
  needs.environmentImage = needs.environment && scene.environment.image;
  return needs;
}

std::span<const SceneNeedFlag> sceneNeedFlags() {
  static constexpr SceneNeedFlag kFlags[] = {
      {"punctualLights", &SceneNeeds::punctualLights},
      {"emissiveTriangles", &SceneNeeds::emissiveTriangles},
      {"environment", &SceneNeeds::environment},
      {"environmentImage", &SceneNeeds::environmentImage},
      {"textures", &SceneNeeds::textures},
      {"normalMaps", &SceneNeeds::normalMaps},
      {"alpha", &SceneNeeds::alpha},
      {"transmission", &SceneNeeds::transmission},
      {"panes", &SceneNeeds::panes},
      {"clearcoat", &SceneNeeds::clearcoat},
      {"glossy", &SceneNeeds::glossy},
      {"mirror", &SceneNeeds::mirror},
      {"sharp", &SceneNeeds::sharp},
      {"vertexColors", &SceneNeeds::vertexColors},
      {"manyLights", &SceneNeeds::manyLights},
  };
  static_assert(std::size(kFlags) * sizeof(bool) == sizeof(SceneNeeds), "every flag is listed");
  return kFlags;
}

std::vector<std::string> describe(const SceneNeeds& needs) {
  std::vector<std::string> names;
  for (const auto& [name, flag] : sceneNeedFlags()) {
    if (needs.*flag) names.emplace_back(name);
  }
  return names;
}

}  // namespace limn
