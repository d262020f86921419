#ifndef LIMN_TEST_LIGHTS_H
#define LIMN_TEST_LIGHTS_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

LIMN_CONST_UINT(kEnvironmentRows, 32u);
LIMN_CONST_UINT(kEnvironmentColumns, 64u);
LIMN_CONST_UINT(kBinPoints, 16u);

LIMN_CONST_UINT(kLightsChoose, 0u);       // light, its probability, what is left of the numbers
LIMN_CONST_UINT(kLightsTriangle, 1u);     // direction, distance; radiance over pdf, pdf
LIMN_CONST_UINT(kLightsEnvironment, 2u);  // uv, pdf of the sampler, pdf of its direction; radiance, y of the direction
LIMN_CONST_UINT(kLightsMass, 3u);         // probability of each bin of the sphere
LIMN_CONST_UINT(kLightsTriangleEvenly, 4u);     // as kLightsTriangle
LIMN_CONST_UINT(kLightsSphericalTriangle, 5u);  // direction, solid angle; of the triangle push.light of the scene

struct LightsPush {
  vec3 posR;
  uint light;
  uint mode;
  uint count;
  uint seed;
};

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
