#include "renderer/visibility/bvh_collapse.hpp"

#include <algorithm>

#include "renderer/base/check.hpp"

namespace limn {

BvhCollapse::BvhCollapse(const BvhTree& tree, uint32_t maxLeafSize, TraversalCosts costs)
    : m_tree(tree), m_plans(tree.nodes.size()) {
  // Children follow their parent, so the last node comes first.
  for (size_t i = tree.nodes.size(); i-- > 0;) {
    const BvhTree::Node& node = tree.nodes[i];
    Plan& plan = m_plans[i];
    const float area = node.box.halfArea();
    if (node.count > 0) {
      plan.firstItem = node.first;
      plan.itemCount = node.count;
      plan.leaf = true;
      plan.cost.fill(area * costs.triangle * float(node.count));
      continue;
    }
    const Plan &left = m_plans[node.left], &right = m_plans[node.right];
    plan.firstItem = left.firstItem;
    plan.itemCount = left.itemCount + right.itemCount;

    // The cheapest way to be k subtrees, i of them in the left child; k = 4 is what a node of its own would have as
    // children.
    std::array<float, kWidth> forest{};
    for (uint32_t k = 2; k <= kWidth; ++k) {
      forest[k - 1] = INFINITY;
      for (uint32_t i1 = 1; i1 < k; ++i1) {
        const float cost = left.cost[i1 - 1] + right.cost[k - i1 - 1];
        if (cost >= forest[k - 1]) continue;
        forest[k - 1] = cost;
        plan.left[k - 1] = uint8_t(i1);
      }
    }
    const float asNode = area * costs.node + forest[kWidth - 1];
    const float asLeaf = plan.itemCount <= maxLeafSize ? area * costs.triangle * float(plan.itemCount) : INFINITY;
    plan.leaf = asLeaf <= asNode;
    plan.cost[0] = std::min(asLeaf, asNode);
    plan.left[0] = plan.left[kWidth - 1];
    for (uint32_t k = 2; k <= kWidth; ++k) {
      const bool fewer = plan.cost[k - 2] <= forest[k - 1];
      plan.cost[k - 1] = fewer ? plan.cost[k - 2] : forest[k - 1];
      if (fewer) plan.left[k - 1] = 0;
    }
  }
}

std::vector<uint32_t> BvhCollapse::children(uint32_t node) const {
  LIMN_CHECK(!isLeaf(node));
  std::vector<uint32_t> result;
  const uint32_t inLeft = m_plans[node].left[0];  // of a node of its own, see the constructor
  collect(m_tree.nodes[node].left, inLeft, result);
  collect(m_tree.nodes[node].right, kWidth - inLeft, result);
  return result;
}

void BvhCollapse::collect(uint32_t node, uint32_t forest, std::vector<uint32_t>& out) const {
  const Plan& plan = m_plans[node];
  while (forest > 1 && (plan.leaf || plan.left[forest - 1] == 0)) --forest;
  if (forest == 1) return out.push_back(node);
  const uint32_t inLeft = plan.left[forest - 1];
  collect(m_tree.nodes[node].left, inLeft, out);
  collect(m_tree.nodes[node].right, forest - inLeft, out);
}

}  // namespace limn
