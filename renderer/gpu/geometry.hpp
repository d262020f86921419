#pragma once
#include <vector>

#include <glm/glm.hpp>

#include "renderer/gpu/packing.hpp"
#include "renderer/scene/scene.hpp"

namespace limn::gpu {

/// One primitive of one node, flattened into render space: world space less `renderOrigin`, single precision.
struct GeometryBlock {
  uint32_t node = 0, mesh = 0, primitive = 0;
  uint32_t material = 0;                     ///< index into the device's material table (0 is the default material)
  uint32_t firstTriangle = 0, firstVertex = 0;  ///< in the scene-wide arrays
  std::vector<glm::vec3> corners;            ///< 3 a triangle
  std::vector<glm::vec3> positions;          ///< one a vertex
  std::vector<PackedVertex> vertices;
  std::vector<glm::uvec3> triangles;         ///< scene-wide vertex indices, winding counter-clockwise in front
  uint32_t triangleCount() const { return uint32_t(triangles.size()); }
};

/// Lists the blocks of a scene with their places in the scene-wide arrays; empty vectors, filled by placeBlock.
std::vector<GeometryBlock> listBlocks(const Scene& scene);

/// Writes the vertices of a block as they stand under `worldFromNode`.
void placeBlock(const Scene& scene, const glm::dmat4& worldFromNode, const glm::dvec3& renderOrigin, GeometryBlock& block);

/// Where render space has its origin: the point next to the scene's centre of a grid of four to eight radii, so that no place is
/// farther out than floats bear well, and moving an object seldom moves it; zero for a scene that begins less than a radius away
/// from zero. A function of the bounds alone.
glm::dvec3 renderOriginOf(const Bounds& bounds);

}  // namespace limn::gpu
