#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/visibility/bvh_wide.hpp"

namespace limn {

/// A block's own tree and its triangles in the tree's order.
struct BvhBlock {
  Box box;                           ///< of its triangles; empty when it has none that can be hit
  WideBvh tree;                      ///< grafts are empty
  std::vector<glm::vec4> triangles;  ///< kBvhTriangleTexels a triangle, as on the device
};

/// The content of the device's two texel buffers (shaders/shared/bvh_shared.h). Never empty.
struct BvhTables {
  std::vector<shared::BvhNode> nodes;
  std::vector<glm::vec4> triangles;
};

/// Puts the blocks' trees under the top tree: the root, the top's nodes, then block after block. `blockOfItem` names
/// the block of each item of `top`.
BvhTables layOut(const WideBvh& top, std::span<const uint32_t> blockOfItem, std::span<const BvhBlock> blocks);

}  // namespace limn
