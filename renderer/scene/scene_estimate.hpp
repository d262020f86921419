#pragma once
#include <cstdint>
#include <vector>

#include "renderer/scene/scene.hpp"

namespace limn {

/// A primitive as one node shows it, counted: it is flattened, lit and traced as one block.
struct BlockSize {
  int32_t material = kNone;
  uint64_t triangles = 0, vertices = 0;
  uint64_t solidTriangles = 0;  ///< with an area in the mesh's own space; the others are never hit and never shine
};
/// Every node has its own copy of its mesh.
std::vector<BlockSize> blockSizes(const Scene& scene);

/// Over all nodes.
uint64_t instancedTriangles(const Scene& scene);

/// What the Scene itself holds on the host [byte], names left aside.
uint64_t hostBytes(const Scene& scene);

}  // namespace limn
