// What point projection cannot do without: for each projection the fetch of a point and an atomic minimum in shared memory.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/gather_shared.h"

layout(constant_id = 17) const uint kGroup = 64u;
layout(local_size_x = 64, local_size_x_id = 17) in;
layout(binding = BINDING_POINTS) uniform usamplerBuffer points;
layout(binding = BINDING_INDIRECT, scalar) buffer Indirect { IndirectTexel indirect[]; };
layout(push_constant, scalar) uniform Push { PointProjectionPush push; };
shared uint micro[1024];

void main() {
  uint lane = gl_LocalInvocationIndex, site = gl_WorkGroupID.x;
  for (uint i = lane; i < 1024u; i += kGroup) micro[i] = 0xffffffffu;
  barrier();
  for (uint i = lane; i < push.projections; i += kGroup) {
    uint cluster = (i * 0x9e3779b9u + site) & (push.clusterCount - 1u);
    uvec4 point = texelFetch(points, int(cluster * push.clusterSize + (i + site) % push.clusterUsed));
    atomicMin(micro[(point.x ^ point.w) & 1023u], point.y & 0xfffff000u | i);
  }
  barrier();
  uint sum = 0u;
  for (uint i = lane; i < 1024u; i += kGroup) sum += micro[i] >> 20;
  if (lane == 0u) indirect[site].count = float(sum);
}
