// Puts what is displayed at each pixel of a list beside the unbiased samples that a film of the list's entries holds of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/film.glsl"

layout(local_size_x = 64) in;
layout(binding = BINDING_PIXEL_LIST, scalar) readonly buffer PixelList { uint pixelList[]; };
layout(binding = BINDING_SHOWN, scalar) readonly buffer Shown { vec4 shownMean[]; };  // of the picture: radiance, count
layout(binding = BINDING_OUTPUT, scalar) writeonly buffer Records { AuditRecord records[]; };
layout(push_constant, scalar) uniform Push { AuditPush push; };

void main() {
  uint entry = gl_GlobalInvocationID.x;
  if (entry >= push.entryCount) return;
  vec4 shown = shownMean[pixelList[entry]];
  vec4 mean = filmMean[entry];
  float evenCount = mean.w > 0.0 ? filmDirect[entry].w : 0.0, oddCount = mean.w - evenCount;
  vec3 even = evenCount > 0.0 ? filmHalf[entry].rgb : vec3(0.0);
  vec3 odd = oddCount > 0.0 ? (mean.rgb * mean.w - even * evenCount) / oddCount : vec3(0.0);
  records[entry] = AuditRecord(shown.rgb, shown.w, even, evenCount, odd, oddCount,
                                 mean.w > 0.0 ? filmHalf[entry].w : 0.0);
}
