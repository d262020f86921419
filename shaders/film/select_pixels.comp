// Which pixels still need samples, as a compact list in tile order. A pixel is done when it and its eight neighbours are below
// the threshold, so that a lucky few samples never stop a pixel alone. Stage 0 counts each 16x16 tile, stage 1 places the tiles
// (one workgroup), stage 2 writes the list. The order never depends on how the device schedules.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/film.glsl"
#include "shaders/lib/workgroup_scan.glsl"

layout(local_size_x = 256) in;
layout(binding = BINDING_PIXEL_LIST, scalar) writeonly buffer PixelList { uint pixelList[]; };
layout(binding = BINDING_OUTPUT, scalar) buffer TileCounts { uint tileCounts[]; };  // and the total behind the last tile
layout(push_constant, scalar) uniform Push { SelectPush push; };

// Standard error of the mean luminance relative to the pixel and a tenth of the picture, as relMSE weighs it.
float relativeError(ivec2 p) {
  uint pixel = uint(clamp(p.y, 0, int(push.height) - 1)) * push.width + uint(clamp(p.x, 0, int(push.width) - 1));
  vec4 mean = filmMean[pixel];
  if (mean.w < float(push.minSamples)) return 3e38;
  float y = dot(mean.rgb, vec3(0.2126, 0.7152, 0.0722));
  float variance = filmHalf[pixel].w / (max(mean.w - 1.0, 1.0) * mean.w);
  return sqrt(variance / (y * y + 0.01 * push.meanLuminance * push.meanLuminance + 1e-30));
}

bool active_(ivec2 p) {
  if (p.x >= int(push.width) || p.y >= int(push.height)) return false;
  float worst = 0.0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) worst = max(worst, relativeError(p + ivec2(dx, dy)));
  return worst > push.threshold;
}

void placeTiles() {
  uint base = 0u;
  for (uint first = 0u; first < push.tileCount; first += 256u) {
    uint tile = first + gl_LocalInvocationIndex;
    uint count = tile < push.tileCount ? tileCounts[tile] : 0u;
    uint inclusive = scanInclusive(count);
    if (tile < push.tileCount) tileCounts[tile] = base + inclusive - count;
    base += scan[255];
    barrier();
  }
  if (gl_LocalInvocationIndex == 0u) tileCounts[push.tileCount] = base;
}

void main() {
  if (push.stage == 1u) {
    placeTiles();
    return;
  }
  uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (tile >= push.tileCount) return;
  uint tilesX = (push.width + 15u) / 16u, l = gl_LocalInvocationIndex;
  // Morton order inside the tile keeps neighbours in one vector.
  uvec2 inTile = uvec2((l & 1u) | ((l >> 1) & 2u) | ((l >> 2) & 4u) | ((l >> 3) & 8u),
                       ((l >> 1) & 1u) | ((l >> 2) & 2u) | ((l >> 3) & 4u) | ((l >> 4) & 8u));
  ivec2 p = ivec2(uvec2(tile % tilesX, tile / tilesX) * 16u + inTile);
  uint own = active_(p) ? 1u : 0u;
  uint inclusive = scanInclusive(own);
  if (push.stage == 0u) {
    if (l == 255u) tileCounts[tile] = inclusive;
  } else if (own == 1u) {
    pixelList[tileCounts[tile] + inclusive - 1u] = uint(p.y) * push.width + uint(p.x);
  }
}
