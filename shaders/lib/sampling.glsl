// Owen-scrambled Sobol points in padded pairs, keyed by (pixel, sample index, pair): any range of samples can be taken apart.
// [Burley 2020, Practical Hash-based Owen Scrambling]
#ifndef LIMN_SAMPLING_GLSL
#define LIMN_SAMPLING_GLSL
#include "shaders/lib/math.glsl"

uint hash(uint x) {
  x ^= x >> 16; x *= 0x7feb352du;
  x ^= x >> 15; x *= 0x846ca68bu;
  return x ^ (x >> 16);
}
uint hashCombine(uint a, uint b) { return hash(a ^ (b * 0x9e3779b9u + 0x7f4a7c15u)); }

// Nested uniform scramble of a number whose bits are reversed already (Laine-Karras, constants of N. Vegdahl).
uint owenReversed(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

// Second Sobol dimension of reversed index bits: Pascal's triangle modulo 2 as a product of shifts.
uint sobolSecond(uint reversedIndex) {
  uint x = bitfieldReverse(reversedIndex);
  x ^= (x & 0xaaaaaaaau) >> 1;
  x ^= (x & 0xccccccccu) >> 2;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xff00ff00u) >> 8;
  x ^= (x & 0xffff0000u) >> 16;
  return bitfieldReverse(x);
}

struct Sampler {
  uint key;       // of pixel and seed
  uint index;     // sample index
  uint pair;      // next pair of dimensions
};

Sampler makeSampler(uint pixel, uint sampleIndex, uint seed) {
  return Sampler(hashCombine(hash(pixel + 1u), seed), sampleIndex, 0u);
}

// Even and odd samples of the film draw from two sequences of their own: halves of one sequence err against each other, and
// their difference would overstate the error of the mean.
Sampler makeFilmSampler(uint pixel, uint sampleIndex, uint seed) {
  return makeSampler(pixel, sampleIndex >> 1, (sampleIndex & 1u) == 0u ? seed : seed ^ 0x68bc21ebu);
}

float toUnit(uint x) { return float(x >> 8) * (1.0 / 16777216.0); }  // [0, 1)

// The next two dimensions: a (0, 2)-sequence in the sample index, shuffled and scrambled for each pair.
vec2 next2D(inout Sampler s) {
  uint key = hashCombine(s.key, s.pair++);
  uint reversedIndex = owenReversed(bitfieldReverse(s.index), key);
  // reversedIndex now holds the shuffled index with its bits reversed: the first dimension is that very word.
  uint x = bitfieldReverse(owenReversed(bitfieldReverse(reversedIndex), hash(key ^ 0xa511e9b3u)));
  uint y = bitfieldReverse(owenReversed(bitfieldReverse(sobolSecond(reversedIndex)), hash(key ^ 0x63d83595u)));
  return vec2(toUnit(x), toUnit(y));
}

// Uniform on the unit disk, concentric.
vec2 sampleDisk(vec2 u) {
  float r = sqrt(u.x), phi = 2.0 * kPi * u.y;
  return r * vec2(cos(phi), sin(phi));
}

// About +z, pdf cos/pi per unit solid angle.
vec3 sampleCosineHemisphere(vec2 u) {
  vec2 d = sampleDisk(u);
  return vec3(d, sqrt(max(0.0, 1.0 - dot(d, d))));
}

// pdf 1/(4 pi) per unit solid angle.
vec3 sampleSphere(vec2 u) {
  float z = 1.0 - 2.0 * u.x, r = sqrt(max(0.0, 1.0 - z * z)), phi = 2.0 * kPi * u.y;
  return vec3(r * cos(phi), r * sin(phi), z);
}

// Barycentrics of corners 1 and 2, uniform over the triangle.
vec2 sampleTriangle(vec2 u) {
  float s = sqrt(u.x);
  return vec2(s * (1.0 - u.y), s * u.y);
}

float powerHeuristic(float pdfA, float pdfB) {
  float ratio = pdfB / pdfA;  // the quotient keeps squares of huge pdfs finite
  return 1.0 / (1.0 + ratio * ratio);
}

#endif
