// The trace functions' question whether a hit on a MASK or BLEND triangle counts: always with its alpha as probability.
#ifndef LIMN_ALPHA_GLSL
#define LIMN_ALPHA_GLSL
#include "shaders/lib/sampling.glsl"
#include "shaders/lib/surface.glsl"

bool alphaAccepts(uint triangle, vec2 barycentrics, inout uint state) {
  if (!kUseAlpha) return true;
  float alpha = surfaceAlpha(triangle, barycentrics);
  // Keyed by the triangle, so that the order in which the hierarchy meets the hits does not matter.
  return toUnit(hashCombine(state, triangle)) < alpha;
}

#endif
