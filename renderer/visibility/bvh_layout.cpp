#include "renderer/visibility/bvh_layout.hpp"

#include <bit>

#include "renderer/base/check.hpp"
#include "shaders/shared/bvh_shared.h"

namespace limn {
namespace {

using namespace shared;

// Writes trees depth first: a node's first child follows it, its skip link is where its subtree ends.
class SkipListWriter {
 public:
  SkipListWriter(std::span<const BvhBlock> blocks, std::span<const uint32_t> blockOfItem, BvhTables& tables)
      : m_blocks(blocks), m_blockOfItem(blockOfItem), m_tables(tables) {}

  void writeTop(const BvhTree& top, uint32_t index) {
    const BvhTree::Node& node = top.nodes[index];
    if (node.count > 0) {
      LIMN_CHECK_EQ(node.count, 1u);
      return writeBlock(m_blocks[m_blockOfItem[top.items[node.first]]]);
    }
    const uint32_t slot = open(node.box);
    writeTop(top, node.left);
    writeTop(top, node.right);
    close(slot, 0);
  }

 private:
  void writeBlock(const BvhBlock& block) {
    const uint32_t firstTriangle = uint32_t(m_tables.triangles.size() / kBvhTriangleTexels);
    m_tables.triangles.insert(m_tables.triangles.end(), block.triangles.begin(), block.triangles.end());
    writeNode(block.tree, 0, firstTriangle);
  }

  void writeNode(const BvhTree& tree, uint32_t index, uint32_t firstTriangle) {
    const BvhTree::Node& node = tree.nodes[index];
    const uint32_t slot = open(node.box);
    if (node.count > 0) return close(slot, ((firstTriangle + node.first) << kBvhLeafCountBits) | node.count);
    writeNode(tree, node.left, firstTriangle);
    writeNode(tree, node.right, firstTriangle);
    close(slot, 0);
  }

  uint32_t open(const Box& box) {
    const glm::vec3 pad = glm::max(glm::abs(box.lower), glm::abs(box.upper)) * 1e-6f;
    const glm::uvec3 lower = glm::floatBitsToUint(box.lower - pad);
    const glm::uvec3 upper = glm::floatBitsToUint(box.upper + pad);
    m_tables.nodes.push_back({lower, 0});
    m_tables.nodes.push_back({upper, 0});
    return m_tables.nodeCount++;
  }

  void close(uint32_t slot, uint32_t leaf) {
    glm::uvec4* node = &m_tables.nodes[kBvhHeaderTexels + slot * kBvhNodeTexels];
    node[0].w = m_tables.nodeCount;
    node[1].w = leaf;
  }

  std::span<const BvhBlock> m_blocks;
  std::span<const uint32_t> m_blockOfItem;
  BvhTables& m_tables;
};

}  // namespace

BvhTables layOut(const BvhTree& top, std::span<const uint32_t> blockOfItem, std::span<const BvhBlock> blocks) {
  BvhTables tables;
  tables.nodes.emplace_back(0);
  if (!top.nodes.empty()) SkipListWriter(blocks, blockOfItem, tables).writeTop(top, 0);
  if (tables.triangles.empty()) tables.triangles.emplace_back(0.0f);
  tables.nodes[0].x = tables.nodeCount;
  return tables;
}

}  // namespace limn
