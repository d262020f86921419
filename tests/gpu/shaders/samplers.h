#ifndef LIMN_TEST_SAMPLERS_H
#define LIMN_TEST_SAMPLERS_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

LIMN_CONST_UINT(kSamplerCosine, 0u);
LIMN_CONST_UINT(kSamplerSphere, 1u);
LIMN_CONST_UINT(kSamplerDisk, 2u);
LIMN_CONST_UINT(kSamplerTriangle, 3u);
LIMN_CONST_UINT(kSamplerVisibleNormal, 4u);

LIMN_CONST_UINT(kThetaBins, 16u);
LIMN_CONST_UINT(kPhiBins, 32u);
LIMN_CONST_UINT(kSubdivisions, 32u);  // points of a bin's edge at which its density is taken

struct SamplersPush {
  vec3 wo;         // unit, about +z
  float alpha;
  uint kind;       // kSampler...
  uint integrate;  // 1: mass of each bin, 0: points
  uint count;      // bins or points
  uint seed;
};

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
