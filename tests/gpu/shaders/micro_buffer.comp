// Texels of hemi-octahedral maps: middle direction, solid angle, and where that direction is found again.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/micro_buffer.glsl"

struct Texel {
  vec3 dir;
  float solidAngle;
  vec2 found;
};

layout(local_size_x = 64) in;
layout(binding = 30, scalar) buffer Out { Texel result[]; };
layout(push_constant, scalar) uniform Push { uint size; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= size * size) return;
  vec3 q = microTexel(i, size);
  vec3 dir = normalize(q);
  result[i] = Texel(dir, microSolidAngle(q) / float(size * size), microFromDirection(dir * 3.0));
}
