#include "renderer/visibility/acceleration_structure.hpp"

#include <numeric>

#include "renderer/vk/transfer.hpp"

namespace limn {
namespace {

constexpr uint64_t kMaxCustomIndex = 0xffffff;

template <class T>
Result<vk::Buffer> inputBuffer(vk::Device& device, std::span<const T> values, const char* name) {
  vk::BufferDesc desc{values.size_bytes(), vk::BufferUsage::accelerationInput, vk::MemoryKind::deviceLocal, name,
                      "visibility"};
  return vk::createBufferWith(device, desc, values);
}

}  // namespace

Result<SceneAcceleration::Block> SceneAcceleration::buildBlock(vk::Device& device, const TriangleBlock& source) {
  Block block;
  block.firstTriangle = source.firstTriangle;
  if (source.corners.empty()) return block;
  if (source.firstTriangle > kMaxCustomIndex) {
    return Error{"limit", "the scene has more than 16 million triangles in its acceleration structure", ""};
  }
  std::vector<uint32_t> order(source.corners.size());
  std::iota(order.begin(), order.end(), 0u);
  auto positions = inputBuffer(device, source.corners, "acceleration.positions");
  if (!positions) return positions.error();
  auto indices = inputBuffer(device, std::span<const uint32_t>(order), "acceleration.indices");
  if (!indices) return indices.error();

  vk::TriangleGeometry geometry;
  geometry.positions = &*positions;
  geometry.vertexCount = uint32_t(source.corners.size());
  geometry.indices = &*indices;
  geometry.triangleCount = uint32_t(source.corners.size() / 3);
  geometry.opaque = !source.alphaTested;
  auto tree =
      vk::AccelerationStructure::fromTriangles(device, std::span(&geometry, 1), "acceleration.block", "visibility");
  if (!tree) return tree.error();
  block.tree = tree.take();
  return block;
}

Result<void> SceneAcceleration::update(vk::Device& device, std::span<const TriangleBlock> blocks,
                                       std::span<const uint32_t> changed) {
  std::vector<uint32_t> rebuild(changed.begin(), changed.end());
  if (blocks.size() != m_blocks.size() || !m_top) {
    rebuild.resize(blocks.size());
    std::iota(rebuild.begin(), rebuild.end(), 0u);
    m_blocks = std::vector<Block>(blocks.size());
  }
  for (const uint32_t index : rebuild) {
    auto block = buildBlock(device, blocks[index]);
    if (!block) return block.error();
    m_blocks[index] = block.take();
  }

  std::vector<vk::AccelerationInstance> instances;
  for (const Block& block : m_blocks) {
    if (!block.tree) continue;
    vk::AccelerationInstance& instance = instances.emplace_back();
    instance.customIndex = block.firstTriangle;
    instance.geometry = &block.tree;
  }
  auto top = vk::AccelerationStructure::fromInstances(device, instances, "acceleration.top", "visibility");
  if (!top) return top.error();
  m_top = top.take();
  m_blocksRebuilt = uint32_t(rebuild.size());
  return {};
}

}  // namespace limn
