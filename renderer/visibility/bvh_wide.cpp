#include "renderer/visibility/bvh_wide.hpp"

#include <algorithm>
#include <tuple>

#include "renderer/base/check.hpp"
#include "renderer/visibility/bvh_collapse.hpp"
#include "renderer/visibility/bvh_encode.hpp"

namespace limn {
namespace {

using namespace shared;

constexpr uint32_t kWidth = 4;
constexpr uint32_t kNoNode = ~0u;
constexpr uint32_t kSpareLevels = 4;

// Four to the power of `levels`: the smallest trees that fit below so many nodes on a path.
constexpr uint64_t room(uint32_t levels) { return uint64_t(1) << 2 * levels; }

// A subtree that is still to be written: a node of the binary tree, or (node == kNoNode) just a range of items.
struct Part {
  Box box;
  uint32_t node = kNoNode;
  uint32_t first = 0;
  uint32_t count = 0;
};

class Widener {
 public:
  /// `heights`: of the items of a top tree; empty for triangles.
  Widener(const BvhTree& tree, std::span<const Box> boxes, std::span<const uint32_t> heights)
      : m_tree(tree), m_boxes(boxes), m_heights(heights), m_items(tree.items), m_collapse(tree, leafSize()) {
    if (isTop()) {
      m_maxHeight = kBvhMaxHeight;
    } else {
      while (room(m_maxHeight) * kBvhLeafTriangles < boxes.size()) ++m_maxHeight;
      m_maxHeight += kSpareLevels;
    }
  }

  WideBvh run() {
    m_wide.nodes.emplace_back();
    if (m_tree.nodes.empty()) {
      m_wide.nodes[0] = encodeNode({}, {}, 0, 0, 0);
      m_wide.height = 1;
    } else {
      const Part root = partOf(0);
      LIMN_CHECK_LE(weight(root), room(m_maxHeight));
      if (isTop() && isLeaf(root)) graft(root, 0, 1);
      else write(root, 0, 1);
    }
    return std::move(m_wide);
  }

 private:
  bool isTop() const { return !m_heights.empty(); }
  uint32_t leafSize() const { return isTop() ? 1 : kBvhLeafTriangles; }

  // How much of a room() the items take: 4^height each in a top tree, else their share of a leaf.
  uint64_t weight(const Part& part) const {
    if (!isTop()) return (part.count + kBvhLeafTriangles - 1) / kBvhLeafTriangles;
    uint64_t sum = 0;
    for (uint32_t i = part.first; i < part.first + part.count; ++i) sum += room(m_heights[m_items[i]]);
    return sum;
  }

  Part partOf(uint32_t node) const {
    const auto [first, count] = m_collapse.items(node);
    return {m_tree.nodes[node].box, node, first, count};
  }

  bool isLeaf(const Part& part) const {
    return part.node == kNoNode ? part.count <= leafSize() : m_collapse.isLeaf(part.node);
  }

  std::vector<Part> openByCost(const Part& part) const {
    if (isLeaf(part)) return {part};
    std::vector<Part> parts;
    for (const uint32_t child : m_collapse.children(part.node)) parts.push_back(partOf(child));
    return parts;
  }

  // Sorts a range of items along its widest axis, in a top tree higher ones first; ties go by index.
  void sortItems(const Part& part) {
    const auto begin = m_items.begin() + part.first, end = begin + part.count;
    Box centers;
    auto center = [this](uint32_t item) { return m_boxes[item].lower * 0.5f + m_boxes[item].upper * 0.5f; };
    std::for_each(begin, end, [&](uint32_t item) { centers.add(center(item)); });
    const glm::vec3 extent = centers.upper - centers.lower;
    const int axis = extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
    auto key = [&](uint32_t item) { return std::tuple(isTop() ? ~m_heights[item] : 0u, center(item)[axis], item); };
    std::sort(begin, end, [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  }

  Part range(uint32_t first, uint32_t count) const {
    Part part{{}, kNoNode, first, count};
    for (uint32_t i = first; i < first + count; ++i) part.box.add(m_boxes[m_items[i]]);
    return part;
  }

  // Four parts of equal count, by halving twice.
  std::vector<Part> openByCount(const Part& part) {
    std::vector<Part> parts{part};
    for (int round = 0; round < 2; ++round) {
      std::vector<Part> halves;
      for (const Part& p : parts) {
        const uint32_t leftCount = p.count <= kBvhLeafTriangles ? p.count : (p.count + 1) / 2;
        if (leftCount < p.count) sortItems(p);
        halves.push_back(range(p.first, leftCount));
        if (leftCount < p.count) halves.push_back(range(p.first + leftCount, p.count - leftCount));
      }
      parts = std::move(halves);
    }
    return parts;
  }

  // At most four parts, each no heavier than the least room that four times holds them all. Weights are powers of four
  // and the heavy go first, so what is left of a part is always a multiple of the next weight, and parts fill without
  // a gap.
  std::vector<Part> openByWeight(const Part& part) {
    sortItems(part);
    uint64_t most = 1;
    while (most * kWidth < weight(part)) most *= kWidth;
    std::vector<Part> parts;
    for (uint32_t i = part.first; i < part.first + part.count;) {
      const uint32_t first = i;
      uint64_t sum = 0;
      while (i < part.first + part.count && sum + room(m_heights[m_items[i]]) <= most)
        sum += room(m_heights[m_items[i++]]);
      parts.push_back(range(first, i - first));
    }
    LIMN_CHECK_LE(parts.size(), size_t(kWidth));
    return parts;
  }

  // Writes the subtree of `part` with its root at `slot`, the level-th node of its path.
  void write(const Part& part, uint32_t slot, uint32_t level) {
    m_wide.height = std::max(m_wide.height, level);
    std::vector<Part> children;
    if (part.node != kNoNode) children = openByCost(part);
    auto fits = [&](const Part& p) { return weight(p) <= room(m_maxHeight - level); };
    if (part.node == kNoNode || !std::all_of(children.begin(), children.end(), fits)) {
      children = isTop() ? openByWeight(part) : openByCount(part);
    }
    auto isInner = [this](const Part& p) { return isTop() || !isLeaf(p); };
    std::stable_partition(children.begin(), children.end(), isInner);
    const uint32_t innerCount = uint32_t(std::count_if(children.begin(), children.end(), isInner));

    std::vector<EncodedChild> encoded;
    const uint32_t triangleBase = uint32_t(m_wide.items.size());
    for (const Part& child : children) {
      const bool inner = encoded.size() < innerCount;
      encoded.push_back({child.box, inner ? 0 : child.count});
      if (!inner)
        m_wide.items.insert(m_wide.items.end(), m_items.begin() + child.first,
                            m_items.begin() + child.first + child.count);
    }
    const uint32_t childBase = uint32_t(m_wide.nodes.size());
    m_wide.nodes.resize(childBase + innerCount);
    m_wide.nodes[slot] = encodeNode(part.box, encoded, innerCount, childBase, triangleBase);
    for (uint32_t i = 0; i < innerCount; ++i) {
      if (isTop() && isLeaf(children[i])) graft(children[i], childBase + i, level + 1);
      else write(children[i], childBase + i, level + 1);
    }
  }

  void graft(const Part& part, uint32_t slot, uint32_t level) {
    LIMN_CHECK_EQ(part.count, 1u);
    m_wide.height = std::max(m_wide.height, level);
    m_wide.grafts.push_back({slot, m_items[part.first]});
  }

  const BvhTree& m_tree;
  std::span<const Box> m_boxes;
  std::span<const uint32_t> m_heights;
  uint32_t m_maxHeight = 0;
  std::vector<uint32_t> m_items;
  BvhCollapse m_collapse;
  WideBvh m_wide;
};

}  // namespace

WideBvh widenTriangles(const BvhTree& tree, std::span<const Box> boxes) { return Widener(tree, boxes, {}).run(); }

WideBvh widenTop(const BvhTree& tree, std::span<const Box> boxes, std::span<const uint32_t> heights) {
  LIMN_CHECK_EQ(boxes.size(), heights.size());
  return Widener(tree, boxes, heights).run();
}

}  // namespace limn
