// Gathered light looked up at surfaces seen anywhere in the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define LIMN_INDIRECT_ACCESS readonly
#include "shaders/lib/joint_bilateral.glsl"

struct Query {
  vec2 place;
  vec3 posR;
  uint normal;
  uint object;
  uint column;
};

layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer Queries { Query queries[]; };
layout(binding = 30, scalar) buffer Out { IndirectTexel result[]; };
layout(push_constant, scalar) uniform Push { ivec2 size; uint count; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  Query q = queries[i];
  lookUpIndirect(q.place, size, q.posR, octDecode(q.normal), q.object, result[i]);
}
