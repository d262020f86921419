// Rays arrive at random points of a plane and leave again: what is hit then is the plane itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/lib/scene_bindings.glsl"
#include "shaders/lib/sampling.glsl"
#include "shaders/lib/surface.glsl"
#include "shaders/lib/trace.glsl"

layout(local_size_x = 64) in;
layout(binding = 30, scalar) buffer Out { uint result[]; };  // 0: free, 1: hit the plane, 2: never arrived
layout(push_constant, scalar) uniform Push { uint triangleCount, count, seed; float distance; };

uint state;
float random() {
  state = state * 747796405u + 2891336453u;
  return toUnit(hash(state));
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  state = hash(hash(i) ^ seed);
  uint triangle = min(uint(random() * float(triangleCount)), triangleCount - 1u);
  vec2 barycentrics = sampleTriangle(vec2(random(), random()));
  vec3 fromDir = sampleSphere(vec2(random(), random()));
  Surface aim = makeSurface(triangle, barycentrics, fromDir);
  uint alphaState = 0u;
  Hit hit;
  result[i] = 2u;
  if (!traceClosest(aim.posR + fromDir * distance, -fromDir, kInfinity, alphaState, hit)) return;
  Surface s = makeSurface(hit.triangle, hit.barycentrics, fromDir);
  // From straight up to a thousandth above the surface, on either side of it.
  vec3 t, b;
  makeFrame(s.geometricNormal, t, b);
  float phi = 2.0 * kPi * random(), cosine = pow(10.0, -3.0 * random()), side = random() < 0.5 ? -1.0 : 1.0;
  float sine = sqrt(1.0 - cosine * cosine);
  vec3 away = sine * (cos(phi) * t + sin(phi) * b) + side * cosine * s.geometricNormal;
  result[i] =
      traceClosest(offsetOrigin(s.posR, s.geometricNormal, away, s.extent), away, kInfinity, alphaState, hit) ? 1u : 0u;
}
