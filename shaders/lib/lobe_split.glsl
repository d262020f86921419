// A BSDF in two parts: what a gather over points can integrate, and lobes too narrow for splats, which rays follow.
// The parts add up to the whole. [IPP §6]
#ifndef LIMN_LOBE_SPLIT_GLSL
#define LIMN_LOBE_SPLIT_GLSL
#include "shaders/lib/bsdf.glsl"
#include "shaders/shared/gather_shared.h"

bool hasSharpBase(Bsdf f) { return f.s.alpha < kSplatAlpha || f.shares.transmission > 0.0; }

// Diffuse and rough reflection. Its shares tell what is in it, not how to sample it.
Bsdf roughPart(Bsdf f) {
  if (kUseSharp && hasSharpBase(f)) f.shares.reflection = 0.0;
  f.shares.transmission = f.shares.clearcoat = 0.0;
  return f;
}

// Everything else, with shares that add to 1; all are 0 where nothing is sharp.
Bsdf sharpPart(Bsdf f) {
  f.shares.diffuse = 0.0;
  f.diffuse = false;
  if (!hasSharpBase(f)) f.shares.reflection = f.shares.transmission = 0.0;
  float sum = f.shares.reflection + f.shares.transmission + f.shares.clearcoat;
  float scale = sum > 0.0 ? 1.0 / sum : 0.0;
  f.shares.reflection *= scale;
  f.shares.transmission *= scale;
  f.shares.clearcoat *= scale;
  return f;
}
bool hasSharpPart(Bsdf f) { return f.shares.clearcoat > 0.0 || (hasSharpBase(f) && f.shares.reflection + f.shares.transmission > 0.0); }

// Reflectance of the diffuse lobe where as much arrives from everywhere; multiplies IndirectTexel.diffuse.
vec3 gatheredAlbedo(Bsdf f) {
  float under = f.exactFresnel ? 1.0 - maxComponent(dielectricFresnel(f, 1.0))
                               : f.underSpecular * meanThroughSpecular(f);
  return f.s.baseColor * ((1.0 - f.s.metallic) * (1.0 - f.s.transmission) * max(under, 0.0));
}
// Reflectance of the rough glossy lobe at normal incidence; multiplies IndirectTexel.glossy.
vec3 gatheredReflectance(Bsdf f) {
  return kUseSpecular && f.shares.reflection > 0.0 ? reflectionFresnel(f, 1.0) : vec3(0.0);
}

#endif
