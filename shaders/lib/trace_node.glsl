// One step down the hierarchy: which children of a node a ray enters, the nearest first.
#ifndef LIMN_TRACE_NODE_GLSL
#define LIMN_TRACE_NODE_GLSL
#include "shaders/shared/bvh_shared.h"

// Ray parameters are compared as the integers of their bits, which order floats >= 0 as the floats; a negative one
// stays below all of them, and that is all an interval that starts at 0 needs to know. It is a third of the work on
// lavapipe, whose float min and max also look for NaN.
const int kTraceMiss = 0x7fffffff;
const int kTraceSlack = 8;  // [ulp] of t, for the rounding of planes far away (renderer/visibility/bvh_encode.cpp)

struct TraceStep {
  uint triangleMask;  // triangles of leaves that the ray enters, in the node's own triangles
  uint nodeMask;      // all triangles of the node
  uint triangleBase;  // first triangle of the node
  uint near;          // entry of the nearest inner child; 0: none is entered
  uint later;         // entry for the other inner children; 0: none is entered
};

// What is still to visit: a node, and which of its children. Never 0.
uint traceEntry(uint node, uint childMask) { return node << 4u | childMask; }

// A direction component of 0 would make 0 * infinity; one this small moves no ray by an ulp.
vec3 traceInverse(vec3 dirR) {
  vec3 tiny = vec3(1e-18 * max(abs(dirR.x), max(abs(dirR.y), abs(dirR.z))));
  vec3 d = mix(dirR, mix(tiny, -tiny, lessThan(dirR, vec3(0.0))), lessThan(abs(dirR), tiny));
  return 1.0 / d;
}

// t of planes whose grid coordinates (0..255) are in bits 15..22 of q: a float of 256 + coordinate is made without
// conversion.
vec3 traceT(uvec3 q, vec3 perStep, vec3 offset) {
  return uintBitsToFloat((q & 0x7f8000u) | 0x43800000u) * perStep + offset;
}
int traceEnter(uvec3 q, vec3 perStep, vec3 offset) {
  ivec3 t = floatBitsToInt(traceT(q, perStep, offset));
  return max(max(t.x, t.y), max(t.z, 0));
}
int traceLeave(uvec3 q, vec3 perStep, vec3 offset, int tFar) {
  ivec3 t = floatBitsToInt(traceT(q, perStep, offset));
  return min(min(t.x, t.y), min(t.z, tFar)) + kTraceSlack;
}

// The children named by `entry` against the ray up to tFar.
TraceStep traceStep(uint entry, vec3 originR, vec3 inverse, float tFar) {
  int texel = int((entry >> 4u) * kBvhNodeTexels);
  uvec4 a = texelFetch(bvhNodes, texel), b = texelFetch(bvhNodes, texel + 1), c = texelFetch(bvhNodes, texel + 2);
  vec3 perStep = uintBitsToFloat(uvec3(a.w << 23u, a.w << 15u, a.w << 7u) & 0x7f800000u) * inverse;
  vec3 offset = (uintBitsToFloat(a.xyz) - originR) * inverse - 256.0 * perStep;

  bvec3 backward = lessThan(inverse, vec3(0.0));
  uvec3 low = b.xyz, high = uvec3(b.w, c.xy);
  uvec3 n = mix(low, high, backward), f = mix(high, low, backward);
  int far = floatBitsToInt(tFar);
  ivec4 enter = ivec4(traceEnter(n << 15u, perStep, offset), traceEnter(n << 7u, perStep, offset),
                      traceEnter(n >> 1u, perStep, offset), traceEnter(n >> 9u, perStep, offset));
  ivec4 leave = ivec4(traceLeave(f << 15u, perStep, offset, far), traceLeave(f << 7u, perStep, offset, far),
                      traceLeave(f >> 1u, perStep, offset, far), traceLeave(f >> 9u, perStep, offset, far));
  bvec4 hit;
  for (uint i = 0u; i < 4u; ++i) hit[i] = enter[i] <= leave[i] && (entry & 1u << i) != 0u;

  TraceStep s;
  s.nodeMask = c.z >> 24u | c.w >> 24u << 8u;
  s.triangleBase = c.w & kBvhBaseMask;
  s.triangleMask =
      s.nodeMask & ((hit.x ? 7u : 0u) | (hit.y ? 7u << 3u : 0u) | (hit.z ? 7u << 6u : 0u) | (hit.w ? 7u << 9u : 0u));

  // Sort the inner children by where they are entered; the two low bits of a key name the child.
  uint innerCount = a.w >> 24u, childBase = c.z & kBvhBaseMask;
  ivec4 key;
  for (uint i = 0u; i < 4u; ++i) key[i] = hit[i] && innerCount > i ? (enter[i] & ~3) | int(i) : kTraceMiss;
  int m0 = min(key.x, key.y), m1 = max(key.x, key.y), m2 = min(key.z, key.w), m3 = max(key.z, key.w);
  int first = min(m0, m2), middle0 = max(m0, m2), middle1 = min(m1, m3);
  int second = min(middle0, middle1), third = max(middle0, middle1);

  // A single other child is entered directly later; several are looked at again, with the t known then.
  uint others = (key.x != kTraceMiss ? 1u : 0u) | (key.y != kTraceMiss ? 2u : 0u) | (key.z != kTraceMiss ? 4u : 0u) |
                (key.w != kTraceMiss ? 8u : 0u);
  others &= ~(1u << (uint(first) & 3u));
  uint secondEntry = traceEntry(childBase + (uint(second) & 3u), 15u);
  s.near = first != kTraceMiss ? traceEntry(childBase + (uint(first) & 3u), 15u) : 0u;
  s.later = second == kTraceMiss ? 0u : (third == kTraceMiss ? secondEntry : traceEntry(entry >> 4u, others));
  return s;
}

// The entries left behind on the way down, newest in s0: kBvhMaxHeight - 1 are enough. Sixteen variables, because an
// indexed array would live in memory.
struct TraceStack {
  uint s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11, s12, s13, s14, s15;
};

TraceStack traceEmptyStack() { return TraceStack(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u); }

// Pushes `entry` unless it is 0; else, when `pop`, drops the newest. One pass for each: written as one, every variable
// would be read after its neighbours were overwritten, and compilers would copy them all.
void traceMove(inout TraceStack s, uint entry, bool pop) {
  bool push = entry != 0u;
#define LIMN_TRACE_PUSH(self, newer) s.self = push ? newer : s.self;
  LIMN_TRACE_PUSH(s15, s.s14) LIMN_TRACE_PUSH(s14, s.s13) LIMN_TRACE_PUSH(s13, s.s12) LIMN_TRACE_PUSH(s12, s.s11)
  LIMN_TRACE_PUSH(s11, s.s10) LIMN_TRACE_PUSH(s10, s.s9) LIMN_TRACE_PUSH(s9, s.s8) LIMN_TRACE_PUSH(s8, s.s7)
  LIMN_TRACE_PUSH(s7, s.s6) LIMN_TRACE_PUSH(s6, s.s5) LIMN_TRACE_PUSH(s5, s.s4) LIMN_TRACE_PUSH(s4, s.s3)
  LIMN_TRACE_PUSH(s3, s.s2) LIMN_TRACE_PUSH(s2, s.s1) LIMN_TRACE_PUSH(s1, s.s0) LIMN_TRACE_PUSH(s0, entry)
#undef LIMN_TRACE_PUSH
  pop = pop && !push;
#define LIMN_TRACE_POP(self, older) s.self = pop ? older : s.self;
  LIMN_TRACE_POP(s0, s.s1) LIMN_TRACE_POP(s1, s.s2) LIMN_TRACE_POP(s2, s.s3) LIMN_TRACE_POP(s3, s.s4)
  LIMN_TRACE_POP(s4, s.s5) LIMN_TRACE_POP(s5, s.s6) LIMN_TRACE_POP(s6, s.s7) LIMN_TRACE_POP(s7, s.s8)
  LIMN_TRACE_POP(s8, s.s9) LIMN_TRACE_POP(s9, s.s10) LIMN_TRACE_POP(s10, s.s11) LIMN_TRACE_POP(s11, s.s12)
  LIMN_TRACE_POP(s12, s.s13) LIMN_TRACE_POP(s13, s.s14) LIMN_TRACE_POP(s14, s.s15) LIMN_TRACE_POP(s15, 0u)
#undef LIMN_TRACE_POP
}

#endif
