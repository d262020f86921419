#include "renderer/visibility/bvh_build.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <new>

#include "renderer/base/check.hpp"

namespace limn {
namespace {

// What Embree's callbacks make, in Embree's own allocator: an inner node with two children, or a leaf (count > 0) with
// the indices of its boxes right behind it. The callbacks share nothing, so Embree may call them from any thread.
struct RawNode {
  RawNode* children[2];
  Box childBoxes[2];
  uint32_t count;

  uint32_t* items() { return reinterpret_cast<uint32_t*>(this + 1); }
};

Box fromEmbree(const RTCBounds& b) {
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

RawNode* allocateNode(RTCThreadLocalAllocator allocator, size_t itemCount) {
  void* memory = rtcThreadLocalAlloc(allocator, sizeof(RawNode) + itemCount * sizeof(uint32_t), 16);
  auto* node = new (memory) RawNode{};
  node->count = uint32_t(itemCount);
  return node;
}

void* createNode(RTCThreadLocalAllocator allocator, unsigned childCount, void*) {
  LIMN_CHECK_EQ(childCount, 2u);
  return allocateNode(allocator, 0);
}

void setChildren(void* node, void** children, unsigned, void*) {
  for (int i = 0; i < 2; ++i) static_cast<RawNode*>(node)->children[i] = static_cast<RawNode*>(children[i]);
}

void setBounds(void* node, const RTCBounds** bounds, unsigned, void*) {
  for (int i = 0; i < 2; ++i) static_cast<RawNode*>(node)->childBoxes[i] = fromEmbree(*bounds[i]);
}

void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count, void*) {
  RawNode* leaf = allocateNode(allocator, count);
  std::transform(primitives, primitives + count, leaf->items(), [](const RTCBuildPrimitive& p) { return p.primID; });
  std::sort(leaf->items(), leaf->items() + count);
  return leaf;
}

uint32_t flatten(RawNode& raw, const Box& box, BvhTree& tree) {
  const uint32_t index = uint32_t(tree.nodes.size());
  tree.nodes.push_back({box, 0, 0, 0, raw.count});
  if (raw.count > 0) {
    tree.nodes[index].first = uint32_t(tree.items.size());
    tree.items.insert(tree.items.end(), raw.items(), raw.items() + raw.count);
    return index;
  }
  const uint32_t left = flatten(*raw.children[0], raw.childBoxes[0], tree);
  const uint32_t right = flatten(*raw.children[1], raw.childBoxes[1], tree);
  tree.nodes[index].left = left;
  tree.nodes[index].right = right;
  return index;
}

}  // namespace

struct BvhBuilder::Embree {
  RTCDevice device = rtcNewDevice("threads=1");
  ~Embree() { rtcReleaseDevice(device); }
};

BvhBuilder::BvhBuilder() : m_embree(std::make_unique<Embree>()) { LIMN_CHECK(m_embree->device != nullptr); }
BvhBuilder::~BvhBuilder() = default;
BvhBuilder::BvhBuilder(BvhBuilder&&) noexcept = default;
BvhBuilder& BvhBuilder::operator=(BvhBuilder&&) noexcept = default;

BvhTree BvhBuilder::build(std::span<const Box> boxes, uint32_t maxLeafSize) const {
  BvhTree tree;
  if (boxes.empty()) return tree;

  std::vector<RTCBuildPrimitive> primitives(boxes.size());
  Box bounds;
  for (size_t i = 0; i < boxes.size(); ++i) {
    const Box& b = boxes[i];
    primitives[i] = {b.lower.x, b.lower.y, b.lower.z, 0, b.upper.x, b.upper.y, b.upper.z, uint32_t(i)};
    bounds.add(b);
  }

  RTCBVH bvh = rtcNewBVH(m_embree->device);
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.bvh = bvh;
  arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
  arguments.maxDepth = 64;
  arguments.maxLeafSize = maxLeafSize;
  arguments.primitives = primitives.data();
  arguments.primitiveCount = primitives.size();
  arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = createNode;
  arguments.setNodeChildren = setChildren;
  arguments.setNodeBounds = setBounds;
  arguments.createLeaf = createLeaf;
  auto* root = static_cast<RawNode*>(rtcBuildBVH(&arguments));
  LIMN_CHECK(root != nullptr);
  tree.nodes.reserve(2 * boxes.size());
  tree.items.reserve(boxes.size());
  flatten(*root, bounds, tree);
  rtcReleaseBVH(bvh);
  return tree;
}

}  // namespace limn
