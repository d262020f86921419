#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/visibility/bvh_wide.hpp"
#include "tests/gpu/bvh_scenes.hpp"

namespace limn::test {
namespace {

using namespace shared;

struct Walk {
  std::vector<uint32_t> itemUses;  // how often each item was reached
  uint32_t longestPath = 0;        // in nodes, what grafts stand for included
};

// Visits all nodes as the shader would; a graft counts as a tree of its item's height.
void visit(const WideBvh& wide, const std::vector<uint32_t>& heights, uint32_t index, uint32_t level, Walk& walk) {
  walk.longestPath = std::max(walk.longestPath, level);
  for (const WideBvh::Graft& graft : wide.grafts) {
    if (graft.node != index) continue;
    ++walk.itemUses[graft.item];
    walk.longestPath = std::max(walk.longestPath, level + heights[graft.item] - 1);
    return;
  }
  const BvhNode& node = wide.nodes[index];
  const uint32_t mask = node.childBase >> 24 | node.triangleBase >> 24 << 8;
  uint32_t item = node.triangleBase & kBvhBaseMask;
  for (uint32_t bit = 0; bit < 12; ++bit) {
    if (mask >> bit & 1) ++walk.itemUses[wide.items[item++]];
  }
  for (uint32_t i = 0; i < node.scaleExponents >> 24; ++i)
    visit(wide, heights, (node.childBase & kBvhBaseMask) + i, level + 1, walk);
}

// Boxes of very different sizes around one point: the surface-area heuristic peels them off one by one.
std::vector<Box> nestedBoxes(uint32_t count) {
  std::vector<Box> boxes(count);
  for (uint32_t i = 0; i < count; ++i) {
    const float size = std::pow(2.0f, 100.0f * float(i) / float(count) - 50);
    boxes[i] = {glm::vec3(-size), glm::vec3(size)};
  }
  return boxes;
}

class BvhTreeTest : public testing::TestWithParam<uint32_t> {};

TEST_P(BvhTreeTest, TrianglesAreLowAndComplete) {
  const uint32_t count = GetParam();
  const BvhBuilder builder;
  std::vector<Box> scattered(count);
  Random random(count);
  for (Box& box : scattered) {
    const glm::vec3 p = random.inCube();
    box = {p, p + glm::abs(random.inCube()) * 0.01f};
  }
  for (const std::vector<Box>& boxes : {scattered, nestedBoxes(count)}) {
    const WideBvh wide = widenTriangles(builder.build(boxes, 2), boxes);
    Walk walk{std::vector<uint32_t>(count), 0};
    visit(wide, {}, 0, 1, walk);
    EXPECT_EQ(walk.itemUses, std::vector<uint32_t>(count, 1));
    EXPECT_EQ(walk.longestPath, wide.height);
    EXPECT_LE(wide.height, 4 + std::max(1.0, std::ceil(std::log(count / 3.0) / std::log(4.0))));
  }
}

TEST_P(BvhTreeTest, TopsAreLowWhateverIsBelow) {
  const uint32_t count = GetParam();
  const BvhBuilder builder;
  const std::vector<Box> boxes = nestedBoxes(count);
  Random random(count);
  std::vector<uint32_t> heights(count);
  double weight = 0;
  for (uint32_t& height : heights) {
    height = 1 + random.below(8);
    weight += std::pow(4.0, height);
  }
  // Fill what is left of the room, so that there is no choice at all.
  for (uint32_t& height : heights) {
    while (weight + 3 * std::pow(4.0, height) <= std::pow(4.0, kBvhMaxHeight)) weight += 3 * std::pow(4.0, height++);
  }
  const WideBvh wide = widenTop(builder.build(boxes, 1), boxes, heights);
  Walk walk{std::vector<uint32_t>(count), 0};
  visit(wide, heights, 0, 1, walk);
  EXPECT_EQ(walk.itemUses, std::vector<uint32_t>(count, 1));
  EXPECT_LE(walk.longestPath, kBvhMaxHeight);
}

INSTANTIATE_TEST_SUITE_P(Counts, BvhTreeTest,
                         testing::Values(1u, 2u, 3u, 4u, 5u, 7u, 13u, 50u, 49u, 193u, 500u, 2000u));

}  // namespace
}  // namespace limn::test
