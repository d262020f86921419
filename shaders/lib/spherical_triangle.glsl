// Triangle lights sampled evenly over the solid angle they fill: what arrives is bounded however near the light is.
// For receivers that take no other samples of the light; those that combine several use sampleTriangleLight().
#ifndef LIMN_SPHERICAL_TRIANGLE_GLSL
#define LIMN_SPHERICAL_TRIANGLE_GLSL
#include "shaders/lib/lights.glsl"

// Below this solid angle [sr] the angles' rounding shows, and the light is so far or so small that its area serves.
const float kLeastSolidAngle = 3e-3;

float angleBetween(vec3 a, vec3 b) { return acos(clamp(dot(a, b), -1.0, 1.0)); }
vec3 across(vec3 v, vec3 axis) { return normalize(v - axis * dot(v, axis)); }

// Direction evenly over the spherical triangle of the unit vectors a, b, c, and its solid angle [sr]; no direction of use
// where that is 0. [Arvo 1995; Pharr, Jakob, Humphreys 2023, 6.5.4]
vec3 sampleSphericalTriangle(vec3 a, vec3 b, vec3 c, vec2 u, out float solidAngle) {
  vec3 ab = cross(a, b), bc = cross(b, c), ca = cross(c, a);
  solidAngle = 0.0;
  if (!(min(dot(ab, ab), min(dot(bc, bc), dot(ca, ca))) > 0.0)) return a;
  ab = normalize(ab), bc = normalize(bc), ca = normalize(ca);
  // The sum of the angles less pi loses the digits of small triangles. [van Oosterom and Strackee 1983]
  solidAngle = 2.0 * atan(abs(dot(a, cross(b, c))), 1.0 + dot(a, b) + dot(b, c) + dot(c, a));
  float alpha = angleBetween(ab, -ca), sum = kPi + solidAngle;

  float part = mix(kPi, sum, u.x);  // of a triangle that shares a, b and has u.x of the area
  float cosAlpha = cos(alpha), sinAlpha = sin(alpha);
  float sinPhi = sin(part) * cosAlpha - cos(part) * sinAlpha, cosPhi = cos(part) * cosAlpha + sin(part) * sinAlpha;
  float k1 = cosPhi + cosAlpha, k2 = sinPhi - sinAlpha * dot(a, b);
  float cosB = (k2 + (k2 * cosPhi - k1 * sinPhi) * cosAlpha) / ((k2 * sinPhi + k1 * cosPhi) * sinAlpha);
  cosB = clamp(cosB, -1.0, 1.0);
  vec3 corner = cosB * a + sqrt(1.0 - cosB * cosB) * across(c, a);
  float cosTheta = 1.0 - u.y * (1.0 - dot(corner, b));
  return cosTheta * b + sqrt(max(1.0 - cosTheta * cosTheta, 0.0)) * across(corner, b);
}

LightSample sampleTriangleLightEvenly(LightData light, float probability, vec3 p, vec2 u) {
  uvec4 t = texelFetch(triangles, int(light.triangle));
  vec3 p0 = texelFetch(positions, int(t.x)).xyz;
  vec3 e1 = texelFetch(positions, int(t.y)).xyz - p0, e2 = texelFetch(positions, int(t.z)).xyz - p0, from = p - p0;
  float solidAngle;
  vec3 dir = sampleSphericalTriangle(normalize(-from), normalize(e1 - from), normalize(e2 - from), u, solidAngle);
  // Where the direction meets the triangle. [Möller and Trumbore 1997]
  vec3 h = cross(dir, e2), q = cross(from, e1);
  float inverse = 1.0 / dot(e1, h), d = dot(e2, q) * inverse;
  vec2 barycentrics = clamp(vec2(dot(from, h), dot(dir, q)) * inverse, vec2(0.0), vec2(1.0));
  if (!(solidAngle >= kLeastSolidAngle && d > 0.0 && d < kInfinity)) return sampleTriangleLight(light, probability, p, u);
  LightSample s;
  s.dirW = dir;
  s.pdf = probability / solidAngle;
  float scale = max(maxComponent(abs(e1)), maxComponent(abs(e2)));
  float cosLight = abs(dot(normalize(cross(e1 / scale, e2 / scale)), dir));
  s.distance = distanceShortOf(p0, scale, cosLight, d);
  s.radiance = triangleEmission(light.triangle, barycentrics, -dir) / s.pdf;
  return s;
}

#endif
