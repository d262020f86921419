#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace limn {

/// Where on a block of triangles a point sits.
struct BlockSite {
  uint32_t triangle = 0;         ///< of the block
  glm::vec2 barycentrics{0.0f};  ///< weights of corners 1 and 2
  bool operator==(const BlockSite&) const = default;
};

/// How many points a block gets: sets of `least` to `most` points are ready, as prefixes of one list, so that a small
/// change of another object's area does not resample this one.
struct CountClass {
  uint32_t least = 0, most = 0;
  bool operator==(const CountClass&) const = default;
};
/// The class `count` belongs to; most / least is about 1.19.
CountClass countClassOf(uint32_t count);

/// Blue-noise points on a rigid block, each of about equal area: `counts.most` sites of which every prefix of at least
/// `counts.least` is a Poisson-disk set with the distances of space. A pure function of its arguments; `corners` holds
/// 3 a triangle. Empty when the block has no finite area above zero. [IPP §4] by sample elimination [Yuksel 2015]
std::vector<BlockSite> sampleBlock(std::span<const glm::vec3> corners, CountClass counts, uint32_t seed);

/// Quality of a set: half the smallest distance of two sites against the radius of the densest packing of as many disks
/// on the block's area, sqrt(area / (2 sqrt(3) n)); 1 for a lattice, about 0.02 for random points, at most 1 here.
/// Sites on faces that look away from each other are not compared.
double relativeRadius(std::span<const glm::vec3> corners, std::span<const BlockSite> sites);

/// How badly sites sampled evenly on the triangles `sampled` fit the same triangles `placed`: the share of sites that
/// would have to go to another triangle for the density to be even there, half the sum of the differences of the
/// triangles' shares of area. 0 where all areas have grown by one factor, 1 where either has no area.
double misplacedShare(std::span<const glm::vec3> sampled, std::span<const glm::vec3> placed);

/// [unit of the corners, squared]; triangles whose area is not finite count as 0.
double areaOf(std::span<const glm::vec3> corners);

}  // namespace limn
