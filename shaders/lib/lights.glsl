// Next-event estimation over all lights, one chosen by power or, where there are many, by what each may bring.
#ifndef LIMN_LIGHTS_GLSL
#define LIMN_LIGHTS_GLSL
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/environment.glsl"
#include "shaders/lib/light_tree.glsl"
#include "shaders/lib/surface.glsl"

struct LightSample {
  vec3 dirW;       // unit, from the surface towards the light
  float distance;  // [m], kInfinity for directional lights and the environment
  vec3 radiance;   // arriving radiance / pdf, per unit solid angle (delta lights: intensity over their probability)
  float pdf;       // per unit solid angle, with the choice of the light; 0 for delta lights
};

const LightSample kNoLight = LightSample(vec3(0.0), 0.0, vec3(0.0), 0.0);

LightReceiver receiverOf(Surface s) {
  return LightReceiver(s.posR, s.geometricNormal, kUseTransmission && s.transmission > 0.0);
}

// The first number finds an entry of the alias table, the second decides between it and its alias; what is left of the
// second is uniform again.
uint chooseByPower(inout vec2 u) {
  uint i = min(uint(u.x * float(sceneInfo.lightCount)), sceneInfo.lightCount - 1u);
  float share = lights[i].aliasShare;
  bool keep = u.y < share;
  u.y = min(keep ? u.y / share : (u.y - share) / (1.0 - share), 0.99999994);
  return keep ? i : lights[i].alias;
}

// An index into lights[], or kNoIndex where no light of the chosen kind brings anything. The second number is uniform again
// if the light is infinitely far away.
uint chooseLight(LightReceiver at, inout vec2 u, out float probability) {
  if (kUseLightTree && sceneInfo.lightTreeShare > 0.0) {
    float share = sceneInfo.lightTreeShare;
    if (u.x < share) {
      uint index = chooseFromTree(at, vec2(min(u.x / share, 0.99999994), u.y), probability);
      probability *= share;
      return index;
    }
    u.x = min((u.x - share) / (1.0 - share), 0.99999994);
  }
  uint index = chooseByPower(u);
  probability = lights[index].probability;
  return index;
}

// That chooseLight() returns `light`.
float lightProbability(LightData light, LightReceiver at) {
  if (!kUseLightTree || light.node == kNoIndex) return light.probability;
  return sceneInfo.lightTreeShare * treeProbability(at, light.node);
}

float spotRamp(LightData light, vec3 dirToLight) {
  float ramp = clamp(dot(light.dirR, -dirToLight) * light.spotScale + light.spotOffset, 0.0, 1.0);
  return ramp * ramp;
}

// glTF's smooth cut at the range. [KHR_lights_punctual]
float rangeWindow(LightData light, float d) {
  float x = d * light.invRange, x2 = x * x;
  return clamp(1.0 - x2 * x2, 0.0, 1.0);
}

// What a place of a triangle light sends along the unit vector `dirW`, on average over what alpha lets through: rays meet the
// place as often as its alpha says.
vec3 triangleEmission(uint triangle, vec2 barycentrics, vec3 dirW) {
  uvec4 t = texelFetch(triangles, int(triangle));
  bool partial = kUseAlpha && (materials[t.w].flags & (kMaterialMask | kMaterialBlend)) != 0u;
  vec3 emission = materials[t.w].emission * (partial ? surfaceAlpha(triangle, barycentrics) : 1.0);
  if (kUseClearcoat && materials[t.w].clearcoat > 0.0)
    emission *= underClearcoat(makeSurface(triangle, barycentrics, dirW), dirW);
  if (!kUseTextures) return emission;
  Attributes a = interpolate(t.xyz, vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics));
  uint first = materials[t.w].firstSlot, count = materials[t.w].slotCount;
  for (uint i = 0u; i < count; ++i)
    if (textureSlots[first + i].target == kTargetEmissive)
      emission *= sampleTexture(textureSlots[first + i], a.uv0, a.uv1).rgb;
  return emission;
}

// pdf of light sampling for the point of triangle light `light`, chosen with `probability`, at distance d, seen under |cos|
// at the light.
float triangleLightPdf(LightData light, float probability, float d, float cosLight) {
  return probability * d * d / (light.area * max(cosLight, 1e-7));
}

// The shadow ray stops short of the emitter itself, by more than its hit is rounded: in proportion to the distance, and
// by the corners' own digits across its plane.
float distanceShortOf(vec3 corner, float edge, float cosLight, float d) {
  float rounding = (maxComponent(abs(corner)) + edge) * (8.0 / 16777216.0);
  return d * (1.0 - 2e-5) - min(rounding / max(cosLight, 1e-7), 0.1 * d);
}

LightSample sampleTriangleLight(LightData light, float probability, vec3 p, vec2 u) {
  uvec4 t = texelFetch(triangles, int(light.triangle));
  vec3 p0 = texelFetch(positions, int(t.x)).xyz;
  vec3 e1 = texelFetch(positions, int(t.y)).xyz - p0, e2 = texelFetch(positions, int(t.z)).xyz - p0;
  vec2 barycentrics = sampleTriangle(u);
  vec3 toLight = p0 + e1 * barycentrics.x + e2 * barycentrics.y - p;
  float d = length(toLight);
  LightSample s = kNoLight;
  if (!(d > 0.0)) return s;
  s.dirW = toLight / d;
  float scale = max(maxComponent(abs(e1)), maxComponent(abs(e2)));
  float cosLight = abs(dot(normalize(cross(e1 / scale, e2 / scale)), s.dirW));
  if (!(cosLight > 1e-7)) return s;
  s.distance = distanceShortOf(p0, scale, cosLight, d);
  s.pdf = triangleLightPdf(light, probability, d, cosLight);
  s.radiance = triangleEmission(light.triangle, barycentrics, -s.dirW) / s.pdf;
  return s;
}

// A light that was chosen with `probability`; `uAlias` is what the choice left of its second number.
LightSample sampleChosenLight(LightData light, float probability, vec3 p, float uAlias, vec2 u) {
  LightSample s = kNoLight;
  if (kUseTriangleLights && light.type == kLightTriangle) return sampleTriangleLight(light, probability, p, u);
  if (kUseEnvironment && light.type == kLightEnvironment) {
    s.dirW = sampleEnvironment(u, uAlias, s.pdf);
    s.pdf *= probability;
    s.distance = kInfinity;
    s.radiance = s.pdf > 0.0 ? environmentRadiance(s.dirW) / s.pdf : vec3(0.0);
    return s;
  }
  if (!kUsePunctualLights) return s;
  if (light.type == kLightDirectional) {
    s.dirW = -light.dirR;
    s.distance = kInfinity;
    s.radiance = light.color / probability;
    return s;
  }
  vec3 toLight = light.posR - p;
  float d = length(toLight);
  if (!(d > 0.0)) return s;
  s.dirW = toLight / d;
  s.distance = d * (1.0 - 2e-5);  // a surface that the light lies on does not hide it
  float window = rangeWindow(light, d);
  if (light.type == kLightSpot) window *= spotRamp(light, s.dirW);
  s.radiance = light.color * (window / probability) / d / d;
  return s;
}

LightSample sampleLight(LightReceiver at, vec2 choice, vec2 u) {
  if (sceneInfo.lightCount == 0u) return kNoLight;
  float probability;
  uint index = chooseLight(at, choice, probability);
  if (kUseLightTree && index == kNoIndex) return kNoLight;
  return sampleChosenLight(lights[index], probability, at.posR, choice.y, u);
}

#endif
