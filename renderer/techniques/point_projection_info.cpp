#include "renderer/techniques/audit.hpp"
#include "renderer/techniques/point_projection.hpp"

namespace limn {

const TechniqueInfo& pointProjectionInfo() {
  using enum ParameterType;
  using enum CostClass;
  static const TechniqueInfo kInfo{
      "point-projection",
      "Importance-driven point projection",
      "Indirect light from lit surface points, gathered where the picture needs it; soon clean, a little biased.",
      true,
      {{"points", "Points on all surfaces", "points", integer, 16384, 1048576, 262144, rebuild},
       {"clusters", "Clusters that share an importance; rounded to a power of two", "clusters", integer, 64, 1024, 512, rebuild},
       {"projections", "Points projected at a gathered pixel", "points", integer, 512, 4096, 3072, regather},
       {"correctionRays", "Rays that correct what a gather's projections show; 0 is none", "rays", integer, 0, 256, 64, regather},
       {"microSize", "Side of the micro-buffer", "texels", integer, 8, 32, 32, relight},
       {"bounces", "Indirect bounces; 0 is direct light only", "bounces", integer, 0, 64, 32, relight},
       {"bouncePoints", "Points at which bounces are gathered; the others interpolate", "points", integer, 256, 65536, 16384, rebuild},
       {"paths", "Paths from either side of such a point at first, then four times as many; 0 gathers bounces by projection instead, one after the other", "paths", integer, 0, 256, 4, relight},
       {"relightSamples", "Shadow rays a point", "rays", integer, 1, 64, 4, relight},
       {"startGrid", "Distance of the first gathered pixels; rounded to a power of two", "pixels", integer, 2, 16, 16, regather},
       {"threshold", "Incoherence over which a pixel of the first level is gathered; doubles a level", "1", real, 0.0, 10.0, 0.3, regather},
       {"lambda", "Weight of radiance against geometry in the coherence metric", "1", real, 0.0, 100.0, 8.0, regather},
       {"filterSize", "Side of the joint bilateral filter; 1 is none", "pixels", integer, 1, 7, 7, regather},
       {"maxSamples", "Subpixel samples at which the picture is done", "samples", integer, 1, 65536, 1024, regather},
       auditShareInfo()}};
  return kInfo;
}

}  // namespace limn
