#pragma once
#include <vector>

#include "renderer/gpu/geometry.hpp"
#include "renderer/scene/scene.hpp"
#include "shaders/shared/scene_shared.h"

namespace limn::gpu {

/// Every light of the scene with its chance of being chosen, and the light each triangle is.
struct LightTable {
  std::vector<shared::LightData> lights;
  std::vector<shared::LightNode> tree;    ///< empty where there are no more than kFewLights at a place
  float treeShare = 0.0f;                 ///< chance that the tree chooses; the rest is the alias table's
  std::vector<uint32_t> lightOfTriangle;  ///< kNoIndex for triangles that do not shine; one a triangle of the scene
  uint32_t environmentLight = shared::kNoIndex;
};

/// Power is the flux a light sends into the scene, textures and environment images by their mean. Few lights are chosen by
/// power alone. Of many, those at a place are in the tree, and the alias table chooses among the infinitely far ones.
LightTable buildLightTable(const Scene& scene, const std::vector<GeometryBlock>& blocks, const glm::dvec3& renderOrigin,
                           double sceneRadius);

}  // namespace limn::gpu
