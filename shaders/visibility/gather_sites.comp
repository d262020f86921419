// What each pixel of a list sees through its centre, for gathers.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/lib/scene_bindings.glsl"
layout(constant_id = 12) const bool kUseSharp = true;
#include "shaders/lib/lobe_split.glsl"
#include "shaders/lib/camera.glsl"
#include "shaders/lib/alpha.glsl"
#define LIMN_ALPHA
#define LIMN_ALPHA_ENABLED kUseAlpha
#include "shaders/lib/trace.glsl"

layout(local_size_x = 64) in;
layout(binding = BINDING_PIXEL_LIST, scalar) readonly buffer PixelList { uint pixelList[]; };
layout(binding = BINDING_G_BUFFER, scalar) writeonly buffer Sites { GatherSite sites[]; };
layout(push_constant, scalar) uniform Push { GatherSitesPush push; };

void main() {
  uint entry = gl_GlobalInvocationID.x;
  if (entry >= push.entryCount) return;
  uint pixel = pixelList[push.firstEntry + entry];
  vec3 originR, dirR;
  cameraRay(vec2(pixel % camera.width, pixel / camera.width) + 0.5, originR, dirR);
  Hit hit;
  uint alphaState = hashCombine(pixel, push.seed);
  GatherSite site = GatherSite(vec3(0.0), 0u, kNoIndex, vec2(0.0), kNoIndex);
  if (traceClosest(originR, dirR, kInfinity, alphaState, hit)) {
    Surface s = makeSurface(hit.triangle, hit.barycentrics, -dirR);
    Bsdf rough = roughPart(makeBsdf(s, -dirR));
    bool gathers = (s.flags & kMaterialUnlit) == 0u && rough.shares.diffuse + rough.shares.reflection > 0.0;
    site = GatherSite(s.posR, octEncode(s.normal), gathers ? hit.triangle : kNoIndex, hit.barycentrics, s.material);
  }
  sites[pixel] = site;
}
