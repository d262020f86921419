#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/visibility/bvh_build.hpp"
#include "shaders/shared/bvh_shared.h"

namespace limn {

/// A tree of four-way nodes in the device's encoding. Bases count from this tree's own first node and first item.
struct WideBvh {
  /// A node that stands for an item of a top tree: its place is to be taken by the root of that item's own tree.
  struct Graft {
    uint32_t node = 0;
    uint32_t item = 0;
  };
  std::vector<shared::BvhNode> nodes;  ///< nodes[0] is the root; never empty
  std::vector<uint32_t> items;         ///< in the order in which triangle bases count; a box index each
  std::vector<Graft> grafts;           ///< top trees only
  uint32_t height = 0;                 ///< nodes on the longest path, grafts counted as one; 1 for the root alone
};

/// Leaves of at most kBvhLeafTriangles items. `tree` is over `boxes`; without nodes it gives a root that nothing hits.
/// The height is at most four more than `boxes.size()` triangles need: where the cheapest tree would go deeper, it is
/// split into equal shares.
WideBvh widenTriangles(const BvhTree& tree, std::span<const Box> boxes);

/// A top tree over trees of the given heights: every item becomes a Graft. An only item is the root itself. No path
/// has more than kBvhMaxHeight nodes, the item's own included; for widenTriangles' trees there always is such a tree,
/// as long as bases can count their triangles: the sum of 4^height is at most 4^kBvhMaxHeight.
WideBvh widenTop(const BvhTree& tree, std::span<const Box> boxes, std::span<const uint32_t> heights);

}  // namespace limn
