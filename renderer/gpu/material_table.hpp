#pragma once
#include <vector>

#include "renderer/scene/scene.hpp"
#include "shaders/shared/scene_shared.h"

namespace limn::gpu {

/// One entry an image: whether any material samples it.
std::vector<bool> sampledImages(const Scene& scene);

/// Where each image's texels begin in the texel heap; images that no material samples have no place (kNoIndex).
struct TexelHeap {
  std::vector<shared::ImageInfo> images;
  std::vector<uint32_t> texels;     ///< RGBA8, one word each, row 0 on top
};
TexelHeap buildTexelHeap(const Scene& scene);

/// Entry 0 is the default material; material i of the scene is entry i + 1.
struct MaterialTable {
  std::vector<shared::MaterialData> materials;
  std::vector<shared::TextureSlot> slots;
};
MaterialTable buildMaterialTable(const Scene& scene);

/// Whether hits on the material must ask for its alpha.
bool needsAlphaTest(const Material& material);

}  // namespace limn::gpu
