#include "renderer/visibility/bvh_wide.hpp"

#include <algorithm>
#include <numeric>

#include "renderer/base/check.hpp"
#include "renderer/visibility/bvh_encode.hpp"

namespace limn {
namespace {

using namespace shared;

constexpr uint32_t kWidth = 4;
constexpr uint32_t kNoNode = ~0u;

// Levels of four-way nodes that `items` need at least.
uint32_t levelsNeeded(uint64_t items, uint64_t leafSize) {
  uint32_t levels = 1;
  for (uint64_t room = kWidth * leafSize; room < items; room *= kWidth) ++levels;
  return levels;
}

// A subtree that is still to be written: a node of the binary tree, or (node == kNoNode) just a range of items.
struct Part {
  Box box;
  uint32_t node = kNoNode;
  uint32_t first = 0;
  uint32_t count = 0;
};

class Widener {
 public:
  Widener(const BvhTree& tree, std::span<const Box> boxes, bool top, uint32_t maxHeight)
      : m_tree(tree), m_boxes(boxes), m_top(top), m_maxHeight(maxHeight), m_items(tree.items), m_ends(tree.nodes.size()) {
    // Children follow their parent, and so do their items.
    for (size_t i = tree.nodes.size(); i-- > 0;) {
      const BvhTree::Node& node = tree.nodes[i];
      m_ends[i] = node.count > 0 ? node.first + node.count : m_ends[node.right];
    }
  }

  WideBvh run() {
    m_wide.nodes.emplace_back();
    if (m_tree.nodes.empty()) {
      m_wide.nodes[0] = encodeNode({}, {}, 0, 0, 0);
      m_wide.height = 1;
    } else {
      const Part root = partOf(0);
      if (m_top && isLeaf(root)) graft(root, 0, 1);
      else write(root, 0, 1);
    }
    return std::move(m_wide);
  }

 private:
  uint32_t leafSize() const { return m_top ? 1 : kBvhLeafTriangles; }

  Part partOf(uint32_t node) const {
    uint32_t leftmost = node;
    while (m_tree.nodes[leftmost].count == 0) leftmost = m_tree.nodes[leftmost].left;
    const uint32_t first = m_tree.nodes[leftmost].first;
    return {m_tree.nodes[node].box, node, first, m_ends[node] - first};
  }

  bool isLeaf(const Part& part) const {
    return part.node == kNoNode ? part.count <= leafSize() : m_tree.nodes[part.node].count > 0;
  }

  // Opens the child of the largest area until there are four.
  std::vector<Part> openBySurface(const Part& part) const {
    std::vector<Part> parts{part};
    while (parts.size() < kWidth) {
      auto widest = parts.end();
      for (auto it = parts.begin(); it != parts.end(); ++it) {
        if (!isLeaf(*it) && (widest == parts.end() || it->box.halfArea() > widest->box.halfArea())) widest = it;
      }
      if (widest == parts.end()) break;
      const BvhTree::Node& node = m_tree.nodes[widest->node];
      *widest = partOf(node.left);
      parts.push_back(partOf(node.right));
    }
    return parts;
  }

  // Halves a range of items across its widest axis; ties go by index, so that the order of the input does not matter.
  std::pair<Part, Part> halve(const Part& part) {
    const auto begin = m_items.begin() + part.first, end = begin + part.count, middle = begin + (part.count + 1) / 2;
    Box centers;
    auto center = [this](uint32_t item) { return m_boxes[item].lower * 0.5f + m_boxes[item].upper * 0.5f; };
    std::for_each(begin, end, [&](uint32_t item) { centers.add(center(item)); });
    const glm::vec3 extent = centers.upper - centers.lower;
    const int axis = extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
    std::sort(begin, end, [&](uint32_t a, uint32_t b) {
      return std::pair(center(a)[axis], a) < std::pair(center(b)[axis], b);
    });
    auto range = [this](auto from, auto to) {
      Part half{{}, kNoNode, uint32_t(from - m_items.begin()), uint32_t(to - from)};
      std::for_each(from, to, [&](uint32_t item) { half.box.add(m_boxes[item]); });
      return half;
    };
    return {range(begin, middle), range(middle, end)};
  }

  std::vector<Part> openByCount(const Part& part) {
    std::vector<Part> parts{part};
    for (int round = 0; round < 2; ++round) {
      std::vector<Part> halves;
      for (const Part& p : parts) {
        if (p.count <= leafSize()) {
          halves.push_back({p.box, kNoNode, p.first, p.count});
          continue;
        }
        auto [left, right] = halve(p);
        halves.push_back(left);
        halves.push_back(right);
      }
      parts = std::move(halves);
    }
    return parts;
  }

  // Writes the subtree of `part` with its root at `slot`, the level-th node of its path.
  void write(const Part& part, uint32_t slot, uint32_t level) {
    m_wide.height = std::max(m_wide.height, level);
    const uint32_t highest = m_top ? m_maxHeight - 1 : m_maxHeight;  // below a top's nodes come its grafts
    const uint32_t roomLeft = highest > level ? highest - level + 1 : 1;
    const bool equalShares = part.node == kNoNode || levelsNeeded(part.count, leafSize()) >= roomLeft;
    std::vector<Part> children = equalShares ? openByCount(part) : openBySurface(part);
    auto isInner = [this](const Part& p) { return m_top || !isLeaf(p); };
    std::stable_partition(children.begin(), children.end(), isInner);
    const uint32_t innerCount = uint32_t(std::count_if(children.begin(), children.end(), isInner));

    std::vector<EncodedChild> encoded;
    const uint32_t triangleBase = uint32_t(m_wide.items.size());
    for (const Part& child : children) {
      const bool inner = encoded.size() < innerCount;
      encoded.push_back({child.box, inner ? 0 : child.count});
      if (!inner) m_wide.items.insert(m_wide.items.end(), m_items.begin() + child.first, m_items.begin() + child.first + child.count);
    }
    const uint32_t childBase = uint32_t(m_wide.nodes.size());
    m_wide.nodes.resize(childBase + innerCount);
    m_wide.nodes[slot] = encodeNode(part.box, encoded, innerCount, childBase, triangleBase);
    for (uint32_t i = 0; i < innerCount; ++i) {
      if (m_top && isLeaf(children[i])) graft(children[i], childBase + i, level + 1);
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
  bool m_top;
  uint32_t m_maxHeight;
  std::vector<uint32_t> m_items;
  std::vector<uint32_t> m_ends;  // of each binary node's items
  WideBvh m_wide;
};

}  // namespace

WideBvh widenTriangles(const BvhTree& tree, std::span<const Box> boxes, uint32_t maxHeight) {
  return Widener(tree, boxes, false, maxHeight).run();
}

WideBvh widenTop(const BvhTree& tree, std::span<const Box> boxes, uint32_t maxHeight) {
  return Widener(tree, boxes, true, maxHeight).run();
}

}  // namespace limn
