#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "shaders/shared/scene_shared.h"

namespace limn::gpu {

/// Where lights are and which way they shine: a leaf of the light tree, or all that a branch holds.
struct LightBounds {
  glm::vec3 low{0.0f}, high{0.0f};       ///< box, render space
  glm::dvec3 axis{0.0, 0.0, 1.0};        ///< unit, of the cone of the ways their emission is strongest
  double opening = 0.0;                  ///< [rad] half its angle; pi: any way
  float cosEnd = shared::kTwoSidedEnd;   ///< shared::LightNode::cosEnd
  double intensity = 0.0;                ///< [W/sr] luminance, each the way it is strongest
  uint32_t light = 0;                    ///< index of a leaf's light
};

LightBounds pointBounds(const glm::vec3& posR, double intensity);
/// `cosOuter` is that of the cone outside which nothing is sent.
LightBounds spotBounds(const glm::vec3& posR, const glm::vec3& dirR, float cosOuter, double intensity);
/// `corner` are three in render space that span an area; `intensity` is radiance times that area.
LightBounds triangleBounds(const glm::vec3* corner, double intensity);

/// Nodes of the tree over so many lights.
constexpr uint64_t lightTreeNodes(uint64_t lights) { return 2 * lights - 2; }

/// The tree that shaders/lib/light_tree.glsl walks, over two or more lights: halves are those that make intensity times
/// squared diagonal least. [Conty Estevez and Kulla 2018, without their measure of directions] A function of `lights` alone.
std::vector<shared::LightNode> buildLightTree(std::span<const LightBounds> lights);

}  // namespace limn::gpu
