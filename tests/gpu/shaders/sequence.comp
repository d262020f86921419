// Points of next2D: for every pixel the first samples of the first pairs.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/sampling.glsl"

layout(local_size_x = 64) in;
layout(binding = 30, scalar) buffer Out { vec2 result[]; };
layout(push_constant, scalar) uniform Push { uint pixels, samples, pairs, seed; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= pixels * samples) return;
  Sampler s = makeSampler(i / samples, i % samples, seed);
  for (uint pair = 0u; pair < pairs; ++pair) result[i * pairs + pair] = next2D(s);
}
