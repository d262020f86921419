#pragma once
#include <span>

#include "renderer/base/result.hpp"
#include "renderer/scene/edit.hpp"

namespace limn {

constexpr double kFarthest = 1e15;  ///< [m], of places and sizes; beyond it double has lost the millimetre and float its squares

/// Whether a node's place and the size of its axes are within kFarthest.
bool withinReach(const glm::dmat4& worldFromNode);
/// On every axis.
bool withinReach(const Bounds& bounds);

/// Checks where a batch, whose edits are valid one by one, leaves what it moves: transforms multiply along a chain of nodes.
/// Error::place is the edit nearest above the node that would lie too far out, "/edits/N".
Result<void> validateReach(const Scene& scene, std::span<const Edit> batch);

}  // namespace limn
