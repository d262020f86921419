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
  uint32_t height = 0;                 ///< nodes on the longest path; 1 for the root alone
};

/// Leaves of at most kBvhLeafTriangles items. `tree` is over `boxes`; without nodes it gives a root that nothing hits. Where the
/// surface-area heuristic would go deeper than `maxHeight` nodes, the rest is split into equal shares; a tree over more than
/// 3 * 4^maxHeight items cannot be that low, and is as low as it can be.
WideBvh widenTriangles(const BvhTree& tree, std::span<const Box> boxes, uint32_t maxHeight);

/// A top tree: every item becomes a Graft. Heights count grafts as nodes. An only item is the root itself.
WideBvh widenTop(const BvhTree& tree, std::span<const Box> boxes, uint32_t maxHeight);

}  // namespace limn
