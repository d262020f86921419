// Joint bilateral upsampling: pixels of a grid that were not gathered get the light of their parents on the next coarser grid.
// [IPP §3.3]
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define LIMN_INDIRECT_ACCESS
#include "shaders/lib/joint_bilateral.glsl"
#include "shaders/shared/placement_shared.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(push_constant, scalar) uniform Push { ReconstructPush push; };

void main() {
  ivec2 p = (ivec2(gl_GlobalInvocationID.xy) + ivec2(0, push.firstRow)) * int(push.stride), size = ivec2(push.width, push.height);
  if (p.x >= size.x || p.y >= min(size.y, int((push.firstRow + push.rows) * push.stride))) return;
  int pixel = p.y * size.x + p.x, coarse = int(push.stride) * 2;
  GatherSite s = seenSites[pixel];
  bool parent = p.x % coarse == 0 && p.y % coarse == 0;  // filled before, others read it now
  if (parent || !seesSurface(s) || gathered[pixel].state == kIndirectSampled) return;
  vec3 normal = octDecode(s.normal);
  LightMean m = meanOfCell(vec2(p), coarse, size, s.posR, normal, s.object);
  bool close = m.weight >= kKnownWeight;
  if (!close) m = meanAround(p, coarse, size, s.posR, normal, s.object);
  float scale = m.weight > 0.0 ? 1.0 / m.weight : 0.0;
  // A negative count asks for a gather: nothing near looks like this pixel.
  gathered[pixel] = IndirectTexel(m.diffuse * scale, close ? 0.0 : -1.0, m.glossy * scale, kIndirectInterpolated);
}
