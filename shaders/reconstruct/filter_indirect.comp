// Joint bilateral filter of gathered light: less noise, no light across edges of position, normal or object. [IPP §4]
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define LIMN_INDIRECT_ACCESS readonly
#include "shaders/lib/joint_bilateral.glsl"
#include "shaders/shared/placement_shared.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = BINDING_INDIRECT_OUT, scalar) writeonly buffer Filtered { IndirectTexel filtered[]; };
layout(push_constant, scalar) uniform Push { ReconstructPush push; };

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, push.firstRow), size = ivec2(push.width, push.height);
  if (p.x >= size.x || p.y >= min(size.y, int(push.firstRow + push.rows))) return;
  int own = p.y * size.x + p.x, reach = int(push.reach);
  GatherSite s = seenSites[own];
  IndirectTexel centre = gathered[own];
  vec3 normal = octDecode(s.normal), diffuse = vec3(0.0), glossy = vec3(0.0);
  float diffuseWeights = 1.0, glossyWeights = 1.0;
  // Differences to the centre are summed: what is constant stays so to the last bit.
  for (int y = max(p.y - reach, 0); y <= min(p.y + reach, size.y - 1); ++y)
    for (int x = max(p.x - reach, 0); x <= min(p.x + reach, size.x - 1); ++x) {
      int other = y * size.x + x;
      if (other == own) continue;
      float weight = alikeness(s.posR, normal, s.object, seenSites[other]);
      if (weight <= 0.0 || gathered[other].state == kIndirectNone) continue;
      weight *= max(gathered[other].count, 1.0) / max(centre.count, 1.0);
      diffuse += weight * (gathered[other].diffuse - centre.diffuse);
      diffuseWeights += weight;
      bool near = abs(x - p.x) <= 1 && abs(y - p.y) <= 1;  // reflections are sharper than shadows
      glossy += near ? weight * (gathered[other].glossy - centre.glossy) : vec3(0.0);
      glossyWeights += near ? weight : 0.0;
    }
  bool fill = seesSurface(s) && centre.state != kIndirectNone;
  filtered[own] = IndirectTexel(centre.diffuse + (fill ? diffuse / diffuseWeights : vec3(0.0)), centre.count,
                                centre.glossy + (fill ? glossy / glossyWeights : vec3(0.0)), centre.state);
}
