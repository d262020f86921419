// Samples, integrals over bins and swapped pairs of one BSDF.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/lib/scene_bindings.glsl"
#include "shaders/lib/bsdf.glsl"
#include "tests/gpu/shaders/bsdf_cases.h"

layout(local_size_x = 64) in;
layout(binding = 30, scalar) buffer Out { vec4 result[]; };
layout(binding = 1, scalar) readonly buffer Cases { BsdfCase case_; };
layout(push_constant, scalar) uniform Push { BsdfPush push; };

Surface surfaceOf(BsdfCase c) {
  Surface s;
  s.posR = vec3(0.0);
  s.extent = 1.0;
  s.geometricNormal = c.geometricNormal;
  s.normal = c.normal;
  s.clearcoatNormal = c.clearcoatNormal;
  s.frontFace = c.frontFace != 0u;
  s.material = 0u;
  s.flags = c.flags;
  s.baseColor = c.baseColor;
  s.metallic = c.metallic;
  s.alpha = c.alpha;
  s.emission = vec3(0.0);
  s.transmission = c.transmission;
  s.ior = c.ior;
  s.specular = c.specular;
  s.specularColor = c.specularColor;
  s.clearcoat = c.clearcoat;
  s.clearcoatAlpha = c.clearcoatAlpha;
  return s;
}

uint state;
float random() {
  state = state * 747796405u + 2891336453u;
  return toUnit(hash(state));
}

vec3 binDirection(float row, float column) {
  float x = 2.0 * pow(row, case_.concentration);  // 1 - cos
  float phi = 2.0 * kPi * column;
  vec3 t, b;
  makeFrame(case_.axis, t, b);
  float sine = sqrt(max(0.0, x * (2.0 - x)));
  return normalize(sine * (cos(phi) * t + sin(phi) * b) + (1.0 - x) * case_.axis);
}

vec4 integral(Bsdf f, uint bin) {
  vec4 sum = vec4(0.0);
  for (uint i = 0u; i < kBsdfSubdivisions * kBsdfSubdivisions; ++i) {
    float row =
        (float(bin / kColumnBins) + (float(i / kBsdfSubdivisions) + 0.5) / float(kBsdfSubdivisions)) / float(kRowBins);
    float column = (float(bin % kColumnBins) + (float(i % kBsdfSubdivisions) + 0.5) / float(kBsdfSubdivisions)) /
                   float(kColumnBins);
    float pdf;
    vec3 value = evaluateBsdf(f, case_.woW, binDirection(row, column), pdf);
    sum += vec4(value, pdf) * (pow(row, case_.concentration - 1.0) * case_.concentration);
  }
  return sum * (4.0 * kPi / float(kRowBins * kColumnBins * kBsdfSubdivisions * kBsdfSubdivisions));
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  state = hash(hash(i) ^ push.seed);
  Surface s = surfaceOf(case_);
  if (push.mode == kBsdfSwap) {
    vec3 a = sampleSphere(vec2(random(), random())), b = sampleSphere(vec2(random(), random()));
    a = dot(a, s.normal) < 0.0 ? -a : a;
    b = dot(b, s.normal) < 0.0 ? -b : b;
    float pdf;
    vec3 forth = evaluateBsdf(makeBsdf(s, a), a, b, pdf) / dot(b, s.normal);
    vec3 back = evaluateBsdf(makeBsdf(s, b), b, a, pdf) / dot(a, s.normal);
    result[2u * i] = vec4(forth, dot(a, s.normal));
    result[2u * i + 1u] = vec4(back, dot(b, s.normal));
    return;
  }
  Bsdf f = makeBsdf(s, case_.woW);
  if (push.mode == kBsdfIntegrate) {
    result[i] = integral(f, i);
    return;
  }
  float lobe = random();
  BsdfSample drawn = sampleBsdf(f, case_.woW, lobe, vec2(random(), random()));
  float pdf = 0.0;
  vec3 value = vec3(0.0);
  if (drawn.pdf > 0.0) value = evaluateBsdf(f, case_.woW, drawn.dirW, pdf);
  result[3u * i] = vec4(drawn.dirW, drawn.pdf);
  result[3u * i + 1u] = vec4(drawn.weight, float(drawn.mirror) + 2.0 * float(drawn.transmitted));
  result[3u * i + 2u] = vec4(value, pdf);
}
