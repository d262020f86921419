// sampleTexture of any slot of a scene at given coordinates.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/lib/scene_bindings.glsl"
#include "shaders/lib/texture.glsl"

layout(local_size_x = 64) in;
layout(binding = 30, scalar) buffer Out { vec4 result[]; };
layout(binding = 31, scalar) readonly buffer In { vec4 coordinates[]; };  // uv0, uv1
layout(push_constant, scalar) uniform Push { uint slot, count; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) result[i] = sampleTexture(textureSlots[slot], coordinates[i].xy, coordinates[i].zw);
}
