#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace limn {

/// A candidate on a surface inside the unit cube.
struct SurfaceCandidate {
  glm::vec3 position;
  glm::vec3 normal;  ///< unit; candidates whose normals part by more than about 100 degrees do not see each other
};

struct EliminationGoal {
  uint32_t most = 0, least = 0;  ///< points wanted; least <= most
  double maxRadius = 0.0;        ///< largest possible disk radius of `most` points on the surface's area
};

/// Weighted sample elimination [Yuksel 2015, "Sample Elimination for Generating Poisson Disk Sample Sets"]: takes away
/// the candidate most crowded by the rest, one by one, until `least` are left. Gives indices of `most` candidates such
/// that any prefix of at least `least` of them is a blue-noise set. Candidates that are crowded alike, within 1/1024 of
/// the most crowded one at the start, go in no particular but always the same order.
std::vector<uint32_t> eliminateSamples(std::span<const SurfaceCandidate> candidates, const EliminationGoal& goal);

/// Smallest distance between two candidates that see each other, at most `limit`.
double smallestDistance(std::span<const SurfaceCandidate> points, double limit);

}  // namespace limn
