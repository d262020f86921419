// Small mathematics without bindings.
#ifndef LIMN_MATH_GLSL
#define LIMN_MATH_GLSL

const float kPi = 3.14159265358979;
const float kInvPi = 0.318309886183791;
const float kInfinity = 3.0e38;

float luminance(vec3 linear) { return dot(linear, vec3(0.2126, 0.7152, 0.0722)); }
float maxComponent(vec3 v) { return max(v.x, max(v.y, v.z)); }
float square(float x) { return x * x; }

// a mod n for a below 2^22, as floats: integers are divided lane by lane on a processor.
uint remainderOf(uint a, uint n) {
  int rest = int(a) - int(float(a) / float(n)) * int(n);  // the quotient may be one off
  rest += rest < 0 ? int(n) : 0;
  return uint(rest >= int(n) ? rest - int(n) : rest);
}

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

// Its inverse, for unit vectors; error below 7e-5 rad.
uint octEncode(vec3 n) {
  n /= abs(n.x) + abs(n.y) + abs(n.z);
  vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
  return packSnorm2x16(n.z < 0.0 ? folded : n.xy);
}

// Three magnitudes with one exponent of 8 bits; relative error of the largest below 1/256, 0 and 2^-127...2^127 are kept.
uint packRgbe(vec3 v) {
  float largest = max(v.x, max(v.y, v.z));
  if (!(largest > 1e-38)) return 0u;
  int exponent;
  frexp(min(largest, 1e38), exponent);
  uvec3 m = min(uvec3(ldexp(clamp(v, 0.0, 1e38), ivec3(8 - exponent)) + 0.5), uvec3(255u));
  return m.x | m.y << 8 | m.z << 16 | uint(exponent + 127) << 24;
}
vec3 unpackRgbe(uint p) {
  return ldexp(vec3(p & 255u, (p >> 8) & 255u, (p >> 16) & 255u), ivec3(int(p >> 24) - 127 - 8));
}

// A point just off the surface on the side that `dirW` leaves to. The shift covers the rounding of a point that was
// interpolated from corners of magnitude `extent` [m]: barycentric sums err by a few ulp of the largest corner coordinate.
vec3 offsetOrigin(vec3 p, vec3 geometricNormal, vec3 dir, float extent) {
  const float kUlps = 16.0 / 16777216.0;
  float shift = extent * kUlps;
  return p + geometricNormal * (dot(geometricNormal, dir) >= 0.0 ? shift : -shift);
}

#endif
