// Who is seen through the centre of each pixel of a rectangle: triangle, barycentrics, distance from the eye.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/shared/g_buffer_shared.h"
#include "shaders/lib/scene_bindings.glsl"
#include "shaders/lib/camera.glsl"
#include "shaders/lib/trace.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = BINDING_OUTPUT, scalar) writeonly buffer Output { GBufferTexel gBuffer[]; };
layout(push_constant, scalar) uniform Push { GBufferPush push; };

void main() {
  uvec2 p = gl_GlobalInvocationID.xy;
  if (p.x >= push.width || p.y >= push.height) return;
  vec3 originR, dirR;
  cameraRay(vec2(p + uvec2(push.x, push.y)) + 0.5, originR, dirR);
  Hit hit;
  uint unused = 0u;
  bool found = traceClosest(originR, dirR, 3.0e38, unused, hit);
  vec3 posR = originR + dirR * hit.t;
  gBuffer[p.y * push.width + p.x] =
      GBufferTexel(found ? hit.triangle : kNoTriangle, hit.barycentrics, found ? distanceToEye(originR) + hit.t : 0.0, found ? posR : vec3(0.0), 0u);
}
