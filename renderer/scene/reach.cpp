#include "renderer/scene/reach.hpp"

#include <map>

#include "renderer/scene/node_order.hpp"

namespace limn {
namespace {

constexpr size_t kNoEdit = size_t(-1);

/// A node's transform as the batch leaves it, and the last edit of it.
struct Moved {
  Transform parentFromLocal;
  size_t edit = kNoEdit;
};

std::map<uint32_t, Moved> movedNodes(const Scene& scene, std::span<const Edit> batch) {
  std::map<uint32_t, Moved> moved;
  for (size_t i = 0; i < batch.size(); ++i) {
    const auto* edit = std::get_if<SetNodeTransform>(&batch[i]);
    if (!edit) continue;
    Moved& node = moved.try_emplace(edit->node, Moved{scene.nodes[edit->node].parentFromLocal}).first->second;
    change(node.parentFromLocal, *edit);
    node.edit = i;
  }
  return moved;
}

bool reaches(const Scene& scene, const Node& node, const glm::dmat4& worldFromNode) {
  if (!withinReach(worldFromNode)) return false;
  return node.mesh == kNone || withinReach(worldBounds(scene.meshes[size_t(node.mesh)], worldFromNode));
}

}  // namespace

bool withinReach(const glm::dmat4& worldFromNode) {
  for (int column = 0; column < 4; ++column)
    if (!(glm::length(glm::dvec3(worldFromNode[column])) <= kFarthest)) return false;
  return true;
}

bool withinReach(const Bounds& bounds) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(bounds.low[axis] >= -kFarthest && bounds.high[axis] <= kFarthest)) return false;
  return true;
}

Result<void> validateReach(const Scene& scene, std::span<const Edit> batch) {
  const std::map<uint32_t, Moved> moved = movedNodes(scene, batch);
  if (moved.empty()) return {};
  std::vector<glm::dmat4> world(scene.nodes.size(), glm::dmat4(1.0));
  std::vector<size_t> movedBy(scene.nodes.size(), kNoEdit);
  for (const uint32_t i : parentsFirst(scene.nodes)) {
    const Node& node = scene.nodes[i];
    if (node.parent != kNone) world[i] = world[size_t(node.parent)], movedBy[i] = movedBy[size_t(node.parent)];
    const auto own = moved.find(i);
    if (own != moved.end()) movedBy[i] = own->second.edit;
    world[i] *= (own == moved.end() ? node.parentFromLocal : own->second.parentFromLocal).toMatrix();
    if (movedBy[i] != kNoEdit && !reaches(scene, node, world[i]))
      return Error{"out-of-range", "node " + std::to_string(i) + " would reach farther than 1e15 m from the origin",
                   "/edits/" + std::to_string(movedBy[i])};
  }
  return {};
}

}  // namespace limn
