// Direct light at surface points by next-event estimation with shadow rays: the irradiance of both sides and, in scenes
// with glossy sources, the lobes that light from single directions makes. [IPP §4] One invocation a point.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/shared/film_shared.h"
#include "shaders/shared/gather_shared.h"
#include "shaders/shared/point_shared.h"
#include "shaders/shared/relight_shared.h"
#include "shaders/lib/scene_bindings.glsl"
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/alpha.glsl"
#define LIMN_ALPHA
#define LIMN_ALPHA_ENABLED kUseAlpha
#include "shaders/lib/shadow.glsl"
#include "shaders/lib/spherical_triangle.glsl"

layout(constant_id = 16) const bool kUseLobes = true;

layout(local_size_x = 64) in;
layout(binding = BINDING_POINT_SITES, scalar) readonly buffer Sites { PointSite pointSites[]; };
layout(binding = BINDING_POINT_LIGHT, scalar) buffer Light { PointLight pointLight[]; };
layout(binding = BINDING_POINT_LOBES, scalar) buffer Lobes { PointLobes pointLobes[]; };
layout(binding = BINDING_COUNTERS, scalar) buffer Counters { uint counters[]; };
layout(push_constant, scalar) uniform Push { RelightPush push; };

struct SideLight { vec3 front, back; };

LightSample sampleFor(Surface s, uint index, float probability, float uAlias, vec2 u) {
  if (index == kNoIndex) return kNoLight;
  LightData light = lights[index];
  if (kUseTriangleLights && light.type == kLightTriangle) return sampleTriangleLightEvenly(light, probability, s.posR, u);
  return sampleChosenLight(light, probability, s.posR, uAlias, u);
}

// What of a light's sample arrives on the surface, its cosine included. A normal map tilts the side it is on; where the
// two normals disagree about the side, nothing arrives.
vec3 irradianceOf(Surface s, LightSample light) {
  float geometric = dot(s.geometricNormal, light.dirW), shading = dot(s.normal, light.dirW);
  return geometric * shading > 0.0 ? light.radiance * abs(shading) : vec3(0.0);
}

// Reflectance of the lobes, or 0 where the point has none. Lobes too narrow for points so far apart are widened to the
// limit of splats: highlights blur and keep their energy.
void beginLobes(uint point, Surface s) {
  Bsdf f = makeBsdf(s, s.normal);
  vec3 reflectance = reflectionFresnel(f, 1.0);
  bool glossy = (s.flags & kMaterialUnlit) == 0u && maxComponent(reflectance) >= kLobeReflectance;
  pointLobes[point].reflectance = glossy ? packRgbe(reflectance) : 0u;
  pointLobes[point].alpha = glossy ? max(s.alpha, kSplatAlpha) : 0.0;
  pointLobes[point].normal = octEncode(s.normal);
  for (uint i = 0u; i < kLobesPerPoint; ++i) pointLobes[point].lobe[i] = PointLobe(0u, 0u);
}

// Turn `turn` of the point's light: first those lights that own a lobe, whole; then samples of all lights. A sample of a
// light that owns a lobe adds to the diffuse light alone, any other fills one of the lobes left, in equal shares.
void addTurn(uint point, Surface s, uint turn, inout SideLight sum, inout uint discarded) {
  bool whole = turn < push.lobeLights;
  uint sampleIndex = push.samplesBefore + turn - push.lobeLights;
  Sampler sampler_ = makeSampler(point, whole ? ~turn : sampleIndex, push.seed);
  vec2 choice = next2D(sampler_), u = next2D(sampler_);
  uint index = turn;
  float probability = 1.0;
  if (!whole) index = chooseLight(LightReceiver(s.posR, s.geometricNormal, true), choice, probability);
  LightSample light = sampleFor(s, index, probability, choice.y, u);
  vec3 arriving = irradianceOf(s, light);
  if (!isFinite(arriving)) {
    ++discarded;
    arriving = vec3(0.0);
  }
  if (maxComponent(arriving) > 0.0)
    arriving *= shareThatArrives(s, light, absorptionTowards(vec3(0.0), s, light), hashCombine(sampler_.key, sampler_.index));

  bool front = dot(s.geometricNormal, light.dirW) > 0.0;
  sum.front += !whole && front ? arriving : vec3(0.0);
  sum.back += whole || front ? vec3(0.0) : arriving;
  if (!kUseLobes || push.lobes == 0u || turn >= kLobesPerPoint) return;
  float share = whole ? 1.0 : 1.0 / float(min(push.samples, kLobesPerPoint - push.lobeLights));
  bool shines = maxComponent(arriving) > 0.0 && (whole || index >= push.lobeLights);
  pointLobes[point].lobe[turn] =
      PointLobe(shines ? octEncode(light.dirW) : 0u, shines ? packRgbe(arriving * share) : 0u);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.slotCount * push.clusterCount) return;
  uint point = i / push.slotCount * push.clusterSize + push.firstSlot + i % push.slotCount;
  PointSite site = pointSites[point];
  Surface s = makeSurface(site.triangle, site.barycentrics, vec3(0.0));  // no viewer: the front, its normal not bent
  bool first = push.samplesBefore == 0u;
  if (kUseLobes && push.lobes != 0u && first) beginLobes(point, s);

  SideLight sum = SideLight(vec3(0.0), vec3(0.0));
  uint discarded = 0u;
  uint turns = sceneInfo.lightCount > 0u ? push.lobeLights + push.samples : 0u;
  for (uint turn = first ? 0u : push.lobeLights; turn < turns; ++turn) addTurn(point, s, turn, sum, discarded);

  // A discarded sample counts as one without light.
  float scale = 1.0 / float(push.samplesBefore + push.samples), keep = float(push.samplesBefore) * scale;
  vec3 front = first ? vec3(0.0) : pointLight[point].directFront * keep;
  vec3 back = first ? vec3(0.0) : pointLight[point].directBack * keep;
  pointLight[point].directFront = front + sum.front * (kInvPi * scale);
  pointLight[point].directBack = back + sum.back * (kInvPi * scale);
  if (traceCount > 0u) {
    uint before = atomicAdd(counters[kCounterRays], traceCount);
    if (before + traceCount < before) atomicAdd(counters[kCounterRays + 1u], 1u);
  }
  if (discarded > 0u) atomicAdd(counters[kCounterDiscarded], discarded);
}
