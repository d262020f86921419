// Who sees whom: closest and any hit of a ray with the scene. The includer declares the tables of SceneBvh as
// `BVH_NODE_SAMPLER bvhNodes` and `BVH_TRIANGLE_SAMPLER bvhTriangles` before this. With LIMN_ALPHA it also defines
//   bool alphaAccepts(uint triangle, vec2 barycentrics, inout uint state)
// which says whether a hit on an alpha-tested triangle counts; and, if that is only known when the pipeline is made,
// LIMN_ALPHA_ENABLED as a constant expression that says whether there are any.
//
// lavapipe ends all loops of an invocation after 65,535 iterations together, silently; a ray takes about 50, seldom 300.
#ifndef LIMN_TRACE_GLSL
#define LIMN_TRACE_GLSL
#include "shaders/lib/trace_node.glsl"
#include "shaders/lib/trace_triangle.glsl"
#include "shaders/shared/bvh_shared.h"

#ifndef LIMN_ALPHA_ENABLED
#define LIMN_ALPHA_ENABLED true
#endif

struct Hit {
  float t;             // ray parameter, in lengths of the direction
  uint triangle;       // global id; kNoTriangle on a miss
  vec2 barycentrics;   // weights of corners 1 and 2
};

// A hit on an alpha-tested triangle that is still to be asked.
struct TraceQuestion {
  bool open;
  Hit hit;
};

// Tests the next triangle of the mask and takes its bit away.
void traceTriangle(TraceFrame frame, TraceStep s, inout uint mask, inout Hit hit, inout TraceQuestion question) {
  uint bit = mask & (~mask + 1u);
  mask ^= bit;
  int texel = int((s.triangleBase + uint(bitCount(s.nodeMask & (bit - 1u)))) * kBvhTriangleTexels);
  vec4 a = texelFetch(bvhTriangles, texel);
  vec4 b = texelFetch(bvhTriangles, texel + 1);
  vec4 c = texelFetch(bvhTriangles, texel + 2);
  vec3 h;
  bool inside = hitTriangle(frame, a.xyz, b.xyz, c.xyz, h);
  uint id = floatBitsToUint(a.w) & ~kBvhAlphaBit;
  bool taken = inside && h.z > 0.0 && (h.z < hit.t || (h.z == hit.t && int(id) < int(hit.triangle)));
#ifdef LIMN_ALPHA
  question.open = taken && int(floatBitsToUint(a.w)) < 0;
  question.hit = Hit(h.z, id, h.xy);
  taken = taken && !question.open;
#endif
  hit.t = taken ? h.z : hit.t;
  hit.triangle = taken ? id : hit.triangle;
  hit.barycentrics = taken ? h.xy : hit.barycentrics;
}

// Tests the triangles of the mask. Questions are asked outside the inner loop, so that a vector of lanes asks together.
void traceTriangles(TraceFrame frame, TraceStep s, const bool any, inout uint alphaState, inout Hit hit) {
  uint mask = s.triangleMask;
  TraceQuestion question;
  question.open = false;
#ifdef LIMN_ALPHA
  do {
    while (mask != 0u && !question.open) traceTriangle(frame, s, mask, hit, question);
    if (LIMN_ALPHA_ENABLED && question.open) {
      if (alphaAccepts(question.hit.triangle, question.hit.barycentrics, alphaState)) hit = question.hit;
      question.open = false;
    }
    if (any && hit.triangle != kNoTriangle) mask = 0u;
  } while (LIMN_ALPHA_ENABLED && mask != 0u);
#else
  while (mask != 0u) traceTriangle(frame, s, mask, hit, question);
#endif
}

// On a vector machine a branch costs its whole body whether taken or not, and only a loop that all lanes have left is skipped:
// so the lanes walk nodes together until each has triangles to test, then test together.
bool traceScene(vec3 originR, vec3 dirR, float tMax, const bool any, inout uint alphaState, out Hit hit) {
  hit = Hit(tMax, kNoTriangle, vec2(0.0));
  TraceFrame frame = makeTraceFrame(originR, dirR);
  vec3 inverse = traceInverse(dirR);
  TraceStack stack = traceEmptyStack();
  uint entry = traceEntry(0u, 15u);
  while (entry != 0u) {
    TraceStep s;
    s.triangleMask = 0u;
    while (s.triangleMask == 0u && entry != 0u) {
      s = traceStep(entry, originR, inverse, hit.t);
      entry = s.near != 0u ? s.near : stack.s0;
      traceMove(stack, s.later, s.near == 0u);
    }
    traceTriangles(frame, s, any, alphaState, hit);
    if (any && hit.triangle != kNoTriangle) entry = 0u;
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
