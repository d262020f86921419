// What light sampling draws in a real scene: lights, points of a triangle light, directions of the environment.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/lib/scene_bindings.glsl"
#include "shaders/lib/spherical_triangle.glsl"
#include "tests/gpu/shaders/lights.h"

layout(local_size_x = 64) in;
layout(binding = 30, scalar) buffer Out { vec4 result[]; };
layout(push_constant, scalar) uniform Push { LightsPush push; };

uint state;
float random() {
  state = state * 747796405u + 2891336453u;
  return toUnit(hash(state));
}

// A corner of the scene's triangles, as a direction from push.posR.
vec3 corner(uint index) {
  uvec4 t = texelFetch(triangles, int(index / 3u));
  return normalize(texelFetch(positions, int(t[index % 3u])).xyz - push.posR);
}

// Bins of equal solid angle: rows in the cosine to +y, columns around it as environmentUv counts them.
float environmentMass(uint bin) {
  float sum = 0.0;
  for (uint i = 0u; i < kBinPoints * kBinPoints; ++i) {
    float row = (float(bin / kEnvironmentColumns) + (float(i / kBinPoints) + 0.5) / float(kBinPoints)) /
                float(kEnvironmentRows);
    float column = (float(bin % kEnvironmentColumns) + (float(i % kBinPoints) + 0.5) / float(kBinPoints)) /
                   float(kEnvironmentColumns);
    vec2 uv = vec2(column, acos(1.0 - 2.0 * row) * kInvPi);
    sum += environmentPdf(environmentDirection(uv));
  }
  return sum * 4.0 * kPi / float(kEnvironmentRows * kEnvironmentColumns * kBinPoints * kBinPoints);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  state = hash(hash(i) ^ push.seed);
  if (push.mode == kLightsSphericalTriangle) {
    uint first = 3u * push.light;
    float solidAngle;
    vec3 dirW = sampleSphericalTriangle(corner(first), corner(first + 1u), corner(first + 2u),
                                        vec2(random(), random()), solidAngle);
    result[i] = vec4(dirW, solidAngle);
  } else if (push.mode == kLightsChoose) {
    vec2 choice = vec2(random(), random());
    uint chosen = chooseByPower(choice);
    result[i] = vec4(float(chosen), lights[chosen].probability, choice);
  } else if (push.mode == kLightsTriangle || push.mode == kLightsTriangleEvenly) {
    vec2 u = vec2(random(), random());
    LightSample s;
    if (push.mode == kLightsTriangle) s = sampleTriangleLight(lights[push.light], lights[push.light].probability, push.posR, u);
    else s = sampleTriangleLightEvenly(lights[push.light], lights[push.light].probability, push.posR, u);
    result[2u * i] = vec4(s.dirW, s.distance);
    result[2u * i + 1u] = vec4(s.radiance, s.pdf);
  } else if (push.mode == kLightsEnvironment) {
    float pdf;
    vec2 u = vec2(random(), random());
    vec3 dirW = sampleEnvironment(u, random(), pdf);
    result[2u * i] = vec4(environmentUv(dirW), pdf, environmentPdf(dirW));
    result[2u * i + 1u] = vec4(environmentRadiance(dirW), dirW.y);
  } else {
    result[i] = vec4(environmentMass(i));
  }
}
