// Film to display: fills pixels that have no sample yet from the coarse grid, exposure, tone map, sRGB.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/film.glsl"
#include "shaders/shared/gather_shared.h"
#include "shaders/lib/tone_map.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(binding = BINDING_OUTPUT, scalar) writeonly buffer Output { uint outputRgba[]; };
layout(binding = BINDING_INDIRECT, scalar) readonly buffer Indirect { IndirectTexel indirect[]; };
layout(push_constant, scalar) uniform Push { ResolvePush push; };

// Near is bright. Rays that left the scene count 0 in the mean depth; the share of hits undoes that.
float viewedDepth(float meanDepth, float hits) { return hits > 0.0 ? 1.0 / (1.0 + meanDepth / hits) : 0.0; }

vec3 valueOf(uint pixel) {
  if (push.view == kViewDirect) return filmDirect[pixel].rgb;
  if (push.view == kViewIndirect) return filmMean[pixel].rgb - filmDirect[pixel].rgb;
  if (push.view == kViewAlbedo) return filmAlbedo[pixel].rgb;
  if (push.view == kViewNormal) return filmNormal[pixel].rgb * 0.5 + 0.5;
  if (push.view == kViewDepth) return vec3(viewedDepth(filmAlbedo[pixel].w, filmNormal[pixel].w));
  if (push.view == kViewSamples) return vec3(filmMean[pixel].w / 256.0);
  return filmMean[pixel].rgb;
}

uint pixelAt(ivec2 p) { return uint(p.y) * push.width + uint(p.x); }

// Bilinear between the pixels around `p` of the grid of `stride` that have samples; false when one of them has none.
bool fillFromGrid(ivec2 p, int stride, out vec3 color) {
  ivec2 cell = p / stride;
  vec2 f = vec2(p - cell * stride) / float(stride);
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  bool whole = true;
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    ivec2 q = (cell + corner) * stride;
    if (q.x >= int(push.width) || q.y >= int(push.height)) continue;
    bool sampled = filmMean[pixelAt(q)].w > 0.0;
    whole = whole && sampled;
    float w = sampled ? (corner.x == 1 ? f.x : 1.0 - f.x) * (corner.y == 1 ? f.y : 1.0 - f.y) + 1e-6 : 0.0;
    sum += w > 0.0 ? w * valueOf(pixelAt(q)) : vec3(0.0);
    weights += w;
  }
  color = weights > 0.0 ? sum / weights : vec3(0.0);
  return whole;
}

// While a level is under way, the part of the picture that has it is filled from it, the rest from the one before.
vec3 fill(ivec2 p) {
  vec3 fine, coarse;
  bool whole = push.stride > 1u && fillFromGrid(p, int(push.stride) / 2, fine);
  fillFromGrid(p, int(push.stride), coarse);
  return whole ? fine : coarse;
}

// Green where a pixel has gathered for itself, orange where it was interpolated. [IPP fig. 5]
vec3 tinted(vec3 color, uint pixel) {
  bool own = filmMean[pixel].w > 0.0, interpolated = !own;
  if (push.view == kViewPlacement) {
    own = indirect[pixel].state == kIndirectSampled;
    interpolated = indirect[pixel].state == kIndirectInterpolated;
  }
  vec3 tint = own ? vec3(0.05, 0.8, 0.1) : vec3(1.0, 0.3, 0.0);
  return mix(color, tint, own || interpolated ? 0.5 : 0.0);
}

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (p.x >= int(push.width) || p.y >= int(push.height)) return;
  uint pixel = pixelAt(p);
  bool sampled = filmMean[pixel].w > 0.0;  // where not, the planes hold an older picture
  vec3 color = sampled ? valueOf(pixel) : push.stride > 0u ? fill(p) : vec3(0.0);
  bool placement = push.view >= kViewPlacement, radiance = push.view <= kViewIndirect || placement;
  color = radiance ? toneMap(max(color, vec3(0.0)) * push.exposure, push.toneMap) : color;
  if (placement) color = tinted(clamp(color, 0.0, 1.0), pixel);
  outputRgba[pixel] = packUnorm4x8(vec4(linearToSrgb(color), 1.0));
}
