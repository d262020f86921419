#pragma once
#include <vector>

#include "renderer/gpu/geometry.hpp"
#include "renderer/scene/scene.hpp"
#include "shaders/shared/scene_shared.h"

namespace limn::gpu {

/// Every light of the scene with its chance of being chosen, and the light each triangle is.
struct LightTable {
  std::vector<shared::LightData> lights;
  std::vector<uint32_t> lightOfTriangle;  ///< kNoIndex for triangles that do not shine; one a triangle of the scene
  uint32_t environmentLight = shared::kNoIndex;
};

/// Chosen by power: the flux a light sends into the scene, textures and environment images by their mean.
LightTable buildLightTable(const Scene& scene, const std::vector<GeometryBlock>& blocks, const glm::dvec3& renderOrigin,
                           double sceneRadius);

}  // namespace limn::gpu
