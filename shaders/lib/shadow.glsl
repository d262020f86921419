// Whether light from a sampled point of a light reaches a surface. The includer counts the rays in `traceCount`.
#ifndef LIMN_SHADOW_GLSL
#define LIMN_SHADOW_GLSL
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/lights.glsl"
#include "shaders/lib/trace.glsl"

uint traceCount = 0u;

// The ray aims at the light's point from where it starts: a parallel one would meet a near emitter before its end.
bool occluded(Surface s, LightSample light, uint alphaState) {
  vec3 origin = offsetOrigin(s.posR, s.geometricNormal, light.dirW, s.extent);
  bool near = light.distance < kInfinity;
  vec3 way = near ? s.posR - origin + light.dirW * light.distance : light.dirW;
  ++traceCount;
  return traceAny(origin, way, near ? 1.0 : kInfinity, alphaState);
}

// What the medium between the surface and the light lets pass; `absorption` [1/m] is that on the viewer's side.
vec3 transmittance(vec3 absorption, Bsdf f, LightSample light) {
  if (!kUseTransmission) return vec3(1.0);
  bool sameSide = f.thin || dot(f.s.geometricNormal, light.dirW) > 0.0;
  vec3 behind = f.s.frontFace ? materials[f.s.material].absorption : vec3(0.0);
  return exp(-(sameSide ? absorption : behind) * light.distance);
}

#endif
