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

// 1 on one plane and object, towards 0 as the other place leaves the tangent plane or its normal turns.
float alikeness(vec3 posR, vec3 normal, uint object, GatherSite other) {
  const float kSlope = 0.12;  // sine over the tangent plane at which the weight has fallen to 1/e
  vec3 apart = other.posR - posR;
  float height = dot(apart, normal), d2 = dot(apart, apart);
  float level = d2 > 0.0 ? height * height / (d2 * kSlope * kSlope) : 0.0;
  float cosine = max(dot(normal, octDecode(other.normal)), 0.0);
  float c2 = cosine * cosine, c4 = c2 * c2, c8 = c4 * c4;
  bool fits = other.triangle != kNoIndex && other.object == object;
  return fits ? c8 * c8 * exp(-level) : 0.0;
}

struct LightMean { vec3 diffuse, glossy; float weight; };

void addTo(inout LightMean m, IndirectTexel light, float weight) {
  m.diffuse += light.diffuse * weight;
  m.glossy += light.glossy * weight;
  m.weight += weight;
}

// The 3x3 places of the grid of `stride` around p.
LightMean meanAround(ivec2 p, int stride, ivec2 size, vec3 posR, vec3 normal, uint object) {
  LightMean m = LightMean(vec3(0.0), vec3(0.0), 0.0);
  ivec2 centre = (p + stride / 2) / stride;
  for (int k = 0; k < 9; ++k) {
    ivec2 q = (centre + ivec2(k % 3 - 1, k / 3 - 1)) * stride;
    if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, size))) continue;
    int pixel = q.y * size.x + q.x;
    float weight = alikeness(posR, normal, object, seenSites[pixel]);
    if (weight > 0.0 && gathered[pixel].state != kIndirectNone) addTo(m, gathered[pixel], weight);
  }
  return m;
}

// Mean of the four places of the grid of `stride` around the continuous place (in pixel indices), bilinear times alikeness.
LightMean meanOfCell(vec2 place, int stride, ivec2 size, vec3 posR, vec3 normal, uint object) {
  LightMean m = LightMean(vec3(0.0), vec3(0.0), 0.0);
  vec2 cell = floor(place / float(stride)), f = place / float(stride) - cell;
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1), q = (ivec2(cell) + corner) * stride;
    if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, size))) continue;
    int pixel = q.y * size.x + q.x;
    float bilinear = (corner.x == 1 ? f.x : 1.0 - f.x) * (corner.y == 1 ? f.y : 1.0 - f.y);
    float weight = bilinear * alikeness(posR, normal, object, seenSites[pixel]);
    if (weight > 0.0 && gathered[pixel].state != kIndirectNone) addTo(m, gathered[pixel], weight);
  }
  return m;
}

const float kKnownWeight = 1e-3;  // under it the places around say nothing

// Gathered light for a surface seen at `place` (continuous, 0,0 is the upper left corner of the picture), from a picture in which
// every pixel has some. Where no pixel around sees the same surface, the pixel's own is the best guess.
void lookUpIndirect(vec2 place, ivec2 size, vec3 posR, vec3 normal, uint object, out IndirectTexel light) {
  LightMean m = meanOfCell(place - 0.5, 1, size, posR, normal, object);
  if (m.weight < kKnownWeight) m = meanAround(ivec2(place), 1, size, posR, normal, object);
  ivec2 own = clamp(ivec2(place), ivec2(0), size - 1);
  if (m.weight < kKnownWeight) m = LightMean(gathered[own.y * size.x + own.x].diffuse, gathered[own.y * size.x + own.x].glossy, 1.0);
  light = IndirectTexel(m.diffuse / m.weight, 0.0, m.glossy / m.weight, kIndirectInterpolated);
}

#endif
