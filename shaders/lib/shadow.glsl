// How much light from a sampled point of a light reaches a surface. The includer counts the rays in `traceCount`.
#ifndef LIMN_SHADOW_GLSL
#define LIMN_SHADOW_GLSL
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/lights.glsl"
#include "shaders/lib/trace.glsl"

uint traceCount = 0u;

// [1/m] Of the medium between a surface and a light; `absorption` is that on the viewer's side.
vec3 absorptionTowards(vec3 absorption, Surface s, LightSample light) {
  if (!kUseTransmission) return vec3(0.0);
  bool sameSide = (s.flags & kMaterialThin) != 0u || dot(s.geometricNormal, light.dirW) > 0.0;
  return sameSide ? absorption : s.frontFace && s.transmission > 0.0 ? materials[s.material].absorption : vec3(0.0);
}

// The share of light that passes a surface hit on the way to it, and the medium behind; 0 unless it is a pane.
vec3 shareThatPasses(Hit hit, vec3 dirW, inout vec3 absorption, out vec3 nextOrigin) {
  Surface s = makeSurface(hit.triangle, hit.barycentrics, -dirW);
  Bsdf f = makeBsdf(s, -dirW);
  nextOrigin = offsetOrigin(s.posR, s.geometricNormal, dirW, s.extent);
  if ((s.flags & kMaterialUnlit) != 0u || !isPane(f)) return vec3(0.0);
  if (!f.thin) absorption = s.frontFace ? materials[s.material].absorption : vec3(0.0);
  return paneTransmittance(f, -dirW);
}

// Of a light's sample, what arrives at the surface through panes and media; `absorption` [1/m] is that of the medium where
// the ray starts.
// The ray aims at the light's point from where it starts: a parallel one would meet a near emitter before its end.
vec3 shareThatArrives(Surface s, LightSample light, vec3 absorption, uint alphaState) {
  bool near = light.distance < kInfinity;
  vec3 origin = offsetOrigin(s.posR, s.geometricNormal, light.dirW, s.extent);
  vec3 way = near ? s.posR - origin + light.dirW * light.distance : light.dirW;
  float end = near ? 1.0 : kInfinity;
  if (!kUsePanes) {
    ++traceCount;
    return traceAny(origin, way, end, alphaState) ? vec3(0.0) : exp(-absorption * light.distance);
  }
  vec3 share = vec3(1.0);
  for (uint panes = 0u; panes <= kMostPanes; ++panes) {
    Hit hit;
    vec3 before = absorption, nextOrigin;
    float perUnit = length(way);
    ++traceCount;
    if (!traceClosest(origin, way, end, alphaState, hit))
      return share * exp(-before * (near && panes > 0u ? perUnit : light.distance));
    share *= shareThatPasses(hit, light.dirW, absorption, nextOrigin) * exp(-before * (hit.t * perUnit));
    if (!(maxComponent(share) > 0.0)) return vec3(0.0);
    if (near) way -= nextOrigin - origin;
    origin = nextOrigin;
  }
  return vec3(0.0);
}

#endif
