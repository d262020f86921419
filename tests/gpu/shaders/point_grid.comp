// Looks up the grid of surface points at given places.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/point_grid.glsl"

struct Query {
  vec3 posR;
  vec3 normal;
  uint sides;
};

layout(local_size_x = 64) in;
layout(binding = 60, scalar) readonly buffer In { Query queries[]; };
layout(binding = 30, scalar) buffer Out { GridLight result[]; };
layout(push_constant, scalar) uniform Push { uint count; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  result[i] = lookUpPointGrid(queries[i].posR, queries[i].normal, queries[i].sides);
}
