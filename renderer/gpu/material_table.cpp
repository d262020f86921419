#include "renderer/gpu/material_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace limn::gpu {
namespace {

/// Images of a material in the order of their targets (kTarget...).
std::array<const TextureRef*, 10> slotsOf(const Material& m) {
  return {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissiveTexture,
          &m.transmissionTexture, &m.specularTexture, &m.specularColorTexture, &m.clearcoatTexture,
          &m.clearcoatRoughnessTexture, &m.clearcoatNormalTexture};
}

shared::TextureSlot slotData(const TextureRef& ref, uint32_t target) {
  const bool srgb = target == shared::kTargetBaseColor || target == shared::kTargetEmissive || target == shared::kTargetSpecularColor;
  shared::TextureSlot s{};
  s.image = uint32_t(ref.image);
  s.target = target;
  s.sampler_ = uint32_t(ref.wrapS) | uint32_t(ref.wrapT) << 2 | (ref.nearest ? shared::kSamplerNearest : 0u) |
               (srgb ? shared::kSamplerSrgb : 0u) | (ref.texCoord == 1 ? shared::kSamplerTexCoord1 : 0u);
  // translation * rotation * scale of KHR_texture_transform
  const float c = std::cos(ref.rotation), n = std::sin(ref.rotation);
  s.rowU = {c * ref.scale.x, n * ref.scale.y, ref.offset.x};
  s.rowV = {-n * ref.scale.x, c * ref.scale.y, ref.offset.y};
  return s;
}

glm::vec3 absorptionOf(const Material& m) {
  if (m.thickness <= 0.0f || m.attenuationDistance <= 0.0f) return glm::vec3(0.0f);
  // A channel of 0 would absorb infinitely; e^-80 over the distance is black enough.
  const glm::vec3 color = glm::max(m.attenuationColor, glm::vec3(1.8e-35f));
  return -glm::log(color) / m.attenuationDistance;
}

shared::MaterialData materialData(const Material& m, bool vertexColors) {
  shared::MaterialData d{};
  d.baseColor = m.baseColor;
  d.emission = m.emission;
  d.metallic = m.metallic;
  d.roughness = m.roughness;
  d.ior = m.ior;
  d.transmission = m.transmission;
  d.specular = m.specular;
  d.specularColor = m.specularColor;
  d.clearcoat = m.clearcoat;
  d.clearcoatRoughness = m.clearcoatRoughness;
  d.alphaCutoff = m.alphaCutoff;
  d.absorption = absorptionOf(m);
  d.flags = (m.emission != glm::vec3(0.0f) ? shared::kMaterialEmissive : 0u) | (m.unlit ? shared::kMaterialUnlit : 0u) |
            (m.alphaMode == AlphaMode::mask ? shared::kMaterialMask : 0u) |
            (m.alphaMode == AlphaMode::blend ? shared::kMaterialBlend : 0u) |
            (m.thickness <= 0.0f ? shared::kMaterialThin : 0u) | (vertexColors ? shared::kMaterialVertexColor : 0u);
  return d;
}

void addMaterial(MaterialTable& table, const Material& m, bool vertexColors) {
  shared::MaterialData d = materialData(m, vertexColors);
  d.firstSlot = uint32_t(table.slots.size());
  const auto refs = slotsOf(m);
  for (uint32_t target = 0; target < refs.size(); ++target) {
    if (!refs[target]->present()) continue;
    table.slots.push_back(slotData(*refs[target], target));
    table.slots.back().scale = target == shared::kTargetClearcoatNormal ? m.clearcoatNormalScale : m.normalScale;
  }
  d.slotCount = uint32_t(table.slots.size()) - d.firstSlot;
  table.materials.push_back(d);
}

}  // namespace

bool needsAlphaTest(const Material& m) { return m.alphaMode != AlphaMode::opaque; }

std::vector<bool> sampledImages(const Scene& scene) {
  std::vector<bool> used(scene.images.size(), false);
  for (const Material& m : scene.materials) {
    for (const TextureRef* slot : slotsOf(m))
      if (slot->present()) used[size_t(slot->image)] = true;
  }
  return used;
}

TexelHeap buildTexelHeap(const Scene& scene) {
  const std::vector<bool> used = sampledImages(scene);
  TexelHeap heap;
  for (size_t i = 0; i < scene.images.size(); ++i) {
    const Image& image = scene.images[i];
    if (!used[i] || image.rgba8.empty()) {
      heap.images.push_back({shared::kNoIndex, 0, 0, 0});
      continue;
    }
    heap.images.push_back({uint32_t(heap.texels.size()), image.width, image.height, 0});
    heap.texels.resize(heap.texels.size() + size_t(image.width) * image.height);
    std::memcpy(&heap.texels[heap.images.back().firstTexel], image.rgba8.data(), image.rgba8.size());
  }
  return heap;
}

MaterialTable buildMaterialTable(const Scene& scene) {
  std::vector<bool> vertexColors(scene.materials.size() + 1, false);
  for (const Mesh& mesh : scene.meshes)
    for (const Primitive& p : mesh.primitives)
      if (!p.colors.empty()) vertexColors[size_t(p.material + 1)] = true;
  MaterialTable table;
  addMaterial(table, Material{}, vertexColors[0]);
  for (size_t i = 0; i < scene.materials.size(); ++i) addMaterial(table, scene.materials[i], vertexColors[i + 1]);
  return table;
}

}  // namespace limn::gpu
