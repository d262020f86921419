#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

namespace limn {

/// Axis-aligned box [m], closed; empty until something was added.
struct Box {
  glm::vec3 lower{INFINITY};
  glm::vec3 upper{-INFINITY};

  void add(const glm::vec3& point) {
    lower = glm::min(lower, point);
    upper = glm::max(upper, point);
  }
  void add(const Box& box) {
    lower = glm::min(lower, box.lower);
    upper = glm::max(upper, box.upper);
  }
  float halfArea() const {
    const glm::vec3 e = upper - lower;
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
};

/// A binary tree over boxes. Children follow their parent; nodes[0] is the root; no nodes when there was nothing to
/// build over.
struct BvhTree {
  struct Node {
    Box box;
    uint32_t left = 0;   ///< inner node: index of the left child
    uint32_t right = 0;  ///< inner node: index of the right child
    uint32_t first = 0;  ///< leaf: first entry of `items`
    uint32_t count = 0;  ///< leaf: entries; 0 in an inner node
  };
  std::vector<Node> nodes;
  std::vector<uint32_t> items;  ///< indices of the input boxes, leaf after leaf
};

/// Builds trees by the surface-area heuristic with Embree, on the calling thread. The same boxes give the same tree.
class BvhBuilder {
 public:
  BvhBuilder();
  ~BvhBuilder();
  BvhBuilder(BvhBuilder&&) noexcept;
  BvhBuilder& operator=(BvhBuilder&&) noexcept;

  /// At most `maxLeafSize` (>= 1) boxes in a leaf. Boxes are finite and not empty.
  BvhTree build(std::span<const Box> boxes, uint32_t maxLeafSize) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> m_embree;
};

}  // namespace limn
