// Which pixels gather next, as a compact list whose order never depends on how the device schedules. [IPP §3.3]
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define LIMN_INDIRECT_ACCESS readonly
#include "shaders/lib/joint_bilateral.glsl"
#include "shaders/lib/workgroup_scan.glsl"
#include "shaders/shared/placement_shared.h"

layout(local_size_x = 256) in;
layout(binding = BINDING_PIXEL_LIST, scalar) writeonly buffer PixelList { uint pixelList[]; };
layout(binding = BINDING_SELECTION, scalar) buffer Selection { uint selection[]; };  // a workgroup each, then all
layout(push_constant, scalar) uniform Push { SelectSitesPush push; };

shared float scanFloats[256];

ivec2 pictureSize() { return ivec2(push.width, push.height); }
bool inside(ivec2 p) { return all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, pictureSize())); }
int pixelAt(ivec2 p) { return p.y * int(push.width) + p.x; }

// Bits 0, 2, 4, ... of x, side by side.
uint evenBits(uint x) {
  x &= 0x55555555u;
  x = (x | x >> 1) & 0x33333333u;
  x = (x | x >> 2) & 0x0f0f0f0fu;
  x = (x | x >> 4) & 0x00ff00ffu;
  return (x | x >> 8) & 0x0000ffffu;
}

// Morton order with its bits reversed: any run of it is spread over the whole picture. The square it covers may be
// larger than the picture.
ivec2 scatteredPixel(uint i) {
  uint bits = 2u * uint(findMSB(max(max(push.width, push.height) * 2u - 1u, 2u)));
  uint reversed = bitfieldReverse(i) >> (32u - bits);
  return ivec2(evenBits(reversed), evenBits(reversed >> 1));
}

ivec2 candidatePixel(uint i) {
  if (push.rule >= kSelectUnsampled) return scatteredPixel(push.first + i);
  uint columns = (push.width + push.stride - 1u) / push.stride;
  return ivec2(i % columns, i / columns) * int(push.stride);
}

float outgoing(IndirectTexel light) { return luminance(light.diffuse + light.glossy); }

// Geometry against the four neighbours on the grid: 1 at least where anything may be between them.
float geometricChange(ivec2 p, GatherSite own) {
  vec3 normal = octDecode(own.normal);
  float worst = 0.0;
  for (int k = 0; k < 4; ++k) {
    ivec2 q = p + (k < 2 ? ivec2(2 * k - 1, 0) : ivec2(0, 2 * k - 5)) * int(push.stride);
    if (!inside(q)) continue;
    GatherSite other = seenSites[pixelAt(q)];
    float turn = sqrt(max(2.0 - 2.0 * dot(normal, octDecode(other.normal)), 0.0));
    float change = seesSurface(other) ? distance(own.posR, other.posR) * push.inverseExtent + turn : 1.0;
    worst = max(worst, other.object == own.object ? change : max(change, 1.0));
  }
  return worst;
}

// Radiance between each two of the four parents, corners of the cell of the next coarser grid; kInfinity where that of
// one is no number.
float radianceChange(ivec2 p) {
  ivec2 cell = p / int(2u * push.stride);
  float light[4];
  bool known[4], broken = false;
  for (int k = 0; k < 4; ++k) {
    ivec2 q = (cell + ivec2(k & 1, k >> 1)) * int(2u * push.stride);
    int pixel = pixelAt(inside(q) ? q : ivec2(0));
    IndirectTexel parent = gathered[pixel];
    bool seen = inside(q) && seesSurface(seenSites[pixel]);
    known[k] = seen && isKnown(parent);
    light[k] = known[k] ? outgoing(parent) * push.inverseLuminance : 0.0;
    broken = broken || (seen && !isUsable(parent));
  }
  float sum = 0.0;
  for (int j = 0; j < 4; ++j)
    for (int k = j + 1; k < 4; ++k) sum += known[j] && known[k] ? abs(light[j] - light[k]) : 0.0;
  return broken ? kInfinity : sum;
}

bool chosen(uint i) {
  if (i >= push.candidates) return false;
  ivec2 p = candidatePixel(i);
  if (!inside(p)) return false;
  int pixel = pixelAt(p);
  GatherSite own = seenSites[pixel];
  if (!seesSurface(own)) return false;
  if (push.rule == kSelectGrid || push.rule == kSelectScattered) return true;
  if (gathered[pixel].state == kIndirectSampled) return false;
  if (push.rule == kSelectUnsampled || gathered[pixel].count < 0.0) return true;
  float light = radianceChange(p);
  return light == kInfinity || !(geometricChange(p, own) + push.lambda * light <= push.threshold);
}

// Sum and number of what the candidates on the grid carry, one pair of words a workgroup.
void sumLuminance(uint group, uint i) {
  ivec2 p = candidatePixel(i);
  int pixel = pixelAt(inside(p) ? p : ivec2(0));
  IndirectTexel light = gathered[pixel];
  bool counts = i < push.candidates && inside(p) && seesSurface(seenSites[pixel]) && light.state == kIndirectSampled &&
                isUsable(light);
  scanFloats[gl_LocalInvocationIndex] = counts ? outgoing(light) : 0.0;
  uint number = scanInclusive(counts ? 1u : 0u);
  if (gl_LocalInvocationIndex != kPlacementGroup - 1u) return;
  float sum = 0.0;
  for (uint k = 0u; k < kPlacementGroup; ++k) sum += scanFloats[k];
  selection[2u * group] = floatBitsToUint(sum);
  selection[2u * group + 1u] = number;
}

// Where the run of each workgroup begins in the list; the total behind the last.
void placeRuns(uint groups) {
  uint base = 0u;
  for (uint first = 0u; first < groups; first += kPlacementGroup) {
    uint group = first + gl_LocalInvocationIndex;
    uint count = group < groups ? selection[group] : 0u;
    uint inclusive = scanInclusive(count);
    if (group < groups) selection[group] = base + inclusive - count;
    base += scan[kPlacementGroup - 1u];
    barrier();
  }
  if (gl_LocalInvocationIndex == 0u) selection[groups] = base;
}

void main() {
  uint groups = (push.candidates + kPlacementGroup - 1u) / kPlacementGroup;
  if (push.stage == 1u) {
    placeRuns(groups);
    return;
  }
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (group >= groups) return;  // the end of the last row
  uint i = group * kPlacementGroup + gl_LocalInvocationIndex;
  if (push.stage == 3u) {
    sumLuminance(group, i);
    return;
  }
  uint own = chosen(i) ? 1u : 0u;
  uint inclusive = scanInclusive(own);
  if (push.stage == 0u) {
    if (gl_LocalInvocationIndex == kPlacementGroup - 1u) selection[group] = inclusive;
  } else if (own == 1u) {
    pixelList[selection[group] + inclusive - 1u] = uint(pixelAt(candidatePixel(i)));
  }
}
