// The functions of trace.glsl by walking the tables of SceneBvh, on any device.
#ifndef LIMN_TRACE_WALK_GLSL
#define LIMN_TRACE_WALK_GLSL
#include "shaders/lib/trace_node.glsl"
#include "shaders/lib/trace_triangle.glsl"

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

// On a vector machine a branch costs its whole body whether taken or not, and only a loop that all lanes have left is
// skipped: so the lanes walk nodes together until each has triangles to test, then test together.
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

#endif
