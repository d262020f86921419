// Who sees whom: closest and any hit of a ray with the scene. The includer declares the tables of SceneBvh as
// `BVH_NODE_SAMPLER bvhNodes` and `BVH_TRIANGLE_SAMPLER bvhTriangles` before this. With LIMN_ALPHA it also defines
//   bool alphaAccepts(uint triangle, vec2 barycentrics, inout uint state)
// which says whether a hit on an alpha-tested triangle counts; and, if that is only known when the pipeline is made,
// LIMN_ALPHA_ENABLED as a constant expression that says whether there are any. LIMN_RAY_QUERY: see
// trace_ray_query.glsl.
//
// lavapipe ends all loops of an invocation after 65,535 iterations together, silently; a ray takes about 50, seldom
// 300.
#ifndef LIMN_TRACE_GLSL
#define LIMN_TRACE_GLSL
#include "shaders/shared/bvh_shared.h"

#ifndef LIMN_ALPHA_ENABLED
#define LIMN_ALPHA_ENABLED true
#endif

struct Hit {
  float t;             // ray parameter, in lengths of the direction
  uint triangle;       // global id; kNoTriangle on a miss
  vec2 barycentrics;   // weights of corners 1 and 2
};

#ifdef LIMN_RAY_QUERY
#include "shaders/lib/trace_ray_query.glsl"
#else
#include "shaders/lib/trace_walk.glsl"
#endif

// The nearest hit with 0 < t < tMax; of hits at the same t the lowest triangle id. `dirR` need not be unit; not zero.
bool traceClosest(vec3 originR, vec3 dirR, float tMax, inout uint alphaState, out Hit hit) {
  return traceScene(originR, dirR, tMax, false, alphaState, hit);
}

// Whether anything lies at 0 < t < tMax.
bool traceAny(vec3 originR, vec3 dirR, float tMax, inout uint alphaState) {
  Hit hit;
  return traceScene(originR, dirR, tMax, true, alphaState, hit);
}

#endif
