// What gathers read and write, as C++ and GLSL see it.
#ifndef LIMN_GATHER_SHARED_H
#define LIMN_GATHER_SHARED_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

// GGX alpha below which a lobe is too sharp for splats and is traced by rays. [IPP §6: Phong exponents under 50]
LIMN_CONST_FLOAT(kSplatAlpha, 0.2f);

// What a pixel sees, and where its light is gathered.
struct GatherSite {
  vec3 posR;          // [m], render space
  uint normal;        // shading, unit, towards the viewer, octahedral
  uint triangle;      // global id; kNoIndex where the pixel sees no surface that gathers
  vec2 barycentrics;  // weights of corners 1 and 2
  uint object;        // material: tells touching objects apart
};
LIMN_ASSERT_SIZE(GatherSite, 32);

// IndirectTexel.state
LIMN_CONST_FLOAT(kIndirectNone, 0.0f);
LIMN_CONST_FLOAT(kIndirectInterpolated, 1.0f);
LIMN_CONST_FLOAT(kIndirectSampled, 2.0f);

// IndirectTexel.count of interpolated light that should be gathered.
LIMN_CONST_FLOAT(kCountFar, -1.0f);      // it comes from this surface, but not from close by
LIMN_CONST_FLOAT(kCountGuessed, -2.0f);  // it comes from other surfaces, as nothing else is there; others do not use it

// Indirect light at a pixel, kept free of the surface's colours so that textures stay sharp. [IPP §4, Microbuffers]
struct IndirectTexel {
  vec3 diffuse;   // irradiance / pi [W·sr⁻¹·m⁻²]; times the diffuse albedo it is radiance
  float count;    // gathers averaged; 0 when interpolated, or kCount...
  vec3 glossy;    // reflected by rough glossy lobes, over the reflectance at normal incidence
  float state;    // kIndirect...
};
LIMN_ASSERT_SIZE(IndirectTexel, 32);

struct GatherSitesPush {
  uint firstEntry;  // of the pixel list
  uint entryCount;
  uint seed;
};
LIMN_ASSERT_SIZE(GatherSitesPush, 12);

// One dispatch of gathers by point projection; one workgroup a site.
struct PointProjectionPush {
  uint firstEntry;     // of the site list
  uint entryCount;     // sites of this dispatch
  uint seed;
  uint round;          // which gather at its site this is: other random numbers, averaged with those before
  uint projections;    // points projected a site, exploration included [IPP: 3,072]
  uint clusterCount;   // power of two
  uint clusterSize;    // points a cluster
  uint clusterUsed;    // points a cluster that are lit so far, the first ones; <= clusterSize
  float areaPerPoint;  // [m²] of the whole set; a lit one stands for clusterSize / clusterUsed as much
  uint microSize;      // side of the micro-buffer [texel], <= 32
  uint correctionRays; // that correct what the micro-buffer brings; 0: none
};
LIMN_ASSERT_SIZE(PointProjectionPush, 44);

// One sample of every pixel of a list: direct light, sharp lobes followed by rays, gathered light looked up.
struct ShadePush {
  uint firstEntry;      // of the pixel list
  uint entryCount;
  uint sampleIndex;     // of the film's samples; 0 goes through the pixel's centre
  uint seed;
  uint firstOfFilm;     // 1: the film holds nothing yet; what it holds is replaced
  uint firstOfGather;   // 1: looked-up light of earlier samples is stale and counts for less
  uint directOnly;      // 1: no indirect light at all
  uint passes;          // before this one
};
LIMN_ASSERT_SIZE(ShadePush, 32);

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
