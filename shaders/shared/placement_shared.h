// Which pixels gather, and how the others are reconstructed, as C++ and GLSL see it. [IPP §3.3]
#ifndef LIMN_PLACEMENT_SHARED_H
#define LIMN_PLACEMENT_SHARED_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

// What SelectSitesPush.rule lists.
LIMN_CONST_UINT(kSelectGrid, 0u);        // every pixel of the grid of `stride`
LIMN_CONST_UINT(kSelectIncoherent, 1u);  // those of that grid that are not sampled and whose coherence metric is over `threshold`
LIMN_CONST_UINT(kSelectUnsampled, 2u);   // those of [first, first + candidates) in scattered order that are not sampled
LIMN_CONST_UINT(kSelectScattered, 3u);   // all of those

LIMN_CONST_UINT(kPlacementGroup, 256u);  // candidates of a workgroup

struct SelectSitesPush {
  uint width;           // [pixel]
  uint height;          // [pixel]
  uint rule;            // kSelect...
  uint stage;           // 0: count each workgroup, 1: place them, 2: write the list; 3: sum luminance of the sampled candidates
  uint stride;          // [pixel] of the grid
  uint first;           // of the scattered order
  uint candidates;
  float threshold;      // of the coherence metric
  float lambda;         // weight of radiance in it
  float inverseExtent;  // [1/m] 2 / diagonal of the scene's bounding box
  float inverseLuminance;  // over what radiance differences are measured
};
LIMN_ASSERT_SIZE(SelectSitesPush, 44);

struct ReconstructPush {
  uint width;    // [pixel]
  uint height;   // [pixel]
  uint stride;   // [pixel] of the grid that is filled; its parents lie on the grid of twice that
  uint reach;    // of the filter [pixel]: 1 for 3x3, 3 for 7x7
  uint firstRow; // rows of the grid, or of the picture, done by this dispatch
  uint rows;
};
LIMN_ASSERT_SIZE(ReconstructPush, 24);

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
