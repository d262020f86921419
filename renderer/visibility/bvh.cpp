#include "renderer/visibility/bvh.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <string>

#include "renderer/base/clock.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bvh_shared.h"

namespace limn {
namespace {

using namespace shared;

// Of the binary tree: smaller than what leaves can hold, so that BvhCollapse has a choice.
constexpr uint32_t kSmallLeaf = 2;

// Triangles without an area have no normal and cannot be hit. Differences and products of floats are exact enough in
// double for this to find all that lie on a line.
bool isDegenerate(const glm::vec3* c) {
  const glm::dvec3 normal = glm::cross(glm::dvec3(c[1]) - glm::dvec3(c[0]), glm::dvec3(c[2]) - glm::dvec3(c[0]));
  return normal == glm::dvec3(0.0);
}

glm::vec4 withWord(const glm::vec3& v, uint32_t word) { return {v, std::bit_cast<float>(word)}; }

uint64_t bytesOf(const BvhBlock& block) {
  return sizeof block + block.tree.nodes.size() * sizeof(BvhNode) + block.tree.items.size() * sizeof(uint32_t) +
         block.triangles.size() * sizeof(glm::vec4);
}

// Bases count nodes and triangles in 24 bits. Every node has two children or more, but for those of single triangles, so that
// there are at most as many nodes as triangles and blocks.
Result<void> checkCounts(std::span<const TriangleBlock> blocks) {
  uint64_t triangles = 0;
  for (const TriangleBlock& block : blocks) triangles += block.corners.size() / 3;
  if (triangles + blocks.size() <= kBvhBaseMask) return {};
  return Error{"limit", std::to_string(triangles) + " triangles in " + std::to_string(blocks.size()) + " objects are more than the " +
                            std::to_string(kBvhBaseMask) + " that a hierarchy counts", ""};
}

BvhBlock buildBlock(const BvhBuilder& builder, const TriangleBlock& source) {
  LIMN_CHECK_EQ(source.corners.size() % 3, 0u);
  BvhBlock block;
  std::vector<Box> boxes;
  std::vector<uint32_t> triangles;
  for (uint32_t i = 0; i < source.corners.size() / 3; ++i) {
    const glm::vec3* corners = &source.corners[3 * size_t(i)];
    if (isDegenerate(corners)) continue;
    Box& box = boxes.emplace_back();
    for (int k = 0; k < 3; ++k) box.add(corners[k]);
    block.box.add(box);
    triangles.push_back(i);
  }

  block.tree = widenTriangles(builder.build(boxes, kSmallLeaf), boxes);
  block.triangles.reserve(block.tree.items.size() * kBvhTriangleTexels);
  for (const uint32_t item : block.tree.items) {
    const glm::vec3* corners = &source.corners[3 * size_t(triangles[item])];
    const uint32_t id = source.firstTriangle + triangles[item];
    LIMN_CHECK_LE(id, ~kBvhAlphaBit);
    block.triangles.push_back(withWord(corners[0], source.alphaTested ? id | kBvhAlphaBit : id));
    block.triangles.push_back({corners[1], 0});
    block.triangles.push_back({corners[2], 0});
  }
  return block;
}

}  // namespace

Result<void> SceneBvh::update(vk::Device& device, std::span<const TriangleBlock> blocks,
                              std::span<const uint32_t> changed) {
  if (auto counted = checkCounts(blocks); !counted) return counted;
  const double start = nowSeconds();
  std::vector<uint32_t> rebuild(changed.begin(), changed.end());
  if (blocks.size() != m_blocks.size() || !m_nodes) {
    rebuild.resize(blocks.size());
    std::iota(rebuild.begin(), rebuild.end(), 0u);
    m_blocks.assign(blocks.size(), {});
  }
  for (const uint32_t index : rebuild) m_blocks[index] = buildBlock(m_builder, blocks[index]);

  std::vector<Box> boxes;
  std::vector<uint32_t> blockOfItem;
  std::vector<uint32_t> heights;
  for (uint32_t i = 0; i < m_blocks.size(); ++i) {
    if (m_blocks[i].triangles.empty()) continue;
    boxes.push_back(m_blocks[i].box);
    blockOfItem.push_back(i);
    heights.push_back(m_blocks[i].tree.height);
  }
  const WideBvh top = widenTop(m_builder.build(boxes, 1), boxes, heights);
  if (auto stored = store(device, layOut(top, blockOfItem, m_blocks)); !stored) return stored;
  m_stats.hostBytes = 0;
  for (const BvhBlock& block : m_blocks) m_stats.hostBytes += bytesOf(block);
  m_stats.blocksRebuilt = uint32_t(rebuild.size());
  m_stats.buildMs = (nowSeconds() - start) * 1e3;
  return {};
}

Result<void> SceneBvh::store(vk::Device& device, const BvhTables& tables) {
  auto put = [&](vk::Buffer& buffer, auto values, const char* name, VkFormat format) -> Result<void> {
    if (!buffer || buffer.size() != values.size_bytes()) {
      vk::BufferDesc desc{values.size_bytes(), vk::BufferUsage::texel, vk::MemoryKind::deviceLocal, name, "visibility",
                          format};
      auto created = vk::Buffer::create(device, desc);
      if (!created) return created.error();
      buffer = created.take();
    }
    return vk::uploadArray(device, buffer, values);
  };
  auto nodes = put(m_nodes, std::span(tables.nodes), "bvh.nodes", VK_FORMAT_R32G32B32A32_UINT);
  if (!nodes) return nodes;
  auto triangles = put(m_triangles, std::span(tables.triangles), "bvh.triangles", VK_FORMAT_R32G32B32A32_SFLOAT);
  if (!triangles) return triangles;
  m_stats.nodes = uint32_t(tables.nodes.size());
  m_stats.triangles = uint32_t(tables.triangles.size() / kBvhTriangleTexels);
  m_stats.bytes = m_nodes.size() + m_triangles.size();
  return {};
}

}  // namespace limn
