#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/visibility/bvh_build.hpp"

namespace limn {

/// A block's own tree and its triangles in the tree's order.
struct BvhBlock {
  BvhTree tree;                      ///< items index `triangles`
  std::vector<glm::vec4> triangles;  ///< kBvhTriangleTexels a triangle, as on the device
};

/// The bytes of the device's two texel buffers (shaders/shared/bvh_shared.h). Never empty.
struct BvhTables {
  std::vector<glm::uvec4> nodes;
  std::vector<glm::vec4> triangles;
  uint32_t nodeCount = 0;
};

/// `top` is a tree over the blocks that have triangles; `blockOfItem` names the block of each of its items.
BvhTables layOut(const BvhTree& top, std::span<const uint32_t> blockOfItem, std::span<const BvhBlock> blocks);

}  // namespace limn
