#include "renderer/gpu/material_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace limn::gpu {
namespace {

std::array<const TextureRef*, 10> slotsOf(const Material& m) {
  return {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissiveTexture,
          &m.transmissionTexture, &m.specularTexture, &m.specularColorTexture, &m.clearcoatTexture,
          &m.clearcoatRoughnessTexture, &m.clearcoatNormalTexture};
}

bool isTextured(const Material& m) {
  const auto slots = slotsOf(m);
  return std::any_of(slots.begin(), slots.end(), [](const TextureRef* slot) { return slot->present(); });
}

shared::TextureSlot slotData(const TextureRef& ref, bool srgb) {
  shared::TextureSlot s{};
  s.image = ref.present() ? uint32_t(ref.image) : shared::kNoIndex;
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
  d.normalScale = m.normalScale;
  d.clearcoatNormalScale = m.clearcoatNormalScale;
  d.alphaCutoff = m.alphaCutoff;
  d.absorption = absorptionOf(m);
  d.flags = (m.emission != glm::vec3(0.0f) ? shared::kMaterialEmissive : 0u) | (m.unlit ? shared::kMaterialUnlit : 0u) |
            (m.alphaMode == AlphaMode::mask ? shared::kMaterialMask : 0u) |
            (m.alphaMode == AlphaMode::blend ? shared::kMaterialBlend : 0u) |
            (m.thickness <= 0.0f ? shared::kMaterialThin : 0u) | (isTextured(m) ? shared::kMaterialTextured : 0u) |
            (vertexColors ? shared::kMaterialVertexColor : 0u);
  d.baseColorTexture = slotData(m.baseColorTexture, true);
  d.metallicRoughnessTexture = slotData(m.metallicRoughnessTexture, false);
  d.normalTexture = slotData(m.normalTexture, false);
  d.emissiveTexture = slotData(m.emissiveTexture, true);
  d.transmissionTexture = slotData(m.transmissionTexture, false);
  d.specularTexture = slotData(m.specularTexture, false);
  d.specularColorTexture = slotData(m.specularColorTexture, true);
  d.clearcoatTexture = slotData(m.clearcoatTexture, false);
  d.clearcoatRoughnessTexture = slotData(m.clearcoatRoughnessTexture, false);
  d.clearcoatNormalTexture = slotData(m.clearcoatNormalTexture, false);
  return d;
}

}  // namespace

bool needsAlphaTest(const Material& m) { return m.alphaMode != AlphaMode::opaque; }

TexelHeap buildTexelHeap(const Scene& scene) {
  std::vector<bool> used(scene.images.size(), false);
  for (const Material& m : scene.materials) {
    for (const TextureRef* slot : slotsOf(m))
      if (slot->present()) used[size_t(slot->image)] = true;
  }
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

std::vector<shared::MaterialData> buildMaterialTable(const Scene& scene) {
  std::vector<bool> vertexColors(scene.materials.size() + 1, false);
  for (const Mesh& mesh : scene.meshes)
    for (const Primitive& p : mesh.primitives)
      if (!p.colors.empty()) vertexColors[size_t(p.material + 1)] = true;
  std::vector<shared::MaterialData> table{materialData(Material{}, vertexColors[0])};
  for (size_t i = 0; i < scene.materials.size(); ++i) table.push_back(materialData(scene.materials[i], vertexColors[i + 1]));
  return table;
}

}  // namespace limn::gpu
