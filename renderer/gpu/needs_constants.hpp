#pragma once
#include <cstdint>
#include <vector>

#include "renderer/scene/scene_needs.hpp"

namespace limn::gpu {

/// The specialization constants of shaders/lib/scene_bindings.glsl, in their order.
inline std::vector<uint32_t> needsConstants(const SceneNeeds& needs) {
  return {needs.textures,     needs.vertexColors,   needs.alpha,          needs.glossy || needs.mirror || needs.transmission,
          needs.transmission, needs.clearcoat,      needs.punctualLights, needs.emissiveTriangles,
          needs.environment,  needs.environmentImage};
}

/// Every need at once: the variant that renders anything.
inline SceneNeeds allNeeds() {
  return {true, true, true, true, true, true, true, true, true, true, true, true, true};
}

/// Whether a pipeline made for `made` renders a scene that needs `wanted`.
inline bool covers(const SceneNeeds& made, const SceneNeeds& wanted) {
  const std::vector<uint32_t> have = needsConstants(made), want = needsConstants(wanted);
  for (size_t i = 0; i < have.size(); ++i)
    if (want[i] && !have[i]) return false;
  return true;
}

}  // namespace limn::gpu
