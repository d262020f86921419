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
  double relativeRadius = 1.0;   ///< of the smallest set of the class, on the surface it was sampled on
};

/// Sites of the rest pose ride along while no larger share of them would have to go to another triangle for an even
/// density, see misplacedShare(); beyond that the pose is sampled for itself.
constexpr double kMostMisplaced = 0.125;

/// Points of every block of a scene. A block is sampled in its own space under the rounded shape of its stretch, in its
/// rest pose if morph targets or a skin bend it: where it stands, how it is turned, how large it is and how it is bent
/// does not matter, and its points ride along, until its areas have changed much: kShapeStepsPerOctave, kMostMisplaced,
/// and the count that falls to it (CountClass). All of these are told from the state alone, never from what was before:
/// what comes out is a function of scene, count and seed, and what is kept from earlier calls saves time. [IPP §4]
class BlockSampling {
 public:
  /// Shares `count` points out by area (largest remainder) and samples the blocks that need it, on all cores. Gives how
  /// many were sampled. The sum of counts is `count`, or 0 in scenes without area.
  uint32_t update(const Scene& scene, const std::vector<gpu::GeometryBlock>& blocks,
                  const std::vector<glm::dmat4>& worldFromNodes, uint32_t count, uint32_t seed);

  const std::vector<BlockPoints>& blocks() const { return m_points; }

 private:
  /// Hashes of a primitive's triangles.
  struct Poses {
    uint64_t posed = 0, rest = 0;  ///< equal where nothing bends it
    bool operator==(const Poses&) const = default;
  };
  /// All that is asked about a block.
  struct Surface {
    Poses poses;
    glm::dmat3 stretch{0.0}, shape{0.0};  ///< both rounded
    uint32_t seed = 0;
    bool operator==(const Surface&) const = default;
  };
  /// What the points of a block depend on besides its count.
  struct Source {
    uint64_t triangles = 0;  ///< hash, of the pose that is sampled
    bool atRest = false;
    glm::dmat3 shape{0.0};
    uint32_t seed = 0;
    bool operator==(const Source&) const = default;
  };

  static Poses posesOf(const Primitive& primitive);
  bool measure(const Primitive& primitive, const Surface& surface, size_t block);

  std::vector<Surface> m_surfaces;
  std::vector<Source> m_sources;
  std::vector<double> m_areas;  ///< of the pose under the rounded stretch
  std::vector<BlockPoints> m_points;
};

/// Integers that add up to `count`, as near to the shares of `weights` as can be; all zero when no weight is above
/// zero. Equal remainders go to the first. [Hamilton's method]
std::vector<uint32_t> shareOut(uint32_t count, const std::vector<double>& weights);

}  // namespace limn
