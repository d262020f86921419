#version 460
// Traces a buffer of rays, nothing else: for the benchmark and for the tests of shaders/lib/trace.glsl.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#ifdef LIMN_RAY_QUERY
#extension GL_EXT_ray_query : require
#endif
#include "shaders/shared/bvh_shared.h"

layout(local_size_x = 64) in;
#ifdef LIMN_RAY_QUERY
layout(binding = 0) uniform accelerationStructureEXT bvhAcceleration;
#else
layout(binding = 0) uniform BVH_NODE_SAMPLER bvhNodes;
layout(binding = 1) uniform BVH_TRIANGLE_SAMPLER bvhTriangles;
#endif

// Two texels a ray: origin and tMax; direction and the bits of the alpha state. Texels, because lavapipe reads them
// three times as fast as a storage buffer.
layout(binding = 2) uniform samplerBuffer rays;

struct RayHit {
  float t;
  uint triangle;
  vec2 barycentrics;
};
layout(binding = 3, scalar) writeonly buffer Hits { RayHit hits[]; };
layout(push_constant) uniform Push { uint rayCount; };

#ifdef LIMN_ALPHA
// A checker in each triangle, so that the host can tell what must be seen; the state counts the questions.
bool alphaAccepts(uint triangle, vec2 barycentrics, inout uint state) {
  ++state;
  return ((triangle ^ uint(barycentrics.x > 0.3)) & 1u) == 0u;
}
#endif
#include "shaders/lib/trace.glsl"

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= rayCount) return;
  vec4 origin = texelFetch(rays, int(2u * index)), direction = texelFetch(rays, int(2u * index + 1u));
  Hit hit = Hit(origin.w, kNoTriangle, vec2(0.0));
  uint state = floatBitsToUint(direction.w);
#ifdef BENCH_ANY
  hit.triangle = traceAny(origin.xyz, direction.xyz, origin.w, state) ? 0u : kNoTriangle;
#else
  traceClosest(origin.xyz, direction.xyz, origin.w, state, hit);
#endif
  hits[index] = RayHit(hit.t, hit.triangle, hit.barycentrics);
}
