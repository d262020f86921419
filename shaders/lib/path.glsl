// A walk from surface to surface with next-event estimation and multiple importance sampling [Veach 1997]. The includer
// declares the scene's bindings before this, and gives a new path its first ray.
#ifndef LIMN_PATH_GLSL
#define LIMN_PATH_GLSL
#include "shaders/lib/film_sample.glsl"
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/lights.glsl"
#include "shaders/lib/alpha.glsl"
#define LIMN_ALPHA
#define LIMN_ALPHA_ENABLED kUseAlpha
#include "shaders/lib/shadow.glsl"

// How many scatterings light of unlit surfaces has had before it leaves them. 1: where a path begins at something that light
// sampling lit before, it is that which light sampling does not find.
#ifndef LIMN_UNLIT_AFTER
#define LIMN_UNLIT_AFTER 0u
#endif

struct Path {
  Sampler sampler_;
  vec3 originR, dirR;
  vec3 throughput;
  float etaScale;      // undoes the radiance scaling of refraction for Russian roulette
  float bsdfPdf;       // of dirR; 0 after a mirror or from the camera
  LightReceiver from;  // whom lights were chosen for where the path last scattered
  float travelled;     // [m] from there, or from the eye, to originR, through panes
  vec3 absorption;     // [1/m] of the medium the ray is in
  uint bounce;         // surfaces scattered at, mirrors included, panes that were passed not
  uint maxBounces;     // after which no surface scatters any more
  uint rouletteStart;  // scatterings from which on Russian roulette ends paths
  FilmSample result;
};

Path newPath(Sampler sampler_, uint maxBounces, uint rouletteStart) {
  Path p;
  p.sampler_ = sampler_;
  p.throughput = vec3(1.0);
  p.etaScale = 1.0;
  p.bsdfPdf = 0.0;
  p.from = LightReceiver(vec3(0.0), vec3(0.0), false);
  p.travelled = 0.0;
  p.absorption = vec3(0.0);
  p.bounce = 0u;
  p.maxBounces = maxBounces;
  p.rouletteStart = rouletteStart;
  p.result = FilmSample(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0);
  return p;
}

// Light that reaches the eye after at most one scattering is direct.
void addRadiance(inout Path p, vec3 radiance, uint scatterings) {
  p.result.radiance += radiance;
  if (scatterings <= 1u) p.result.direct += radiance;
}

void addEnvironment(inout Path p) {
  if (!kUseEnvironment || sceneInfo.environmentLight == kNoIndex) return;
  float weight = 1.0;
  if (p.bsdfPdf > 0.0)
    weight = powerHeuristic(p.bsdfPdf, lights[sceneInfo.environmentLight].probability * environmentPdf(p.dirR));
  addRadiance(p, p.throughput * environmentRadiance(p.dirR) * weight, p.bounce);
}

void addEmission(inout Path p, Surface s, Hit hit) {
  float weight = 1.0;
  uint index = texelFetch(triangleLights, int(hit.triangle)).x;
  if (p.bsdfPdf > 0.0 && index != kNoIndex) {
    float probability = lightProbability(lights[index], p.from), cosLight = abs(dot(s.geometricNormal, p.dirR));
    weight = powerHeuristic(p.bsdfPdf, triangleLightPdf(lights[index], probability, p.travelled + hit.t, cosLight));
  }
  addRadiance(p, p.throughput * s.emission * (underClearcoat(s, -p.dirR) * weight), p.bounce);
}

void addLights(inout Path p, Bsdf bsdf, vec3 woW) {
  vec2 choice = next2D(p.sampler_), u = next2D(p.sampler_);
  if (bsdf.shares.diffuse <= 0.0 && isMirror(bsdf.s.alpha) && bsdf.s.clearcoat <= 0.0) return;
  LightSample light = sampleLight(receiverOf(bsdf.s), choice, u);
  if (!(maxComponent(light.radiance) > 0.0)) return;
  float bsdfPdf;
  vec3 value = evaluateBsdf(bsdf, woW, light.dirW, bsdfPdf);
  if (!(maxComponent(value) > 0.0)) return;
  uint alphaState = hashCombine(p.sampler_.key, p.sampler_.index ^ (p.bounce << 24));
  vec3 share = shareThatArrives(bsdf.s, light, absorptionTowards(p.absorption, bsdf.s, light), alphaState);
  float weight = light.pdf > 0.0 ? powerHeuristic(light.pdf, bsdfPdf) : 1.0;
  addRadiance(p, p.throughput * value * light.radiance * share * weight, p.bounce + 1u);
}

// Moves the path by one ray. False when it ended.
bool advance(inout Path p) {
  Hit hit;
  uint alphaState = hashCombine(p.sampler_.key ^ 0x51ed270bu, p.sampler_.index ^ (p.bounce << 24));
  ++traceCount;
  bool met = traceClosest(p.originR, p.dirR, kInfinity, alphaState, hit);
  if (kUseTransmission && p.absorption != vec3(0.0)) p.throughput *= exp(-p.absorption * (met ? hit.t : kInfinity));
  if (!met) {
    addEnvironment(p);
    return false;
  }
  vec3 woW = -p.dirR;
  Surface s = makeSurface(hit.triangle, hit.barycentrics, woW);
  if (p.result.hit == 0.0) {
    p.result.albedo = s.baseColor;
    p.result.normal = s.normal;
    p.result.depth = p.travelled + hit.t;
    p.result.hit = 1.0;
  }
  if ((s.flags & kMaterialUnlit) != 0u) {
    addRadiance(p, p.throughput * s.baseColor, p.bounce + LIMN_UNLIT_AFTER);
    return false;
  }
  if (kUseTriangleLights && (s.flags & kMaterialEmissive) != 0u) addEmission(p, s, hit);
  bool ends = p.bounce > p.maxBounces;
  if (ends && !kUsePanes) return false;

  Bsdf bsdf = makeBsdf(s, woW);
  if (!ends) addLights(p, bsdf, woW);
  vec2 lobe = next2D(p.sampler_), u = next2D(p.sampler_);
  BsdfSample next = sampleBsdf(bsdf, woW, lobe.x, u);
  if (!(maxComponent(next.weight) > 0.0)) return false;

  p.throughput *= next.weight;
  if (passesPane(bsdf, next)) {
    p.travelled += hit.t;
  } else {
    if (ends) return false;
    p.bsdfPdf = next.mirror ? 0.0 : next.pdf;
    p.from = receiverOf(s);
    p.travelled = 0.0;
    ++p.bounce;
  }
  if (kUseTransmission && next.transmitted && !bsdf.thin) {
    p.absorption = s.frontFace ? materials[s.material].absorption : vec3(0.0);
    p.etaScale *= bsdf.eta * bsdf.eta;
  }
  p.originR = offsetOrigin(s.posR, s.geometricNormal, next.dirW, s.extent);
  p.dirR = next.dirW;
  if (p.bounce >= p.rouletteStart) {
    float survive = min(0.95, maxComponent(p.throughput) * p.etaScale);
    if (lobe.y >= survive) return false;
    p.throughput /= survive;
  }
  return true;
}

bool acceptable(FilmSample s) { return isFinite(s.radiance) && all(greaterThanEqual(s.radiance, vec3(0.0))); }

#endif
