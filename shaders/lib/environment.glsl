// Radiance from infinitely far away and its importance table (gpu/environment_table.hpp builds it).
#ifndef LIMN_ENVIRONMENT_GLSL
#define LIMN_ENVIRONMENT_GLSL
#include "shaders/lib/sampling.glsl"

// Latitude-longitude coordinates of a direction: u around +y, v from +y down.
vec2 environmentUv(vec3 dirW) {
  float phi = atan(dirW.z, dirW.x) + sceneInfo.environmentRotation;
  return vec2(fract(phi * (0.5 * kInvPi) + 0.5), acos(clamp(dirW.y, -1.0, 1.0)) * kInvPi);
}
vec3 environmentDirection(vec2 uv) {
  float phi = (uv.x - 0.5) * 2.0 * kPi - sceneInfo.environmentRotation, theta = uv.y * kPi;
  return vec3(sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi));
}

vec3 environmentTexel(int x, int y) {
  int w = int(sceneInfo.environmentWidth), h = int(sceneInfo.environmentHeight);
  x = x < 0 ? x + w : x >= w ? x - w : x;
  return texelFetch(environmentTexels, clamp(y, 0, h - 1) * w + x).rgb;
}

vec3 environmentRadiance(vec3 dirW) {
  if (!kUseEnvironmentImage || sceneInfo.environmentWidth == 0u) return sceneInfo.environmentRadiance;
  vec2 st = environmentUv(dirW) * vec2(sceneInfo.environmentWidth, sceneInfo.environmentHeight) - 0.5;
  vec2 base = floor(st), f = st - base;
  ivec2 p = ivec2(base);
  vec3 a = mix(environmentTexel(p.x, p.y), environmentTexel(p.x + 1, p.y), f.x);
  vec3 b = mix(environmentTexel(p.x, p.y + 1), environmentTexel(p.x + 1, p.y + 1), f.x);
  return mix(a, b, f.y) * sceneInfo.environmentRadiance;
}

// Cells have equal size in u and in cos(theta), so that each covers the same solid angle.
float cellPdf(uint cell) {
  float cells = float(sceneInfo.distributionWidth * sceneInfo.distributionHeight);
  return uintBitsToFloat(texelFetch(environmentTable, int(cell)).z) * cells / (4.0 * kPi);
}

// Per unit solid angle.
float environmentPdf(vec3 dirW) {
  if (!kUseEnvironmentImage || sceneInfo.distributionWidth == 0u) return 0.25 * kInvPi;
  float u = environmentUv(dirW).x, v = 0.5 - 0.5 * clamp(dirW.y, -1.0, 1.0);
  uint x = min(uint(u * float(sceneInfo.distributionWidth)), sceneInfo.distributionWidth - 1u);
  uint y = min(uint(v * float(sceneInfo.distributionHeight)), sceneInfo.distributionHeight - 1u);
  return cellPdf(y * sceneInfo.distributionWidth + x);
}

// `uAlias` decides between a cell and its alias: the digits that a table of 512 x 256 cells leaves to u.x are too few
// for that.
vec3 sampleEnvironment(vec2 u, float uAlias, out float pdf) {
  if (!kUseEnvironmentImage || sceneInfo.distributionWidth == 0u) {
    pdf = 0.25 * kInvPi;
    return sampleSphere(u);
  }
  float cells = float(sceneInfo.distributionWidth * sceneInfo.distributionHeight);
  float scaled = min(u.x * cells, cells - 0.5);
  uint cell = uint(scaled);
  float share =
      scaled - float(cell) + cells * (0.5 / 16777216.0);  // the middle of u.x's last digit, off the cell's border
  uvec4 entry = texelFetch(environmentTable, int(cell));
  if (uAlias >= uintBitsToFloat(entry.x)) cell = entry.y;
  pdf = cellPdf(cell);
  uint x = cell % sceneInfo.distributionWidth, y = cell / sceneInfo.distributionWidth;
  float uu = (float(x) + clamp(share, 0.0, 0.999999)) / float(sceneInfo.distributionWidth);
  float cosTheta = 1.0 - 2.0 * (float(y) + u.y) / float(sceneInfo.distributionHeight);
  float phi = (uu - 0.5) * 2.0 * kPi - sceneInfo.environmentRotation;
  float sinTheta = sqrt(max(0.0, 1.0 - cosTheta * cosTheta));
  return vec3(sinTheta * cos(phi), cosTheta, sinTheta * sin(phi));
}

#endif
