#pragma once
#include <cstdint>

#include "renderer/scene/scene.hpp"

namespace limn {

/// What a scene costs in memory [byte] without the picture's own buffers. Host numbers of the Scene are exact; the rest
/// follows from the sizes of the mirror's and the hierarchy's records, in which every node has its own copy of its
/// mesh.
struct SceneEstimate {
  uint64_t instancedTriangles = 0, instancedVertices = 0;  ///< over all nodes
  uint64_t sceneBytes = 0;                                 ///< the Scene itself, on the host
  uint64_t mirrorBytes = 0;  ///< flattened geometry and hierarchy kept on the host to rebuild from
  uint64_t deviceBytes = 0;  ///< geometry, hierarchy and texels on the device
  uint64_t hostBytes() const { return sceneBytes + mirrorBytes; }
};
SceneEstimate estimateScene(const Scene& scene);

}  // namespace limn
