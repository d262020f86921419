// Hemi-octahedral map of the directions above a surface, in the frame of its normal (z up), onto a square of texels.
#ifndef LIMN_MICRO_BUFFER_GLSL
#define LIMN_MICRO_BUFFER_GLSL
#include "shaders/lib/math.glsl"

// Point of the octahedron |x| + |y| + z = 1 in the direction of w, z >= 0; w need not be a unit vector.
vec3 onOctahedron(vec3 w) { return w / (abs(w.x) + abs(w.y) + abs(w.z)); }

// Coordinates in [0, 1]² of a point of the octahedron. [IPP eq. 2], the paper's z and y exchanged
vec2 microFromOctahedron(vec3 q) { return 0.5 * vec2(1.0 - q.x + q.y, 1.0 - q.x - q.y); }

// The inverse.
vec3 octahedronFromMicro(vec2 t) {
  vec2 q = vec2(1.0 - t.x - t.y, t.x - t.y);
  return vec3(q, max(1.0 - abs(q.x) - abs(q.y), 0.0));
}

vec2 microFromDirection(vec3 w) { return microFromOctahedron(onOctahedron(w)); }
vec3 directionFromMicro(vec2 t) { return normalize(octahedronFromMicro(t)); }

// Solid angle [sr] of the unit square around a point of the octahedron, per unit area: the faces' cosine and distance leave
// 2 / |q|³. Over the whole square it integrates to 2 pi.
float microSolidAngle(vec3 q) {
  float inverse = inversesqrt(dot(q, q));
  return 2.0 * inverse * inverse * inverse;
}

// Column and row of texel `i` of a map up to 2,048 texels wide. Integers are divided lane by lane on a processor, floats are not.
ivec2 texelPlace(uint i, uint size) {
  int row = int((float(i) + 0.5) / float(size));
  return ivec2(int(i) - row * int(size), row);
}

// The octahedron's point at the middle of texel `i` of a map `size` texels wide. Its solid angle is microSolidAngle() / size²:
// over a map of 8x8 these sum up to 2 pi within 1e-4, and times the cosine to pi within 4e-4.
vec3 microTexel(uint i, uint size) { return octahedronFromMicro((vec2(texelPlace(i, size)) + 0.5) / float(size)); }

#endif
