#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/visibility/bvh.hpp"
#include "renderer/vk/acceleration_structure.hpp"

namespace limn {

/// The scene's triangles in the device's own acceleration structures, for shaders/lib/trace_ray_query.glsl: what
/// SceneBvh is to trace_walk.glsl. Only for devices with hasRayQuery(). Render thread.
class SceneAcceleration {
 public:
  /// As SceneBvh::update. Errors: "limit" (a triangle id over 24 bits), and those of vk::AccelerationStructure.
  Result<void> update(vk::Device& device, std::span<const TriangleBlock> blocks, std::span<const uint32_t> changed);

  /// For the binding bvhAcceleration. Valid after the first update.
  const vk::AccelerationStructure& top() const { return m_top; }
  /// Blocks whose own tree was built in the last update.
  uint32_t blocksRebuilt() const { return m_blocksRebuilt; }

 private:
  struct Block {
    vk::AccelerationStructure tree;  ///< null for a block without triangles
    uint32_t firstTriangle = 0;
  };
  static Result<Block> buildBlock(vk::Device& device, const TriangleBlock& source);

  std::vector<Block> m_blocks;
  vk::AccelerationStructure m_top;
  uint32_t m_blocksRebuilt = 0;
};

}  // namespace limn
