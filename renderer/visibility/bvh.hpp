#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/visibility/bvh_build.hpp"
#include "renderer/visibility/bvh_layout.hpp"
#include "renderer/vk/buffer.hpp"

namespace limn {

/// The triangles of one object: a node's primitive. What moves as one should be one block.
struct TriangleBlock {
  std::span<const glm::vec3> corners;  ///< render space [m], finite, 3 a triangle; degenerate triangles are never hit
  uint32_t firstTriangle = 0;          ///< global id of its first triangle (< 2^31); ids are what hits report
  bool alphaTested = false;            ///< hits ask the shader's alphaAccepts()
};

/// What the last update did, and how much there is.
struct BvhStats {
  uint32_t nodes = 0;          ///< on the device
  uint32_t triangles = 0;      ///< on the device
  uint64_t bytes = 0;          ///< of both buffers
  uint64_t hostBytes = 0;      ///< of the blocks' trees, kept to lay out anew
  uint32_t blocksRebuilt = 0;  ///< blocks whose own tree was built in the last update
  double buildMs = 0;          ///< time of the last update, upload included [ms]
};

/// Every triangle of the scene in one bounding-volume hierarchy on the device, read by shaders/lib/trace.glsl. Two
/// levels: a tree of each block, and a top tree over the blocks. The device's bytes depend on the blocks of the last
/// update only, never on what came before. Render thread.
class SceneBvh {
 public:
  /// Makes the device's tables those of `blocks`. Only the blocks named in `changed` are read and rebuilt, with the
  /// top; all of them the first time and when their number differs. The buffers may be new ones afterwards. Waits for
  /// the device.
  /// Errors: "limit" (more triangles than a hierarchy counts, or than the device's texel buffers hold), "out-of-memory",
  /// "device-lost".
  Result<void> update(vk::Device& device, std::span<const TriangleBlock> blocks, std::span<const uint32_t> changed);

  /// Texel buffers for the bindings bvhNodes (BVH_NODE_SAMPLER) and bvhTriangles. Valid after the first update.
  const vk::Buffer& nodes() const { return m_nodes; }
  const vk::Buffer& triangles() const { return m_triangles; }
  const BvhStats& stats() const { return m_stats; }

 private:
  Result<void> store(vk::Device& device, const BvhTables& tables);

  BvhBuilder m_builder;
  std::vector<BvhBlock> m_blocks;
  vk::Buffer m_nodes;
  vk::Buffer m_triangles;
  BvhStats m_stats;
};

}  // namespace limn
