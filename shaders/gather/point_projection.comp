// Light gathered at sites by splatting points into a micro-buffer; one workgroup a site. Two points of every cluster
// explore how much of the view it fills, the rest is drawn from clusters in that proportion. [IPP §3.2, §4]
// LIMN_GATHER_POINTS: sites are the points' sides. LIMN_GATHER_DUMP: pixels, and each writes its micro-buffer instead.
// LIMN_GATHER_CORRECT: rays correct what the micro-buffer brings.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/shared/film_shared.h"
#include "shaders/shared/gather_shared.h"
#include "shaders/shared/point_shared.h"
#include "shaders/lib/scene_bindings.glsl"
layout(constant_id = 12) const bool kUseSharp = true;
#include "shaders/lib/lobe_split.glsl"
#include "shaders/lib/micro_buffer.glsl"
#include "shaders/gather/allocation.glsl"

layout(constant_id = 16) const bool kUseGlossySources = true;  // points may have lobes
layout(constant_id = 17) const uint kGroup = 64u;
layout(constant_id = 18) const uint kSelection = 0u;           // kByImportance...
layout(constant_id = 19) const uint kSplatSide = 0u;           // [texel] of all splats; 0: what they stand for

const uint kByImportance = 0u, kAtRandom = 1u, kEveryPoint = 2u;
const uint kMostTexels = 1024u, kMostProjections = kMostSamples, kMostGroup = 128u;
const uint kExplored = 2u;       // points of a cluster
// Splats cover the texels whose middles are in their square. Squares of a whole texel grow what they show by half a texel
// all around; narrower ones leave holes, which mostly close again. Measured: the least error against rays.
const float kNarrowestSplat = kSelection == kEveryPoint ? 1.0 : 0.88, kWidestSplat = 16.0;  // [texel]
const float kDiskShare = 1.3;  // of the area a point stands for: disks that only just fill a surface leave gaps between them
const uint kHoleTurns = 2u;    // texels that holes close from their rims inwards
const uint kEmpty = 0xffffffffu;
const float kNothingSeen = -1.0;  // luminance of an empty texel

layout(local_size_x = 64, local_size_x_id = 17) in;
layout(binding = BINDING_PIXEL_LIST, scalar) readonly buffer SiteList { uint siteList[]; };
layout(binding = BINDING_POINTS) uniform usamplerBuffer points;
layout(binding = BINDING_POINT_RADIANCE) uniform samplerBuffer pointRadiance;
layout(binding = BINDING_POINT_LOBES, scalar) readonly buffer Lobes { PointLobes pointLobes[]; };
#ifdef LIMN_GATHER_POINTS
layout(binding = BINDING_POINT_LIGHT, scalar) buffer Light { PointLight pointLight[]; };
#ifdef LIMN_GATHER_CORRECT
layout(binding = BINDING_POINT_SITES, scalar) readonly buffer PointSites { PointSite pointSites[]; };
#endif
#else
layout(binding = BINDING_G_BUFFER, scalar) readonly buffer Sites { GatherSite sites[]; };
#ifdef LIMN_GATHER_DUMP
layout(binding = BINDING_OUTPUT, scalar) writeonly buffer Dump { vec4 texelsOut[]; };  // rgb radiance, w: covered
#else
layout(binding = BINDING_INDIRECT, scalar) buffer Indirect { IndirectTexel indirect[]; };
#endif
#endif
layout(push_constant, scalar) uniform Push { PointProjectionPush push; };

shared uint micro[kMostTexels];             // nearest: squared distance in the high bits, then the projection
shared uint projected[kMostProjections];    // 2 * point + side of each projection; cluster of each sample before that
shared float sumOfLanes[kMostGroup];
shared uint holes;                          // empty texels of the micro-buffer
#ifdef LIMN_GATHER_CORRECT
shared float factorsOfLanes[kMostGroup];
#endif

#include "shaders/gather/gather_site.glsl"

// Squared distance in 20 bits, for the nearest to win: the rest of the word tells equals apart.
uint depthKey(float d2) { return (floatBitsToUint(d2) << 1) & ~kSampleMask; }

uint keyOf(Site s) { return hashCombine(hashCombine(s.id + 1u, push.round), push.seed); }

// First texel and end of the square that a point's disk covers. [IPP §3.2]
ivec4 splatOf(View v, float area) {
  float sum = abs(v.local.x) + abs(v.local.y) + v.local.z;
  vec3 q = v.local / sum;
  float inverse = inversesqrt(v.d2), size = float(push.microSize);
  float texels = diskSolidAngle(v, area) * inverse * size * size / microSolidAngle(q);
  float side = kSplatSide != 0u ? float(kSplatSide) : clamp(sqrt(texels), kNarrowestSplat, kWidestSplat);
  vec2 corner = microFromOctahedron(q) * size - 0.5 * (side + 1.0);
  ivec2 first = max(ivec2(ceil(corner)), ivec2(0)), end = min(ivec2(ceil(corner + side)), ivec2(push.microSize));
  return v.above ? ivec4(first, end) : ivec4(0);
}

void splat(View v, float area, uint key) {
  ivec4 square = splatOf(v, area);
  for (int y = square.y; y < square.w; ++y)
    for (int x = square.x; x < square.z; ++x) atomicMin(micro[uint(y) * push.microSize + uint(x)], key);
}

uint facing(uint point, View v) { return 2u * point + (v.sinkCosine < 0.0 ? 1u : 0u); }

uint wrap(uint slot) { return remainderOf(slot, push.clusterUsed); }

float pointArea() { return push.areaPerPoint * (float(push.clusterSize) / float(push.clusterUsed)); }

// Estimated share of the view of each cluster. [IPP eq. 1, eq. 4]
void explore(Site s, uint key) {
  uint lane = gl_LocalInvocationIndex;
  float area = pointArea() * float(push.clusterUsed) / float(kExplored), sum = 0.0;
  for (uint k = lane; k < push.clusterCount; k += kGroup) {
    uint bits = hash(key ^ k * 0x9e3779b9u);
    clusterRun[k] = bits;
    float total = 0.0;
    for (uint j = 0u; j < kExplored; ++j) {
      uint point = k * push.clusterSize + wrap(slotOf(bits, push.clusterUsed) + j);
      View v = look(s, point);
      float solidAngle = diskSolidAngle(v, area) / v.d2;  // the two lengths in it are taken out
      float value = v.local.z * s.albedo;
      if (kUseSpecular) {
        float inverse = inversesqrt(v.d2), schlick;
        float glossy = glossyValue(s, vec3(v.local.xy, max(v.local.z, 0.0)) * inverse, schlick);
        value += s.glossy ? glossy * sqrt(v.d2) * luminance(s.f0 + (s.f90 - s.f0) * schlick) : 0.0;
      }
      if (kUseGlossySources) value *= glossyStrength(facing(point, v), -v.d * inversesqrt(v.d2));
      total += v.above ? max(value * solidAngle, 0.0) : 0.0;
    }
    importance[k] = kSelection == kAtRandom ? 1.0 : total;
    sum += kSelection == kAtRandom ? 1.0 : total;
  }
  sumOfLanes[lane] = sum;
}

// Marks the first sample of each run with its cluster.
void markRuns(uint base, uint samples) {
  uint lane = gl_LocalInvocationIndex;
  for (uint i = lane; i < samples; i += kGroup) projected[base + i] = 0u;
  barrier();
  for (uint k = lane; k < push.clusterCount; k += kGroup) {
    uint end = k + 1u < push.clusterCount ? firstSample(k + 1u) : samples;
    if (end > firstSample(k)) projected[base + firstSample(k)] = k;
  }
  barrier();
}

// The cluster whose run holds `sample_`.
uint clusterOf(uint sample_) {
  uint cluster = 0u;
  for (uint step = kMostClusters / 2u; step > 0u; step >>= 1) {
    uint next = cluster + step;
    cluster = next < push.clusterCount && firstSample(min(next, kMostClusters - 1u)) <= sample_ ? next : cluster;
  }
  return cluster;
}

// What each projected point of a cluster stands for [m²]: those that explored and those drawn share it. [IPP eq. 3] A point of
// exploration alone would stand for half its cluster, and hide whatever lies behind that.
float sharedArea(uint cluster) {
  float share = clamp(importance[cluster] + float(kExplored), 1.0, float(push.clusterUsed));
  return kDiskShare * pointArea() * float(push.clusterUsed) / share;
}

void projectPoint(Site s, uint point, float area, uint number) {
  View v = look(s, point);
  projected[number] = facing(point, v);
  splat(v, area, depthKey(v.d2) | number);
}

// A run of points of every cluster, from the two that explored it on: their order is progressive, so that a run is spread
// over the cluster. Every invocation projects a stretch of the samples, and looks a cluster up where its run begins.
void exploit(Site s, uint key, uint base, uint samples) {
  for (uint k = gl_LocalInvocationIndex; k < push.clusterCount; k += kGroup) {
    uint slot = clusterRun[k] >> kSampleBits;
    float area = sharedArea(k);
    for (uint j = 0u; j < kExplored; ++j)
      projectPoint(s, k * push.clusterSize + wrap(slot + j), area, kExplored * k + j);
  }
  uint stretch = (samples + kGroup - 1u) / kGroup, first = min(gl_LocalInvocationIndex * stretch, samples);
  uint cluster = clusterOf(first), run = clusterRun[cluster];
  float area = sharedArea(cluster);
  for (uint i = first; i < min(first + stretch, samples); ++i) {
    uint begins = projected[base + i];
    if (begins > cluster) {
      cluster = begins;
      run = clusterRun[cluster];
      area = sharedArea(cluster);
    }
    uint slot = wrap((run >> kSampleBits) + kExplored + (i - (run & kSampleMask)));
    if (kSelection == kAtRandom) slot = slotOf(hash(key + i * 0x85ebca6bu), push.clusterUsed);
    projectPoint(s, cluster * push.clusterSize + slot, area, base + i);
  }
}

// Every point stands for itself alone; the nearest distance first, then the point that has it. [IPP fig. 7]
void projectAll(Site s) {
  uint count = push.clusterCount * push.clusterUsed;
  for (uint turn = 0u; turn < 2u; ++turn) {
    for (uint i = gl_LocalInvocationIndex; i < count; i += kGroup) {
      uint point = i / push.clusterUsed * push.clusterSize + i % push.clusterUsed;
      View v = look(s, point);
      ivec4 square = splatOf(v, pointArea());
      for (int y = square.y; y < square.w; ++y)
        for (int x = square.x; x < square.z; ++x) {
          uint texel = uint(y) * push.microSize + uint(x), depth = floatBitsToUint(v.d2);
          if (turn == 0u) atomicMin(micro[texel], depth);
          else if (micro[texel] == depth) atomicMin(projected[texel], facing(point, v));
        }
    }
    barrier();
  }
}

uint wordAt(ivec2 texel) {
  bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(push.microSize)));
  return inside ? micro[uint(texel.y) * push.microSize + uint(texel.x)] : kEmpty;
}

// What is put into texel `i`: where it is empty and what is around covers most sides, the nearest of that.
uint closed(uint i) {
  ivec2 t = texelPlace(i, push.microSize);
  bool atEdge = any(equal(t, ivec2(0))) || any(equal(t, ivec2(push.microSize - 1u)));
  uint covered = 0u, nearest = kEmpty;
  for (int n = 0; n < 9; ++n) {
    uint word = wordAt(t + ivec2(n % 3 - 1, n / 3 - 1));
    covered += word != kEmpty ? 1u : 0u;
    nearest = min(nearest, word);
  }
  bool hole = micro[i] == kEmpty && covered >= (atEdge ? 4u : 6u);
  return hole ? nearest : micro[i];
}

// Holes between the splats of a surface close, from their rims inwards. There are few: they are listed in importance[], and
// what goes into them waits in clusterRun[] until all have been looked at. Both have served; words of the micro-buffer may be
// no numbers, and only integers keep all their bits.
void closeHoles() {
  uint lane = gl_LocalInvocationIndex;
  if (lane == 0u) holes = 0u;
  barrier();
  for (uint i = lane; i < push.microSize * push.microSize; i += kGroup)
    if (micro[i] == kEmpty) importance[atomicAdd(holes, 1u)] = float(i);
  barrier();
  for (uint turn = 0u; turn < kHoleTurns; ++turn) {
    for (uint h = lane; h < holes; h += kGroup) clusterRun[h] = closed(uint(importance[h]));
    barrier();
    for (uint h = lane; h < holes; h += kGroup) micro[uint(importance[h])] = clusterRun[h];
    barrier();
  }
}

// Radiance that texel `i` sees and 1, or 0 where it sees nothing: light of the environment is sampled as direct light.
vec4 seen(uint i, vec3 dirW) {
  uint word = micro[i];
  bool covered = word != kEmpty;
  uint entry = covered ? projected[kSelection == kEveryPoint ? i : word & kSampleMask] : 0u;
  vec4 radiance = texelFetch(pointRadiance, int(entry));
  if (kUseGlossySources && covered && radiance.w > 0.0) radiance.rgb += lobeRadiance(entry >> 1, -dirW);
  return covered ? vec4(radiance.rgb, 1.0) : vec4(0.0);
}

vec3 toWorldOf(Site s, vec3 w) { return s.t * w.x + s.b * w.y + s.n * w.z; }

// Adds radiance from the solid angle of a texel around a point of the octahedron; returns what radiance 1 would bring to the
// viewer, up to a factor.
float addLight(inout IndirectTexel sum, Site s, vec3 q, vec3 radiance) {
  vec3 wi = normalize(q);
  float solidAngle = microSolidAngle(q) / float(push.microSize * push.microSize), factor = wi.z * s.albedo;
  sum.diffuse += radiance * (solidAngle * wi.z * kInvPi);
  if (kUseSpecular) {
    float schlick, value = glossyValue(s, wi, schlick);
    vec3 fresnel = s.f0 + (s.f90 - s.f0) * schlick;
    sum.glossy += radiance * (solidAngle * value) * (fresnel / max(s.f0, vec3(kLeastF0)));
    factor += s.glossy ? value * luminance(fresnel) : 0.0;
  }
  return factor * solidAngle;
}

void addTo(inout IndirectTexel sum, IndirectTexel more) {
  sum.diffuse += more.diffuse;
  sum.glossy += more.glossy;
}

// What the micro-buffer brings to the site, summed over the texels of this invocation.
IndirectTexel reduce(Site s) {
  IndirectTexel sum = IndirectTexel(vec3(0.0), 0.0, vec3(0.0), kIndirectSampled);
  float brought = 0.0, factors = 0.0;
  for (uint i = gl_LocalInvocationIndex; i < push.microSize * push.microSize; i += kGroup) {
    vec3 q = microTexel(i, push.microSize);
    vec4 radiance = seen(i, toWorldOf(s, normalize(q)));
    float factor = addLight(sum, s, q, radiance.rgb);
#ifdef LIMN_GATHER_CORRECT
    importance[i] = radiance.w > 0.0 ? luminance(radiance.rgb) : kNothingSeen;
    clusterRun[i] = floatBitsToUint(factor);
    brought += factor * luminance(radiance.rgb);
    factors += factor;
#endif
  }
#ifdef LIMN_GATHER_CORRECT
  sumOfLanes[gl_LocalInvocationIndex] = brought;
  factorsOfLanes[gl_LocalInvocationIndex] = factors;
#endif
  return sum;
}

#ifdef LIMN_GATHER_CORRECT
#include "shaders/gather/correction.glsl"
#endif

// The same for the site, summed in the order of invocations. In the first one.
IndirectTexel reduceAll(Site s) {
  uint lane = gl_LocalInvocationIndex;
  IndirectTexel sum = reduce(s);
#ifdef LIMN_GATHER_CORRECT
  barrier();
  if (push.correctionRays > 0u && s.valid) addTo(sum, correction(s, keyOf(s)));
#endif
  float words[6] = float[6](sum.diffuse.x, sum.diffuse.y, sum.diffuse.z, sum.glossy.x, sum.glossy.y, sum.glossy.z);
  barrier();
  for (uint c = 0u; c < 6u; ++c) importance[c * kGroup + lane] = words[c];
  barrier();
  for (uint half_ = kGroup / 2u; half_ > 0u; half_ /= 2u) {
    if (lane < half_)
      for (uint c = 0u; c < 6u; ++c) importance[c * kGroup + lane] += importance[c * kGroup + lane + half_];
    barrier();
  }
  sum.diffuse = vec3(importance[0], importance[kGroup], importance[2u * kGroup]);
  sum.glossy = vec3(importance[3u * kGroup], importance[4u * kGroup], importance[5u * kGroup]);
#ifdef LIMN_GATHER_CORRECT
  sum.diffuse = max(sum.diffuse, vec3(0.0));  // rays that find much less than the splats show
  sum.glossy = max(sum.glossy, vec3(0.0));
#endif
  return sum;
}

#if defined(LIMN_GATHER_DUMP)
void writeResult(Site s, uint entry) {
  uint count = push.microSize * push.microSize;
  for (uint i = gl_LocalInvocationIndex; i < count; i += kGroup)
    texelsOut[entry * count + i] = seen(i, toWorldOf(s, normalize(microTexel(i, push.microSize))));
}
#elif defined(LIMN_GATHER_POINTS)
void writeLight(Site s, IndirectTexel light) {
  if ((s.id & 1u) == 0u) pointLight[s.id >> 1].indirectFront = light.diffuse;
  else pointLight[s.id >> 1].indirectBack = light.diffuse;
}
#else
void writeLight(Site s, IndirectTexel light) {
  IndirectTexel before = indirect[s.id];
  if (push.round == 0u || before.state != kIndirectSampled) before = IndirectTexel(vec3(0.0), 0.0, vec3(0.0), 0.0);
  light.count = before.count + 1.0;
  light.diffuse = before.diffuse + (light.diffuse - before.diffuse) / light.count;
  light.glossy = before.glossy + (light.glossy - before.glossy) / light.count;
  indirect[s.id] = light;
}
#endif
#ifndef LIMN_GATHER_DUMP
void writeResult(Site s, uint entry) {
  IndirectTexel light = reduceAll(s);
  if (gl_LocalInvocationIndex == 0u) writeLight(s, light);
}
#endif

void project(Site s) {
  if (kSelection == kEveryPoint) {
    projectAll(s);
    return;
  }
  uint key = keyOf(s), base = kExplored * push.clusterCount, samples = push.projections - base;
  explore(s, key);
  barrier();
  float sum = 0.0;
  for (uint i = 0u; i < kGroup; ++i) sum += sumOfLanes[i];
  if (!(sum > 0.0)) return;  // nothing is above the site
  if (gl_LocalInvocationIndex == 0u) allocate(samples, push.clusterCount, push.clusterUsed, sum);
  barrier();
  markRuns(base, samples);
  exploit(s, key, base, samples);
  barrier();
  if (kSplatSide == 0u) closeHoles();
}

void main() {
  uint entry = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (entry >= push.entryCount) return;
  Site s = makeSite(siteList[push.firstEntry + entry]);
  for (uint i = gl_LocalInvocationIndex; i < kMostTexels; i += kGroup) {
    micro[i] = kEmpty;
    if (kSelection == kEveryPoint) projected[i] = kEmpty;
  }
  barrier();
  if (s.valid) project(s);  // else the micro-buffer stays empty; the same for the whole workgroup
  writeResult(s, entry);
}
