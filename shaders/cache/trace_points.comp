// Indirect light at the first slots of every cluster by paths that begin there; both sides apart. One invocation a side.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/shared/film_shared.h"
#include "shaders/shared/point_shared.h"
#include "shaders/shared/relight_shared.h"
#include "shaders/lib/scene_bindings.glsl"
#define LIMN_UNLIT_AFTER 1u
#include "shaders/lib/path.glsl"

layout(local_size_x = 64) in;
layout(binding = BINDING_POINT_SITES, scalar) readonly buffer Sites { PointSite pointSites[]; };
layout(binding = BINDING_POINT_LIGHT, scalar) buffer Light { PointLight pointLight[]; };
layout(binding = BINDING_COUNTERS, scalar) buffer Counters { uint counters[]; };
layout(push_constant, scalar) uniform Push { TracePointsPush push; };

const uint kRouletteStart = 2u;

// Light that a ray from here finds at emitters themselves is direct, and not this path's; but for unlit surfaces, which relighting
// does not know.
Path startPath(uint side, Facet f, uint sampleIndex) {
  Path p = newPath(makeSampler(side, sampleIndex, push.seed), push.bounces, kRouletteStart);
  vec3 n = (side & 1u) == 0u ? f.normal : -f.normal, t, b;
  makeFrame(n, t, b);
  vec3 local = sampleCosineHemisphere(next2D(p.sampler_));
  p.dirR = t * local.x + b * local.y + n * local.z;
  p.originR = offsetOrigin(f.posR, n, p.dirR, f.extent);
  p.bsdfPdf = local.z * kInvPi;
  p.bounce = 1u;
  return p;
}

// What the light of new paths counts for. A side that many paths found dark, as inside a closed body, is seldom asked again; what
// it then finds counts for the times that it was not. 0: it is not asked.
float weightOfPaths(uint side, vec3 before) {
  const float kDarkSidesAsked = 0.25;
  if (push.samplesBefore < kPathsToBelieveDark || before != vec3(0.0)) return 1.0;
  float u = toUnit(hashCombine(hashCombine(push.seed, side), push.samplesBefore));
  return u < kDarkSidesAsked ? 1.0 / kDarkSidesAsked : 0.0;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= 2u * push.slotCount * push.clusterCount) return;
  uint point = (i >> 1) / push.slotCount * push.clusterSize + push.firstSlot + (i >> 1) % push.slotCount, side = 2u * point + (i & 1u);
  bool front = (i & 1u) == 0u;
  vec3 before = push.samplesBefore == 0u ? vec3(0.0) : front ? pointLight[point].indirectFront : pointLight[point].indirectBack;
  float weight = weightOfPaths(side, before);
  if (weight == 0.0) return;
  PointSite site = pointSites[point];
  Facet f = facetOf(texelFetch(triangles, int(site.triangle)).xyz, cornerWeights(site.barycentrics), vec3(0.0));
  vec3 sum = vec3(0.0);
  uint discarded = 0u, taken = 0u;
  Path p = startPath(side, f, push.samplesBefore);
  while (true) {
    if (advance(p)) continue;
    if (acceptable(p.result)) sum += max(p.result.radiance - p.result.direct, vec3(0.0));
    else ++discarded;
    if (++taken == push.samples) break;
    p = startPath(side, f, push.samplesBefore + taken);
  }
  // A discarded sample counts as one without light.
  vec3 after = (before * float(push.samplesBefore) + sum * weight) / float(push.samplesBefore + push.samples);
  if (front) pointLight[point].indirectFront = after;
  else pointLight[point].indirectBack = after;
  uint rays = atomicAdd(counters[kCounterRays], traceCount);
  if (rays + traceCount < rays) atomicAdd(counters[kCounterRays + 1u], 1u);
  if (discarded > 0u) atomicAdd(counters[kCounterDiscarded], discarded);
}
