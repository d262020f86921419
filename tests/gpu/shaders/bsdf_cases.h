#ifndef LIMN_TEST_BSDF_CASES_H
#define LIMN_TEST_BSDF_CASES_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

LIMN_CONST_UINT(kRowBins, 24u);       // from the axis of the bins to its opposite
LIMN_CONST_UINT(kColumnBins, 24u);    // around it
LIMN_CONST_UINT(kBsdfSubdivisions, 24u);

LIMN_CONST_UINT(kBsdfSample, 0u);     // results of sampleBsdf, 3 vec4 each
LIMN_CONST_UINT(kBsdfIntegrate, 1u);  // of value and pdf over each bin
LIMN_CONST_UINT(kBsdfSwap, 2u);       // value for random pairs of directions, and with the two swapped

// A surface as makeSurface would give it, seen from woW.
struct BsdfCase {
  vec3 woW;
  vec3 geometricNormal;
  vec3 normal;
  vec3 clearcoatNormal;
  vec3 baseColor;
  vec3 specularColor;
  vec3 axis;             // unit, world; the bins' pole
  float concentration;   // rows are equal steps of ((1 - cos) / 2)^(1 / concentration)
  float metallic;
  float alpha;
  float transmission;
  float ior;
  float specular;
  float clearcoat;
  float clearcoatAlpha;
  uint frontFace;
  uint flags;
};

struct BsdfPush {
  uint mode;   // kBsdf...
  uint count;  // of invocations
  uint seed;
};

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
