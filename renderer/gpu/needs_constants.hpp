#pragma once
#include <cstdint>
#include <vector>

#include "renderer/scene/scene_needs.hpp"

namespace limn::gpu {

/// The specialization constants of shaders/lib/scene_bindings.glsl, in their order.
inline std::vector<uint32_t> needsConstants(const SceneNeeds& needs) {
  return {needs.textures,     needs.vertexColors,   needs.alpha,          needs.glossy || needs.mirror || needs.transmission,
          needs.transmission, needs.clearcoat,      needs.punctualLights, needs.emissiveTriangles,
          needs.environment,  needs.environmentImage, needs.manyLights,     needs.panes};
}

/// Every need at once: the variant that renders anything.
inline SceneNeeds allNeeds() {
  return {true, true, true, true, true, true, true, true, true, true, true, true, true, true, true};
}

}  // namespace limn::gpu
