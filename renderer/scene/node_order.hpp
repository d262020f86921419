#pragma once
#include <cstdint>
#include <vector>

#include "renderer/scene/scene.hpp"

namespace limn {

/// Node indices so that every parent comes before its children. `nodes` must be a forest whose children and parents
/// agree.
std::vector<uint32_t> parentsFirst(const std::vector<Node>& nodes);

}  // namespace limn
