// Radiance to display values in [0, 1], linear Rec. 709 in and out.
#ifndef LIMN_TONE_MAP_GLSL
#define LIMN_TONE_MAP_GLSL
#include "shaders/lib/math.glsl"

// Khronos PBR Neutral: keeps hue and the lower range as they are. [KhronosGroup/ToneMapping, PBR_Neutral]
vec3 toneMapPbrNeutral(vec3 color) {
  const float kStart = 0.8 - 0.04, kDesaturation = 0.15;
  float low = min(color.r, min(color.g, color.b));
  color -= low < 0.08 ? low - 6.25 * low * low : 0.04;
  float peak = maxComponent(color);
  if (peak < kStart) return color;
  float d = 1.0 - kStart;
  float newPeak = 1.0 - d * d / (peak + d - kStart);
  color *= newPeak / peak;
  float g = 1.0 - 1.0 / (kDesaturation * (peak - newPeak) + 1.0);
  return mix(color, vec3(newPeak), g);
}

// The fit of the ACES RRT and ODT by S. Hill.
vec3 toneMapAces(vec3 color) {
  const mat3 kIn = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
  const mat3 kOut = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
  vec3 v = kIn * color;
  v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  return clamp(kOut * v, 0.0, 1.0);
}

// AgX with the default contrast polynomial of B. Wrensch; the result is linear.
vec3 toneMapAgx(vec3 color) {
  const mat3 kIn = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                        0.0784335999999992, 0.878468636469772, 0.0784336,
                        0.0792237451477643, 0.0791661274605434, 0.879142973793104);
  const mat3 kOut = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                         -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                         -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
  const float kMinEv = -12.47393, kMaxEv = 4.026069;
  vec3 x = kIn * max(color, vec3(0.0));
  x = (clamp(log2(max(x, vec3(1e-10))), kMinEv, kMaxEv) - kMinEv) / (kMaxEv - kMinEv);
  vec3 x2 = x * x, x4 = x2 * x2;
  x = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
  return pow(clamp(kOut * x, 0.0, 1.0), vec3(2.2));
}

// `map` counts as limn::ToneMap does.
vec3 toneMap(vec3 color, uint map) {
  if (map == 0u) return toneMapPbrNeutral(color);
  if (map == 1u) return toneMapAces(color);
  if (map == 2u) return toneMapAgx(color);
  return color;
}

vec3 linearToSrgb(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

#endif
