// The samplers of shaders/lib one by one, at independent random numbers, and the density of visible normals over bins.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/ggx.glsl"
#include "shaders/lib/sampling.glsl"
#include "tests/gpu/shaders/samplers.h"

layout(local_size_x = 64) in;
layout(binding = 30, scalar) buffer Out { vec4 result[]; };
layout(push_constant, scalar) uniform Push { SamplersPush push; };

vec2 randomPair(uint i) {
  uint first = hash(hash(i) ^ push.seed);
  return vec2(toUnit(first), toUnit(hash(first ^ 0x9e3779b9u)));
}

vec4 drawn(vec2 u) {
  if (push.kind == kSamplerCosine) return vec4(sampleCosineHemisphere(u), 0.0);
  if (push.kind == kSamplerSphere) return vec4(sampleSphere(u), 0.0);
  if (push.kind == kSamplerDisk) return vec4(sampleDisk(u), 0.0, 0.0);
  if (push.kind == kSamplerTriangle) return vec4(sampleTriangle(u), 0.0, 0.0);
  return vec4(sampleVisibleNormal(push.wo, push.alpha, u), 0.0);
}

// Visible normals lie in bins of the hemisphere stretched by 1/alpha, where every alpha looks alike.
float visibleNormalMass(uint bin) {
  float sum = 0.0;
  for (uint i = 0u; i < kSubdivisions * kSubdivisions; ++i) {
    float z = (float(bin / kPhiBins) + (float(i / kSubdivisions) + 0.5) / float(kSubdivisions)) / float(kThetaBins);
    float phi =
        (float(bin % kPhiBins) + (float(i % kSubdivisions) + 0.5) / float(kSubdivisions)) / float(kPhiBins) * 2.0 * kPi;
    vec3 h = vec3(push.alpha * sqrt(1.0 - z * z) * vec2(cos(phi), sin(phi)), z);
    float len = length(h);
    sum += visibleNormalPdf(push.wo, h / len, push.alpha) * square(push.alpha) / (len * len * len);
  }
  return sum * 2.0 * kPi / float(kThetaBins * kPhiBins * kSubdivisions * kSubdivisions);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  result[i] = push.integrate != 0u ? vec4(visibleNormalMass(i)) : drawn(randomPair(i));
}
