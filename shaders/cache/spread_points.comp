// Indirect light gathered at the first slots of every cluster, interpolated to the other points: both sides apart. One
// invocation a point. [IPP §4]
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/point_grid.glsl"
#include "shaders/shared/relight_shared.h"

layout(local_size_x = 64) in;
// The look-up reads the same buffer, but only points that are in the grid, which are never written here.
layout(binding = BINDING_POINT_LIGHT, scalar) buffer Light { PointLight pointLight[]; };
layout(push_constant, scalar) uniform Push { SpreadPush push; };

struct Sides {
  vec3 front, back;  // sums of light times weight
  float weight;
};

void add(inout Sides sum, float weight, vec3 front, vec3 back) {
  sum.front += weight * front;
  sum.back += weight * back;
  sum.weight += weight;
}

// What arrives at both sides of a point in one walk through the cells around it, as two calls of lookUpPointGrid() would
// tell: `own` from points that face the same way, `turned` from those that face the other, their sides exchanged.
void addNeighbours(vec3 posR, vec3 normal, inout Sides own, inout Sides turned) {
  PointGridInfo info = pointGridInfo();
  ivec3 base = pointGridBase(info, posR);
  for (int c = 0; c < 8; ++c) {
    uvec2 cell = pointGridCell(info, base, c);
    for (uint e = cell.x; e < cell.y; ++e) {
      uint point = texelFetch(pointGridEntries, int(e)).x;
      uvec4 raw = texelFetch(gridPoints, int(point));
      float cosine = dot(octDecode(raw.w), normal);
      float weight = pointGridWeight(uintBitsToFloat(raw.xyz) - posR, normal, abs(cosine), info.radius);
      vec3 front = gridPointLights[point].indirectFront, back = gridPointLights[point].indirectBack;
      add(own, cosine > 0.0 ? weight : 0.0, front, back);
      add(turned, cosine > 0.0 ? 0.0 : weight, back, front);
    }
  }
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.slotCount * push.clusterCount) return;
  uint point = i / push.slotCount * push.clusterSize + push.firstSlot + i % push.slotCount;
  uvec4 raw = texelFetch(gridPoints, int(point));
  Sides own = Sides(vec3(0.0), vec3(0.0), 0.0), turned = own;
  addNeighbours(uintBitsToFloat(raw.xyz), octDecode(raw.w), own, turned);
  // A point without neighbours of its kind, as on a small object between larger ones, takes what all surfaces near it have.
  const float kKnown = 0.1;
  if (own.weight < kKnown) own = Sides(own.front + turned.front, own.back + turned.back, own.weight + turned.weight);
  float scale = own.weight > 0.0 ? 1.0 / own.weight : 0.0;
  pointLight[point].indirectFront = own.front * scale;
  pointLight[point].indirectBack = own.back * scale;
}
