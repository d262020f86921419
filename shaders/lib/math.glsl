// Small mathematics without bindings.
#ifndef LIMN_MATH_GLSL
#define LIMN_MATH_GLSL

const float kPi = 3.14159265358979;
const float kInvPi = 0.318309886183791;
const float kInfinity = 3.0e38;

float luminance(vec3 linear) { return dot(linear, vec3(0.2126, 0.7152, 0.0722)); }
float maxComponent(vec3 v) { return max(v.x, max(v.y, v.z)); }
float square(float x) { return x * x; }

bool isFinite(vec3 v) { return !(any(isnan(v)) || any(isinf(v))); }

// Orthonormal tangents of a unit normal, without a branch on its direction (Duff et al. 2017).
void makeFrame(vec3 n, out vec3 t, out vec3 b) {
  float s = n.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (s + n.z);
  float c = n.x * n.y * a;
  t = vec3(1.0 + s * n.x * n.x * a, s * c, -s * n.x);
  b = vec3(c, s + n.y * n.y * a, -n.y);
}

// Unit vector from 2x16-bit octahedral coordinates (gpu/packing.hpp is the inverse).
vec3 octDecode(uint packed) {
  vec2 e = unpackSnorm2x16(packed);
  vec3 v = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  if (v.z < 0.0) v.xy = (1.0 - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
  return normalize(v);
}

// A point just off the surface on the side that `dirW` leaves to. The shift covers the rounding of a point that was
// interpolated from corners of magnitude `extent` [m]: barycentric sums err by a few ulp of the largest corner coordinate.
vec3 offsetOrigin(vec3 p, vec3 geometricNormal, vec3 dir, float extent) {
  const float kUlps = 16.0 / 16777216.0;
  float shift = extent * kUlps;
  return p + geometricNormal * (dot(geometricNormal, dir) >= 0.0 ? shift : -shift);
}

#endif
