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

// A side that knows no neighbour of its own kind, as on a small object between larger ones, asks all surfaces near it.
vec3 arrivingAt(vec3 posR, vec3 normal, uint side) {
  const float kKnown = 0.1;
  GridLight own = lookUpPointGrid(posR, normal, side);
  if (own.weight >= kKnown) return own.indirect;
  GridLight any = lookUpPointGrid(posR, normal, kGridEither);
  return any.weight > own.weight ? any.indirect : own.indirect;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.slotCount * push.clusterCount) return;
  uint point = i / push.slotCount * push.clusterSize + push.firstSlot + i % push.slotCount;
  uvec4 raw = texelFetch(gridPoints, int(point));
  vec3 posR = uintBitsToFloat(raw.xyz), normal = octDecode(raw.w);
  for (uint side = kGridFront; side <= kGridBack; ++side) {
    vec3 arriving = arrivingAt(posR, side == kGridFront ? normal : -normal, side);
    if (side == kGridFront) pointLight[point].indirectFront = arriving;
    else pointLight[point].indirectBack = arriving;
  }
}
