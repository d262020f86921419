// Who sees whom: closest and any hit of a ray with the scene. The includer declares the tables of SceneBvh as
// `BVH_NODE_SAMPLER bvhNodes` and `BVH_TRIANGLE_SAMPLER bvhTriangles` before this. With LIMN_ALPHA it also defines
//   bool alphaAccepts(uint triangle, vec2 barycentrics, inout uint state)
// which says whether a hit on an alpha-tested triangle counts.
#ifndef LIMN_TRACE_GLSL
#define LIMN_TRACE_GLSL
#include "shaders/lib/trace_triangle.glsl"
#include "shaders/shared/bvh_shared.h"

struct Hit {
  float t;             // ray parameter, in lengths of the direction
  uint triangle;       // global id; kNoTriangle on a miss
  vec2 barycentrics;   // weights of corners 1 and 2
};

// A direction component of 0 would make 0 * infinity; this small it moves no ray by an ulp.
vec3 traceInverse(vec3 dirR) {
  vec3 tiny = vec3(1e-18 * max(abs(dirR.x), max(abs(dirR.y), abs(dirR.z))));
  vec3 d = mix(dirR, mix(tiny, -tiny, lessThan(dirR, vec3(0.0))), lessThan(abs(dirR), tiny));
  return 1.0 / d;
}

// Walks the skip list to the next leaf that the ray enters before `tFar`; returns its word, 0 at the end.
uint traceNextLeaf(vec3 originR, vec3 inverse, float tFar, uint nodeCount, inout uint cur) {
  uint leaf = 0u;
  while (leaf == 0u && cur < nodeCount) {
    int texel = int(cur * kBvhNodeTexels + kBvhHeaderTexels);
    uvec4 a = texelFetch(bvhNodes, texel);
    uvec4 b = texelFetch(bvhNodes, texel + 1);
    vec3 t0 = (uintBitsToFloat(a.xyz) - originR) * inverse;
    vec3 t1 = (uintBitsToFloat(b.xyz) - originR) * inverse;
    vec3 lo = min(t0, t1), hi = max(t0, t1);
    float enter = max(max(lo.x, lo.y), max(lo.z, 0.0));
    float leave = min(min(hi.x, hi.y), min(hi.z, tFar));
    bool hit = enter <= leave * 1.000001;
    leaf = hit ? b.w : 0u;
    cur = hit ? cur + 1u : a.w;
  }
  return leaf;
}

bool traceScene(vec3 originR, vec3 dirR, float tMax, const bool any, inout uint alphaState, out Hit hit) {
  hit = Hit(tMax, kNoTriangle, vec2(0.0));
  TraceFrame frame = makeTraceFrame(originR, dirR);
  vec3 inverse = traceInverse(dirR);
  uint nodeCount = texelFetch(bvhNodes, 0).x;
  uint cur = 0u;
  while (cur < nodeCount) {
    uint leaf = traceNextLeaf(originR, inverse, hit.t, nodeCount, cur);
    uint i = leaf >> kBvhLeafCountBits;
    uint end = i + (leaf & ((1u << kBvhLeafCountBits) - 1u));
    for (; i < end; ++i) {
      int texel = int(i * kBvhTriangleTexels);
      vec4 a = texelFetch(bvhTriangles, texel);
      vec4 b = texelFetch(bvhTriangles, texel + 1);
      vec4 c = texelFetch(bvhTriangles, texel + 2);
      vec3 h;
      uint id = floatBitsToUint(a.w) & ~kBvhAlphaBit;
      bool closer = hitTriangle(frame, a.xyz, b.xyz, c.xyz, h) && h.z > 0.0 &&
                    (h.z < hit.t || (h.z == hit.t && int(id) < int(hit.triangle)));
#ifdef LIMN_ALPHA
      if (closer && (floatBitsToUint(a.w) & kBvhAlphaBit) != 0u) closer = alphaAccepts(id, h.xy, alphaState);
#endif
      hit.t = closer ? h.z : hit.t;
      hit.triangle = closer ? id : hit.triangle;
      hit.barycentrics = closer ? h.xy : hit.barycentrics;
    }
    cur = any && hit.triangle != kNoTriangle ? nodeCount : cur;
  }
  return hit.triangle != kNoTriangle;
}

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
