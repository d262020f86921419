#include "renderer/visibility/bvh.hpp"

#include <bit>
#include <numeric>

#include "renderer/base/clock.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bvh_shared.h"

namespace limn {
namespace {

using namespace shared;

constexpr uint32_t kMaxLeafTriangles = 4;

glm::vec4 withWord(const glm::vec3& v, uint32_t word) { return {v, std::bit_cast<float>(word)}; }

BvhBlock buildBlock(const BvhBuilder& builder, const TriangleBlock& source) {
  const size_t count = source.corners.size() / 3;
  std::vector<Box> boxes(count);
  for (size_t i = 0; i < 3 * count; ++i) boxes[i / 3].add(source.corners[i]);

  BvhBlock block;
  block.tree = builder.build(boxes, kMaxLeafTriangles);
  block.triangles.reserve(count * kBvhTriangleTexels);
  for (const uint32_t item : block.tree.items) {
    const glm::vec3* corners = &source.corners[3 * size_t(item)];
    const uint32_t id = (source.firstTriangle + item) | (source.alphaTested ? kBvhAlphaBit : 0u);
    block.triangles.push_back(withWord(corners[0], id));
    block.triangles.push_back({corners[1], 0});
    block.triangles.push_back({corners[2], 0});
  }
  return block;
}

}  // namespace

Result<void> SceneBvh::update(vk::Device& device, std::span<const TriangleBlock> blocks,
                              std::span<const uint32_t> changed) {
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
  for (uint32_t i = 0; i < m_blocks.size(); ++i) {
    if (m_blocks[i].tree.nodes.empty()) continue;
    boxes.push_back(m_blocks[i].tree.nodes[0].box);
    blockOfItem.push_back(i);
  }
  const BvhTables tables = layOut(m_builder.build(boxes, 1), blockOfItem, m_blocks);
  if (auto stored = store(device, tables); !stored) return stored;
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
  m_stats.nodes = tables.nodeCount;
  m_stats.triangles = uint32_t(tables.triangles.size() / kBvhTriangleTexels);
  m_stats.bytes = m_nodes.size() + m_triangles.size();
  return {};
}

}  // namespace limn
