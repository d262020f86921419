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

// A mean of many gathers counts as much as all of them.
float weightOf(IndirectTexel light) { return max(light.count, 1.0); }

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, push.firstRow), size = ivec2(push.width, push.height);
  if (p.x >= size.x || p.y >= min(size.y, int(push.firstRow + push.rows))) return;
  int own = p.y * size.x + p.x, reach = int(push.reach);
  GatherSite s = seenSites[own];
  IndirectTexel centre = gathered[own];
  bool known = isKnown(centre);
  vec3 normal = octDecode(s.normal);
  Mean diffuse = emptyMean(), glossy = emptyMean();
  for (int y = max(p.y - reach, 0); y <= min(p.y + reach, size.y - 1); ++y)
    for (int x = max(p.x - reach, 0); x <= min(p.x + reach, size.x - 1); ++x) {
      int other = y * size.x + x;
      IndirectTexel light = gathered[other];
      float weight = other == own ? 1.0 : alikeness(s.posR, normal, s.object, seenSites[other]);
      if (!(weight > kLeastWeight) || !isKnown(light)) continue;
      addTo(diffuse, light.diffuse, weight * weightOf(light));
      bool near = abs(x - p.x) <= 1 && abs(y - p.y) <= 1;  // reflections are sharper than shadows
      if (near || !known) addTo(glossy, light.glossy, weight * weightOf(light));
    }
  IndirectTexel result = centre;
  if (seesSurface(s)) {
    if (diffuse.weight >= kKnownWeight) {
      float count = known ? centre.count : 0.0, state = known ? centre.state : kIndirectInterpolated;
      result = IndirectTexel(valueOf(diffuse), count, valueOf(glossy), state);
    } else if (!isUsable(centre)) {
      result = IndirectTexel(vec3(0.0), kCountGuessed, vec3(0.0), kIndirectNone);
    }
  }
  filtered[own] = result;
}
