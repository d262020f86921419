#pragma once
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/cache/point_sampling.hpp"
#include "renderer/gpu/geometry.hpp"

namespace limn {

/// The points of one block, kept from update to update.
struct BlockPoints {
  std::vector<BlockSite> sites;  ///< of the whole class; the first `count` are in use
  uint32_t count = 0;
  double relativeRadius = 1.0;   ///< of the smallest set of the class; the others are about as good
};

/// Points of every block of a scene, sampled in the block's own space under its rounded stretch: where a block stands
/// and how it is turned does not matter. What comes out is a function of scene, count and seed alone; what is kept from
/// earlier calls saves time. [IPP §4]
class BlockSampling {
 public:
  /// Shares `count` points out by area (largest remainder) and samples the blocks that need it, on all cores. Gives how
  /// many were sampled. The sum of counts is `count`, or 0 in scenes without area.
  uint32_t update(const Scene& scene, const std::vector<gpu::GeometryBlock>& blocks,
                  const std::vector<glm::dmat4>& worldFromNodes, uint32_t count, uint32_t seed);

  const std::vector<BlockPoints>& blocks() const { return m_points; }

 private:
  /// What the points of a block depend on besides its count.
  struct Source {
    uint64_t shape = 0;  ///< hash of the primitive's positions and indices
    glm::dmat3 stretch{0.0};
    uint32_t seed = 0;
    bool operator==(const Source&) const = default;
  };

  std::vector<Source> m_sources;
  std::vector<double> m_areas;  ///< under the rounded stretch
  std::vector<BlockPoints> m_points;
};

/// Integers that add up to `count`, as near to the shares of `weights` as can be; all zero when no weight is above
/// zero. Equal remainders go to the first. [Hamilton's method]
std::vector<uint32_t> shareOut(uint32_t count, const std::vector<double>& weights);

}  // namespace limn
