#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "renderer/visibility/bvh_build.hpp"

namespace limn {

/// What a ray pays, in any unit: only the quotient matters. Measured on lavapipe.
struct TraversalCosts {
  float node = 1.0f;      ///< one four-way node
  float triangle = 0.6f;  ///< one triangle of a leaf
};

/// How a binary tree is best read as a tree of four-way nodes: by dynamic programming over the expected cost of a ray,
/// where every subtree may stand in its parent as one node, as one leaf, or as a forest of up to three [Ylitie et al.
/// 2017, section 3.1].
class BvhCollapse {
 public:
  /// `maxLeafSize`: items in a leaf at most, >= the largest leaf of `tree`. Keeps a reference to `tree`.
  BvhCollapse(const BvhTree& tree, uint32_t maxLeafSize, TraversalCosts costs = {});

  /// Whether this subtree is best a leaf. Always so for leaves of the binary tree.
  bool isLeaf(uint32_t node) const { return m_plans[node].leaf; }
  /// The subtrees that become the two to four children of `node`, left to right. Not for leaves.
  std::vector<uint32_t> children(uint32_t node) const;
  /// Items below `node`: first and count. They lie side by side in tree.items.
  std::pair<uint32_t, uint32_t> items(uint32_t node) const {
    return {m_plans[node].firstItem, m_plans[node].itemCount};
  }

 private:
  static constexpr uint32_t kWidth = 4;
  struct Plan {
    std::array<float, kWidth> cost{};    ///< [k - 1]: of the subtree as a forest of at most k
    std::array<uint8_t, kWidth> left{};  ///< [k - 1]: how many of the k are in the left child; 0: fewer are better
    uint32_t firstItem = 0;
    uint32_t itemCount = 0;
    bool leaf = false;
  };
  void collect(uint32_t node, uint32_t forest, std::vector<uint32_t>& out) const;

  const BvhTree& m_tree;
  std::vector<Plan> m_plans;
};

}  // namespace limn
