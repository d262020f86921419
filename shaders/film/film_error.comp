// Sums over 16x16 tiles from which the film's error is estimated: the two halves of a pixel's samples disagree by as much as the
// mean errs. Stage 0 sums the mean itself, stage 1 the squared error relative to it (push.meanLuminance).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/film.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(binding = BINDING_OUTPUT, scalar) buffer Tiles { TileError tiles[]; };
layout(push_constant, scalar) uniform Push { SelectPush push; };

shared vec4 partial[256];

// A pixel that one bright path has lifted would hide its own error behind its own mean; its eight neighbours know better.
vec3 neighbourMean(ivec2 p) {
  vec3 sum = vec3(0.0);
  float count = 0.0;
  for (int k = 0; k < 9; ++k) {
    ivec2 q = p + ivec2(k % 3 - 1, k / 3 - 1);
    if (k == 4 || q.x < 0 || q.y < 0 || q.x >= int(push.width) || q.y >= int(push.height)) continue;
    sum += filmMean[uint(q.y) * push.width + uint(q.x)].rgb;
    count += 1.0;
  }
  return sum / count;
}

void main() {
  uvec2 p = gl_GlobalInvocationID.xy;
  vec4 own = vec4(0.0);
  if (p.x < push.width && p.y < push.height) {
    uint pixel = p.y * push.width + p.x;
    vec4 mean = filmMean[pixel];
    if (mean.w > 0.0) {
      own.x = (mean.r + mean.g + mean.b) * (1.0 / 3.0);
      own.w = mean.w;
      float evenCount = filmDirect[pixel].w, oddCount = mean.w - evenCount;
      if (push.stage == 1u && evenCount > 0.0 && oddCount > 0.0) {
        vec3 even = filmHalf[pixel].rgb;
        vec3 odd = (mean.rgb * mean.w - even * evenCount) / oddCount;
        vec3 e = (even - odd) * (sqrt(evenCount * oddCount) / mean.w);
        vec3 level = min(mean.rgb, 2.0 * neighbourMean(ivec2(p)));
        vec3 relative = e * e / (level * level + 0.01 * push.meanLuminance * push.meanLuminance + 1e-30);
        own.y = (relative.r + relative.g + relative.b) * (1.0 / 3.0);
        own.z = 1.0;
      }
    }
  }
  uint l = gl_LocalInvocationIndex;
  partial[l] = own;
  for (uint step = 128u; step > 0u; step >>= 1) {
    barrier();
    if (l < step) partial[l] += partial[l + step];
  }
  if (l == 0u) {
    vec4 s = partial[0];
    tiles[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = TileError(s.x, s.y, s.z, s.w);
  }
}
