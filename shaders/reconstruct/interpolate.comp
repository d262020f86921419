// Joint bilateral upsampling: pixels of a grid that were not gathered get the light of their parents on the next
// coarser grid. [IPP §3.3]
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define LIMN_INDIRECT_ACCESS
#include "shaders/lib/joint_bilateral.glsl"
#include "shaders/shared/placement_shared.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(push_constant, scalar) uniform Push { ReconstructPush push; };

// Mean of the four parents whatever surfaces they see; guesses of theirs count little.
LightMean guess(ivec2 p, int coarse, ivec2 size) {
  LightMean m = emptyLight();
  for (int k = 0; k < 4; ++k) {
    ivec2 q = (p / coarse + ivec2(k & 1, k >> 1)) * coarse;
    if (outside(q, size)) continue;
    int parent = q.y * size.x + q.x;
    IndirectTexel light = gathered[parent];
    bool lit = seesSurface(seenSites[parent]) && light.state != kIndirectNone && isUsable(light);
    if (lit) addTo(m, light, isKnown(light) ? 1.0 : 1e-3);
  }
  return m;
}

void main() {
  ivec2 size = ivec2(push.width, push.height);
  ivec2 p = (ivec2(gl_GlobalInvocationID.xy) + ivec2(0, push.firstRow)) * int(push.stride);
  if (p.x >= size.x || p.y >= min(size.y, int((push.firstRow + push.rows) * push.stride))) return;
  int pixel = p.y * size.x + p.x, coarse = int(push.stride) * 2;
  GatherSite s = seenSites[pixel];
  bool parent = p.x % coarse == 0 && p.y % coarse == 0;  // filled before, others read it now
  if (parent || !seesSurface(s) || gathered[pixel].state == kIndirectSampled) return;
  vec3 normal = octDecode(s.normal);
  LightMean m = meanOfCell(vec2(p), coarse, size, s.posR, normal, s.object);
  float count = 0.0;
  if (m.diffuse.weight < kKnownWeight) {
    m = meanAround(p, coarse, size, s.posR, normal, s.object);
    count = kCountFar;
  }
  if (m.diffuse.weight < kKnownWeight) {
    m = guess(p, coarse, size);
    count = kCountGuessed;
  }
  gathered[pixel] = interpolated(m, count);
}
