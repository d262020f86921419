// Rays correct what a micro-buffer brings to a site: the projection serves as a control variate of the integral, and the
// rays estimate what it missed or added. Texels are drawn by what they bring; a ray through a random place of the texel
// finds the surface that is really seen there, and the nearest point tells what leaves it. On average the gather then
// holds hardly an error of splats, holes and texels; what is left is noise in proportion to that error.
#ifndef LIMN_CORRECTION_GLSL
#define LIMN_CORRECTION_GLSL
#include "shaders/lib/alpha.glsl"
#define LIMN_ALPHA
#define LIMN_ALPHA_ENABLED kUseAlpha
#include "shaders/lib/trace.glsl"
#include "shaders/lib/point_cells.glsl"

layout(binding = BINDING_COUNTERS, scalar) buffer Counters { uint counters[]; };

// Share of the rays that is drawn as if all texels were equally bright: what a dark texel hides is found, and the quotient of
// a correction and its probability stays bounded.
const float kEvenShare = 0.3;
// Of the brightest texel beside: what is bright may begin in this one.
const float kBesideShare = 0.25;
// A ray counts for at most this many times what its texel was drawn for. Where a gather missed something small and bright
// altogether, one ray in many gathers would find it and be a blotch: that light is cut, and is the bias of a correction.
const float kMostQuotient = 12.0;

float brightestAround(uint i) {
  ivec2 t = texelPlace(i, push.microSize);
  float most = 0.0;
  for (int n = 0; n < 9; ++n) {
    ivec2 other = clamp(t + ivec2(n % 3 - 1, n / 3 - 1), ivec2(0), ivec2(push.microSize) - 1);
    most = max(most, importance[uint(other.y) * push.microSize + uint(other.x)]);
  }
  return most;
}

// Luminance that texel `i` is drawn for. Where nothing was seen it may be as bright as on the mean.
float expectedAt(uint i, float mean) {
  float own = importance[i] == kNothingSeen ? mean : importance[i];
  return kEvenShare / (1.0 - kEvenShare) * mean + max(own, kBesideShare * brightestAround(i));
}

float weightOf(uint texel) { return uintBitsToFloat(clusterRun[texel]); }

// Weights of the texels, each invocation those of a stretch: importance[] holds their luminances, clusterRun[] what they would
// bring at radiance 1, and then the weights. Returns their sum, and the mean luminance.
float weighTexels(out float mean) {
  float brought = 0.0, factors = 0.0, sum = 0.0;
  for (uint i = 0u; i < kGroup; ++i) brought += sumOfLanes[i], factors += factorsOfLanes[i];
  barrier();
  mean = brought > 0.0 ? brought / factors : 0.0;
  uint count = push.microSize * push.microSize, stretch = (count + kGroup - 1u) / kGroup;
  uint first = min(gl_LocalInvocationIndex * stretch, count), end = min(first + stretch, count);
  for (uint i = first; i < end; ++i) {
    clusterRun[i] = floatBitsToUint(weightOf(i) * (mean > 0.0 ? expectedAt(i, mean) : 1.0));
    sum += weightOf(i);
  }
  sumOfLanes[gl_LocalInvocationIndex] = sum;
  barrier();
  float total = 0.0;
  for (uint i = 0u; i < kGroup; ++i) total += sumOfLanes[i];
  return total;
}

// The texel at `place` of the running sum of weights.
uint texelAt(float place) {
  uint count = push.microSize * push.microSize, stretch = (count + kGroup - 1u) / kGroup, lane = 0u;
  while (lane + 1u < kGroup && place >= sumOfLanes[lane]) place -= sumOfLanes[lane++];
  uint texel = min(lane * stretch, count - 1u), last = min(texel + stretch, count) - 1u;
  while (texel < last && place >= weightOf(texel)) place -= weightOf(texel++);
  return texel;
}

// Radiance that leaves what the site sees along `dirW`; `known` is false where no point tells it.
vec3 radianceAlong(Site s, vec3 dirW, uint alphaState, out bool known) {
  known = true;
  Hit hit;
  bool above = dot(dirW, s.geometricNormal) > 0.0;
  if (!above || !traceClosest(offsetOrigin(s.posR, s.geometricNormal, dirW, s.extent), dirW, kInfinity, alphaState, hit))
    return vec3(0.0);
  Facet f = facetOf(texelFetch(triangles, int(hit.triangle)).xyz, cornerWeights(hit.barycentrics), -dirW);
  uint entry = nearestPointSide(f.posR, f.frontFace ? f.normal : -f.normal, f.frontFace);
  known = entry != kNoIndex;
  if (!known) return vec3(0.0);
  vec4 radiance = texelFetch(pointRadiance, int(entry));
  if (kUseGlossySources && radiance.w > 0.0) radiance.rgb += lobeRadiance(entry >> 1, -dirW);
  return radiance.rgb;
}

// What the rays of this invocation add to the site's light. Begins and ends with the other invocations at barriers.
IndirectTexel correction(Site s, uint key) {
  IndirectTexel sum = IndirectTexel(vec3(0.0), 0.0, vec3(0.0), kIndirectSampled);
  float mean, total = weighTexels(mean);
  if (!(total > 0.0)) return sum;
  for (uint ray = gl_LocalInvocationIndex; ray < push.correctionRays; ray += kGroup) {
    Sampler sampler_ = makeSampler(key, ray, push.seed);
    vec2 choice = next2D(sampler_), place = next2D(sampler_);
    uint i = texelAt((float(ray) + choice.x) / float(push.correctionRays) * total);
    vec3 q = octahedronFromMicro((vec2(texelPlace(i, push.microSize)) + place) / float(push.microSize));
    vec3 dirW = toWorldOf(s, normalize(q));
    bool known;
    vec3 truth = radianceAlong(s, dirW, sampler_.key ^ ray, known);
    if (!known) continue;
    float scale = total / (float(push.correctionRays) * weightOf(i));
    float brightest = kMostQuotient * expectedAt(i, mean);
    if (mean > 0.0) truth *= min(1.0, brightest / max(luminance(truth), 1e-30));
    addLight(sum, s, q, truth * scale);
    vec3 middle = microTexel(i, push.microSize);
    addLight(sum, s, middle, seen(i, toWorldOf(s, normalize(middle))).rgb * -scale);
  }
  uint traced = (push.correctionRays + kGroup - 1u - gl_LocalInvocationIndex) / kGroup;
  uint before = atomicAdd(counters[kCounterRays], traced);
  if (before + traced < before) atomicAdd(counters[kCounterRays + 1u], 1u);
  return sum;
}

#endif
