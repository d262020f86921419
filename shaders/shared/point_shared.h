// Points on all surfaces and the light they carry, as C++ and GLSL see them. [IPP §3.1, §4]
#ifndef LIMN_POINT_SHARED_H
#define LIMN_POINT_SHARED_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

// A point as gathers see it; two sides each. Side 0 is the one the geometric normal (of the winding) points to.
struct SurfacePoint {
  vec3 posR;         // [m], render space
  uint normal;       // geometric, unit, octahedral
};
LIMN_ASSERT_SIZE(SurfacePoint, 16);

// Where on its triangle a point sits: it moves with the triangle and reads its textures.
struct PointSite {
  uint triangle;      // global id
  vec2 barycentrics;  // weights of corners 1 and 2
};
LIMN_ASSERT_SIZE(PointSite, 12);

// Light that arrives at a point: irradiance / pi of each side [W·sr⁻¹·m⁻²], means over the passes so far.
struct PointLight {
  vec3 directFront;
  vec3 directBack;
  vec3 indirectFront;
  vec3 indirectBack;
};
LIMN_ASSERT_SIZE(PointLight, 48);

LIMN_CONST_UINT(kLobesPerPoint, 4u);

// Light from one direction, for the glossy reflection of a point.
struct PointLobe {
  uint dirToLight;   // unit, octahedral; its side of the normal tells the point's side
  uint irradiance;   // [W/m²], packRgbe
};

struct PointLobes {
  uint reflectance;  // at normal incidence, packRgbe
  float alpha;       // GGX alpha; 0: the point has no glossy lobe
  uint normal;       // shading, of side 0, normal maps applied; unit, octahedral
  PointLobe lobe[kLobesPerPoint];
};
LIMN_ASSERT_SIZE(PointLobes, 44);

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
