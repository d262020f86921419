// Weights that keep gathered light on its own surface, and the look-up at any place of the picture. [IPP §3.3]
#ifndef LIMN_JOINT_BILATERAL_GLSL
#define LIMN_JOINT_BILATERAL_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/gather_shared.h"
#include "shaders/shared/scene_shared.h"

layout(binding = BINDING_G_BUFFER, scalar) readonly buffer SeenSites { GatherSite seenSites[]; };
layout(binding = BINDING_INDIRECT, scalar) LIMN_INDIRECT_ACCESS buffer Gathered { IndirectTexel gathered[]; };

bool seesSurface(GatherSite s) { return s.triangle != kNoIndex; }

// Light that is no number, or beyond all bounds, is taken for none.
bool isUsable(IndirectTexel light) {
  const float kBrightest = 1e30;
  return all(lessThan(abs(light.diffuse), vec3(kBrightest))) && all(lessThan(abs(light.glossy), vec3(kBrightest)));
}
// Light of this very surface, gathered or interpolated: what others may be made of.
bool isKnown(IndirectTexel light) {
  return light.state != kIndirectNone && light.count != kCountGuessed && isUsable(light);
}

// 1 on one plane and object, towards 0 as the other place leaves the tangent plane or its normal turns.
float alikeness(vec3 posR, vec3 normal, uint object, GatherSite other) {
  const float kSlope = 0.12;  // sine over the tangent plane at which the weight has fallen to 1/e
  vec3 apart = other.posR - posR;
  // Far from render space's origin places are on one plane only to the rounding of their coordinates.
  const float kRounding = 8.0 / 16777216.0;
  float height = max(abs(dot(apart, normal)) - kRounding * maxComponent(abs(posR)), 0.0), d2 = dot(apart, apart);
  float level = d2 > 0.0 ? height * height / (d2 * kSlope * kSlope) : 0.0;
  float cosine = max(dot(normal, octDecode(other.normal)), 0.0);
  float c2 = cosine * cosine, c4 = c2 * c2, c8 = c4 * c4;
  bool fits = other.triangle != kNoIndex && other.object == object;
  return fits ? c8 * c8 * exp(-level) : 0.0;
}

const float kLeastWeight = 1e-6;  // smaller ones are none
const float kKnownWeight = 1e-3;  // under it the places around say nothing

// A weighted mean, summed as differences to the first value: what is constant stays so to the last bit. No weight is so
// small that the rounding of a difference would matter beside what the first value adds itself.
struct Mean { vec3 first, sum; float weight; };

Mean emptyMean() { return Mean(vec3(0.0), vec3(0.0), 0.0); }

void addTo(inout Mean m, vec3 value, float weight) {
  m.first = m.weight > 0.0 ? m.first : value;
  m.sum += (value - m.first) * weight;
  m.weight += weight;
}

// Of light: rounding makes none negative.
vec3 valueOf(Mean m) { return m.weight > 0.0 ? max(m.first + m.sum / m.weight, vec3(0.0)) : vec3(0.0); }

struct LightMean { Mean diffuse, glossy; };

LightMean emptyLight() { return LightMean(emptyMean(), emptyMean()); }

void addTo(inout LightMean m, IndirectTexel light, float weight) {
  if (!(weight > kLeastWeight)) return;
  addTo(m.diffuse, light.diffuse, weight);
  addTo(m.glossy, light.glossy, weight);
}

// A mean of nothing is none.
IndirectTexel interpolated(LightMean m, float count) {
  float state = m.diffuse.weight > 0.0 ? kIndirectInterpolated : kIndirectNone;
  return IndirectTexel(valueOf(m.diffuse), count, valueOf(m.glossy), state);
}

bool outside(ivec2 q, ivec2 size) { return any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, size)); }

// The 3x3 places of the grid of `stride` around p.
LightMean meanAround(ivec2 p, int stride, ivec2 size, vec3 posR, vec3 normal, uint object) {
  LightMean m = emptyLight();
  ivec2 centre = (p + stride / 2) / stride;
  for (int k = 0; k < 9; ++k) {
    ivec2 q = (centre + ivec2(k % 3 - 1, k / 3 - 1)) * stride;
    if (outside(q, size)) continue;
    int pixel = q.y * size.x + q.x;
    IndirectTexel light = gathered[pixel];
    if (isKnown(light)) addTo(m, light, alikeness(posR, normal, object, seenSites[pixel]));
  }
  return m;
}

// Mean of the four places of the grid of `stride` around the continuous place (in pixel indices), bilinear times
// alikeness.
LightMean meanOfCell(vec2 place, int stride, ivec2 size, vec3 posR, vec3 normal, uint object) {
  LightMean m = emptyLight();
  vec2 cell = floor(place / float(stride)), f = place / float(stride) - cell;
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1), q = (ivec2(cell) + corner) * stride;
    if (outside(q, size)) continue;
    int pixel = q.y * size.x + q.x;
    float bilinear = (corner.x == 1 ? f.x : 1.0 - f.x) * (corner.y == 1 ? f.y : 1.0 - f.y);
    IndirectTexel light = gathered[pixel];
    if (isKnown(light)) addTo(m, light, bilinear * alikeness(posR, normal, object, seenSites[pixel]));
  }
  return m;
}

// Gathered light for a surface seen at `place` (continuous, 0,0 is the upper left corner of the picture), from a
// picture in which every pixel has some. Where no pixel around sees the same surface, the pixel's own is the best
// guess.
void lookUpIndirect(vec2 place, ivec2 size, vec3 posR, vec3 normal, uint object, out IndirectTexel light) {
  LightMean m = meanOfCell(place - 0.5, 1, size, posR, normal, object);
  if (m.diffuse.weight < kKnownWeight) m = meanAround(ivec2(place), 1, size, posR, normal, object);
  ivec2 p = clamp(ivec2(place), ivec2(0), size - 1);
  IndirectTexel own = gathered[p.y * size.x + p.x];
  if (m.diffuse.weight < kKnownWeight) {
    m = emptyLight();
    if (isUsable(own)) addTo(m, own, 1.0);
  }
  light = interpolated(m, 0.0);
}

#endif
