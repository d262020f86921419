#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace limn {

/// Sorts points into `clusters` (a power of two) groups of equal size by median splits: the longest axis first, then
/// the axes in turn; an axis along which a group is less than a quarter as long as along its longest is passed over, so
/// that flat groups are not cut for nothing. [IPP §3.2, §4] points.size() is a multiple of `clusters`. Gives point
/// indices cluster by cluster. Inside a cluster any first m are spread over it: Morton order in van der Corput's
/// sequence. Points in one place are told apart by their index, so the answer is a function of the positions alone.
std::vector<uint32_t> clusterPoints(std::span<const glm::vec3> points, uint32_t clusters);

}  // namespace limn
