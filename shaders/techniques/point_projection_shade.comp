// One sample of each pixel of a list: direct light by next-event estimation at full resolution, lobes too narrow for splats
// followed by rays to the first surface without one, gathered light looked up. [IPP §3.3, §4]
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/lib/scene_bindings.glsl"
layout(constant_id = 12) const bool kUseSharp = true;
#include "shaders/lib/film.glsl"
#include "shaders/lib/lobe_split.glsl"
#include "shaders/lib/camera.glsl"
#include "shaders/lib/alpha.glsl"
#define LIMN_ALPHA
#define LIMN_ALPHA_ENABLED kUseAlpha
#include "shaders/lib/shadow.glsl"
#define LIMN_INDIRECT_ACCESS readonly
#include "shaders/lib/joint_bilateral.glsl"
#include "shaders/lib/point_grid.glsl"

layout(local_size_x = 64) in;
layout(binding = BINDING_PIXEL_LIST, scalar) readonly buffer PixelList { uint pixelList[]; };
layout(binding = BINDING_COUNTERS, scalar) buffer Counters { uint counters[]; };
layout(binding = BINDING_INDIRECT_SUM, scalar) buffer LookedUp { vec4 lookedUp[]; };  // mean of looked-up light, count
layout(push_constant, scalar) uniform Push { ShadePush push; };

const uint kLongestChain = 8u;  // surfaces that rays follow sharp lobes through

struct Walk {
  Sampler sampler_;
  vec2 pixel;         // continuous, where the ray left
  vec3 originR, dirR;
  vec3 throughput;
  vec3 absorption;    // [1/m] of the medium the ray is in
  float lobePdf;      // of dirR; 0 after a mirror or from the camera
  LightReceiver from; // whom lights were chosen for where the ray last scattered
  float travelled;    // [m] from there, or from the eye, to originR, through panes
  uint depth;         // surfaces met before
  uint scatterings;   // of which were no panes that the ray passed
  FilmSample result;  // all light that no gather brought
  vec3 gathered;
};

Walk startWalk(uint pixel) {
  Walk w;
  w.sampler_ = makeFilmSampler(pixel, push.sampleIndex, push.seed);
  vec2 offset = next2D(w.sampler_);
  w.pixel = vec2(pixel % camera.width, pixel / camera.width) + (push.sampleIndex == 0u ? vec2(0.5) : offset);
  cameraRay(w.pixel, w.originR, w.dirR);
  w.throughput = vec3(1.0);
  w.absorption = vec3(0.0);
  w.lobePdf = 0.0;
  w.from = LightReceiver(vec3(0.0), vec3(0.0), false);
  w.travelled = distanceToEye(w.originR);
  w.depth = w.scatterings = 0u;
  w.result = FilmSample(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0);
  w.gathered = vec3(0.0);
  return w;
}

void addRadiance(inout Walk w, vec3 radiance, uint scatterings) {
  w.result.radiance += radiance;
  if (scatterings <= 1u) w.result.direct += radiance;
}

void addEnvironment(inout Walk w) {
  if (!kUseEnvironment || sceneInfo.environmentLight == kNoIndex) return;
  float weight = 1.0;
  if (w.lobePdf > 0.0)
    weight = powerHeuristic(w.lobePdf, lights[sceneInfo.environmentLight].probability * environmentPdf(w.dirR));
  addRadiance(w, w.throughput * environmentRadiance(w.dirR) * weight, w.scatterings);
}

void addEmission(inout Walk w, Surface s, Hit hit) {
  float weight = 1.0;
  uint index = texelFetch(triangleLights, int(hit.triangle)).x;
  if (w.lobePdf > 0.0 && index != kNoIndex) {
    float probability = lightProbability(lights[index], w.from), cosLight = abs(dot(s.geometricNormal, w.dirR));
    weight = powerHeuristic(w.lobePdf, triangleLightPdf(lights[index], probability, w.travelled + hit.t, cosLight));
  }
  addRadiance(w, w.throughput * s.emission * (underClearcoat(s, -w.dirR) * weight), w.scatterings);
}

uint alphaKey(Walk w, uint salt) { return hashCombine(w.sampler_.key ^ salt, w.sampler_.index ^ (w.depth << 24)); }

// Rough lobes are lit by this alone; narrow ones share the work with the ray that follows them.
void addLights(inout Walk w, Bsdf rough, Bsdf sharp, vec3 woW) {
  vec2 choice = next2D(w.sampler_), u = next2D(w.sampler_);
  LightSample light = sampleLight(receiverOf(rough.s), choice, u);
  if (!(maxComponent(light.radiance) > 0.0)) return;
  float pdf;
  vec3 value = evaluateBsdf(rough, woW, light.dirW, pdf);
  if (kUseSharp) {
    vec3 narrow = evaluateBsdf(sharp, woW, light.dirW, pdf);
    value += narrow * (light.pdf > 0.0 ? powerHeuristic(light.pdf, pdf) : 1.0);
  }
  if (!(maxComponent(value) > 0.0)) return;
  vec3 share = shareThatArrives(rough.s, light, absorptionTowards(w.absorption, rough.s, light), alphaKey(w, 0u));
  addRadiance(w, w.throughput * value * light.radiance * share, w.scatterings + 1u);
}

// At the first surface the pixels around know more; behind a mirror the points do.
void addGathered(inout Walk w, Bsdf rough, vec3 woW) {
  if (push.directOnly != 0u) return;
  vec3 albedo = gatheredAlbedo(rough) * underClearcoat(rough, woW), reflectance = gatheredReflectance(rough) * underClearcoat(rough, woW);
  IndirectTexel light;
  if (w.depth == 0u) {
    lookUpIndirect(w.pixel, ivec2(camera.width, camera.height), rough.s.posR, rough.s.normal, rough.s.material, light);
  } else {
    light.diffuse = lookUpPointGrid(rough.s.posR, rough.s.normal, rough.s.frontFace ? kGridFront : kGridBack).indirect;
    light.glossy = light.diffuse;
  }
  w.gathered += w.throughput * (albedo * light.diffuse + reflectance * light.glossy);
}

// Turns the ray into a narrow lobe of the surface. False when the surface has none.
bool followSharpLobe(inout Walk w, Bsdf bsdf, Bsdf sharp, vec3 woW, float t) {
  if (!kUseSharp || !hasSharpPart(bsdf)) return false;
  vec2 lobe = next2D(w.sampler_), u = next2D(w.sampler_);
  BsdfSample next = sampleBsdf(sharp, woW, lobe.x, u);
  if (!(maxComponent(next.weight) > 0.0)) return false;
  w.throughput *= next.weight;
  if (passesPane(sharp, next)) {
    w.travelled += t;
  } else {
    w.lobePdf = next.mirror ? 0.0 : next.pdf;
    w.from = receiverOf(bsdf.s);
    w.travelled = 0.0;
    ++w.scatterings;
  }
  if (kUseTransmission && next.transmitted && !bsdf.thin)
    w.absorption = bsdf.s.frontFace ? materials[bsdf.s.material].absorption : vec3(0.0);
  w.originR = offsetOrigin(bsdf.s.posR, bsdf.s.geometricNormal, next.dirW, bsdf.s.extent);
  w.dirR = next.dirW;
  if (w.depth >= 1u) {  // Russian roulette
    float survive = min(1.0, maxComponent(w.throughput) * 2.0);
    if (lobe.y >= survive) return false;
    w.throughput /= survive;
  }
  ++w.depth;
  return w.scatterings <= kLongestChain && w.depth <= kLongestChain + kMostPanes;
}

// Follows the walk to its next surface. False when it ended there.
bool advance(inout Walk w) {
  Hit hit;
  uint alphaState = alphaKey(w, 0x51ed270bu);
  ++traceCount;
  bool met = traceClosest(w.originR, w.dirR, kInfinity, alphaState, hit);
  if (kUseTransmission && w.absorption != vec3(0.0)) w.throughput *= exp(-w.absorption * (met ? hit.t : kInfinity));
  if (!met) {
    addEnvironment(w);
    return false;
  }
  vec3 woW = -w.dirR;
  Surface s = makeSurface(hit.triangle, hit.barycentrics, woW);
  if (w.depth == 0u) {
    w.result.albedo = s.baseColor;
    w.result.normal = s.normal;
    w.result.depth = w.travelled + hit.t;
    w.result.hit = 1.0;
  }
  if ((s.flags & kMaterialUnlit) != 0u) {
    addRadiance(w, w.throughput * s.baseColor, w.scatterings);
    return false;
  }
  if (kUseTriangleLights && (s.flags & kMaterialEmissive) != 0u) addEmission(w, s, hit);
  Bsdf bsdf = makeBsdf(s, woW), rough = roughPart(bsdf), sharp = sharpPart(bsdf);
  addLights(w, rough, sharp, woW);
  addGathered(w, rough, woW);
  return followSharpLobe(w, bsdf, sharp, woW, hit.t);
}

// Looked-up light goes stale when more of it is gathered, everything else is kept: the two means are apart, and the film
// holds their sum. Of stale light a share stays: where a first sample happens to look past an edge, the pixel would be black.
const float kOlderShare = 0.25;  // of the passes, or of the samples where they are fewer, that an older mean counts for

void addToFilm(uint pixel, FilmSample s, vec3 gathered) {
  FilmPixel film = readFilm(pixel);
  vec4 before = lookedUp[pixel];
  if (push.firstOfFilm != 0u || film.mean.w == 0.0) {
    film = FilmPixel(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    before = vec4(0.0);
  }
  vec4 after = before;
  if (push.firstOfGather != 0u) after.w = kOlderShare * min(after.w, float(push.passes));
  after.w += 1.0;
  after.rgb += (gathered - after.rgb) / after.w;
  film.mean.rgb -= before.rgb;
  film.half_.rgb -= film.direct.w > 0.0 ? before.rgb : vec3(0.0);
  addSample(film, s, (push.sampleIndex & 1u) == 0u);
  film.mean.rgb += after.rgb;
  film.half_.rgb += film.direct.w > 0.0 ? after.rgb : vec3(0.0);
  writeFilm(pixel, film);
  lookedUp[pixel] = after;
}

// Nothing of a preview stays where the first sample is no good.
void discard_(uint pixel) {
  if (push.firstOfFilm != 0u) filmMean[pixel] = vec4(0.0);
  atomicAdd(counters[kCounterDiscarded], 1u);
}

bool acceptable(vec3 radiance) { return isFinite(radiance) && all(greaterThanEqual(radiance, vec3(0.0))); }

void main() {
  uint entry = gl_GlobalInvocationID.x;
  if (entry >= push.entryCount) return;
  uint pixel = pixelList[push.firstEntry + entry];
  Walk w = startWalk(pixel);
  while (advance(w)) {}
  if (acceptable(w.result.radiance) && acceptable(w.gathered)) addToFilm(pixel, w.result, w.gathered);
  else discard_(pixel);
  uint before = atomicAdd(counters[kCounterRays], traceCount);
  if (before + traceCount < before) atomicAdd(counters[kCounterRays + 1u], 1u);
}
