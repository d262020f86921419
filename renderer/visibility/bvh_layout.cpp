#include "renderer/visibility/bvh_layout.hpp"

#include <algorithm>

namespace limn {
namespace {

using namespace shared;

// The node as it is when its tree's nodes 1, 2, ... start at `firstNode` and its triangles at `firstTriangle`.
BvhNode moved(BvhNode node, uint32_t firstNode, uint32_t firstTriangle) {
  node.childBase += firstNode - 1;
  node.triangleBase += firstTriangle;
  return node;
}

}  // namespace

BvhTables layOut(const WideBvh& top, std::span<const uint32_t> blockOfItem, std::span<const BvhBlock> blocks) {
  uint64_t nodeCount = top.nodes.size(), triangleTexels = 0;
  for (const uint32_t index : blockOfItem) {
    nodeCount += blocks[index].tree.nodes.size() - 1;
    triangleTexels += blocks[index].triangles.size();
  }

  BvhTables tables;
  tables.nodes.reserve(nodeCount);
  tables.nodes = top.nodes;
  tables.triangles.reserve(std::max<uint64_t>(triangleTexels, 1));
  std::vector<uint32_t> graftOfItem(blockOfItem.size());
  for (const WideBvh::Graft& graft : top.grafts) graftOfItem[graft.item] = graft.node;
  for (size_t item = 0; item < blockOfItem.size(); ++item) {
    const BvhBlock& block = blocks[blockOfItem[item]];
    const uint32_t firstNode = uint32_t(tables.nodes.size());
    const uint32_t firstTriangle = uint32_t(tables.triangles.size() / kBvhTriangleTexels);
    tables.nodes[graftOfItem[item]] = moved(block.tree.nodes[0], firstNode, firstTriangle);
    for (size_t i = 1; i < block.tree.nodes.size(); ++i) {
      tables.nodes.push_back(moved(block.tree.nodes[i], firstNode, firstTriangle));
    }
    tables.triangles.insert(tables.triangles.end(), block.triangles.begin(), block.triangles.end());
  }
  if (tables.triangles.empty()) tables.triangles.emplace_back(0.0f);
  return tables;
}

}  // namespace limn
