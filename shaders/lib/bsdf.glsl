// glTF metallic-roughness with specular, transmission and clearcoat: value, sampling and pdf of the whole mixture.
// Directions point away from the surface. Values include the cosine at the light's side.
#ifndef LIMN_BSDF_GLSL
#define LIMN_BSDF_GLSL
#include "shaders/lib/ggx.glsl"
#include "shaders/lib/ggx_albedo.glsl"
#include "shaders/lib/sampling.glsl"
#include "shaders/lib/surface.glsl"

struct BsdfSample {
  vec3 dirW;
  vec3 weight;      // value * |cos| / pdf
  float pdf;        // per unit solid angle; 0 for a mirror direction
  bool mirror;      // a delta direction: light sampling cannot find it
  bool transmitted; // leaves on the other side
};

// Probabilities of the lobes; they add to 1.
struct LobeShares { float diffuse, reflection, transmission, clearcoat; };

struct Bsdf {
  Surface s;
  vec3 t, b;              // with s.normal a frame
  vec3 dielectricF0;      // reflectance at normal incidence
  float dielectricF90;
  float eta;              // ior far side / near side as the viewer sees it
  bool exactFresnel;      // transmissive materials need total internal reflection; opaque ones follow glTF's Schlick
  bool thin;
  bool diffuse;           // false: the diffuse lobe is left to somebody else (lobe_split.glsl)
  float underSpecular;    // what an opaque dielectric's specular layer leaves to the diffuse one, by the viewer's angle
  LobeShares shares;
  vec3 woL;               // the viewer in the frame
};

vec3 toLocal(Bsdf f, vec3 w) { return vec3(dot(w, f.t), dot(w, f.b), dot(w, f.s.normal)); }
vec3 toWorld(Bsdf f, vec3 w) { return f.t * w.x + f.b * w.y + f.s.normal * w.z; }

vec3 dielectricFresnel(Bsdf f, float cosH) {
  if (f.exactFresnel) return min(f.s.specularColor * fresnelDielectric(cosH, f.eta), vec3(1.0)) * f.s.specular;
  return f.dielectricF0 + (f.dielectricF90 - f.dielectricF0) * schlickWeight(cosH);
}
vec3 metalFresnel(Bsdf f, float cosH) { return f.s.baseColor + (1.0 - f.s.baseColor) * schlickWeight(cosH); }
vec3 reflectionFresnel(Bsdf f, float cosH) {
  return mix(dielectricFresnel(f, cosH), metalFresnel(f, cosH), f.s.metallic);
}
float clearcoatFresnel(float cosH) { return 0.04 + 0.96 * schlickWeight(cosH); }

// What all microfacets reflect, by what they would reflect fully and by Schlick's weights (ggx_albedo.glsl).
vec3 dielectricAlbedo(Bsdf f, float albedo, float schlickAlbedo) {
  return f.dielectricF0 * albedo + (f.dielectricF90 - f.dielectricF0) * schlickAlbedo;
}
vec3 metalAlbedo(Bsdf f, float albedo, float schlickAlbedo) {
  return f.s.baseColor * albedo + (1.0 - f.s.baseColor) * schlickAlbedo;
}

// What an opaque dielectric's specular layer lets through, in the channel where that is least; less by the error of the
// fit, so that both layers together never send back more than arrives.
float throughSpecular(Bsdf f, float albedo, float schlickAlbedo) {
  const float kFitError = 0.004;
  return max(1.0 - maxComponent(dielectricAlbedo(f, albedo, schlickAlbedo)) - kFitError * f.dielectricF90, 0.0);
}
float throughSpecular(Bsdf f, float cosTheta) {
  return throughSpecular(f, ggxAlbedo(cosTheta, f.s.alpha), ggxSchlickAlbedo(cosTheta, f.s.alpha));
}
float meanThroughSpecular(Bsdf f) { return throughSpecular(f, meanGgxAlbedo(f.s.alpha), meanGgxSchlickAlbedo(f.s.alpha)); }

// Albedo of a white diffuse layer under a dielectric's specular one where light comes in at `cosI`. It is reciprocal, and
// what both layers reflect adds up to what arrives [Kelemen and Szirmay-Kalos 2001]; glTF's mix by Fresnel's factor of the
// half vector adds up to 1.8 times that at grazing angles. Transmissive materials keep glTF's.
float diffuseUnderSpecular(Bsdf f, float cosI, float cosH) {
  if (f.exactFresnel) return 1.0 - maxComponent(dielectricFresnel(f, cosH));
  return kUseSpecular ? f.underSpecular * throughSpecular(f, cosI) : 1.0;
}

// What the coat leaves to the layers below, emission among them, seen from the viewer. [KHR_materials_clearcoat]
float underClearcoat(Surface s, vec3 woW) {
  return kUseClearcoat ? 1.0 - s.clearcoat * clearcoatFresnel(abs(dot(s.clearcoatNormal, woW))) : 1.0;
}
float underClearcoat(Bsdf f, vec3 woW) { return underClearcoat(f.s, woW); }

Bsdf makeBsdf(Surface s, vec3 woW) {
  Bsdf f;
  f.s = s;
  f.diffuse = true;
  makeFrame(s.normal, f.t, f.b);
  f.woL = toLocal(f, woW);
  f.thin = (s.flags & kMaterialThin) != 0u;
  f.exactFresnel = kUseTransmission && s.transmission > 0.0;
  f.eta = f.thin || s.frontFace ? s.ior : 1.0 / s.ior;
  float r0 = square((s.ior - 1.0) / (s.ior + 1.0));
  f.dielectricF0 = min(r0 * s.specularColor, vec3(1.0)) * s.specular;
  f.dielectricF90 = s.specular;
  // Without a change of index nothing refracts: the half vector of a straight line does not exist.
  const float kNoIndexChange = 1e-3;
  if (f.exactFresnel && !f.thin && abs(s.ior - 1.0) < kNoIndexChange) {
    f.s.alpha = 0.0;
    f.eta = 1.0;
  }

  float cosO = max(f.woL.z, 0.0);
  float reflectance = 0.0, body = (1.0 - s.metallic) * (1.0 - maxComponent(dielectricFresnel(f, cosO)));
  f.underSpecular = 1.0;
  if (kUseSpecular && f.exactFresnel) {
    reflectance = luminance(reflectionFresnel(f, cosO));
  } else if (kUseSpecular) {
    float all = ggxAlbedo(cosO, s.alpha), schlick = ggxSchlickAlbedo(cosO, s.alpha);
    reflectance = luminance(mix(dielectricAlbedo(f, all, schlick), metalAlbedo(f, all, schlick), s.metallic));
    float through = throughSpecular(f, all, schlick);
    const float kLeastMean = 0.05;  // a layer that reflects nearly all leaves a quotient of the fit's errors
    f.underSpecular = through / max(meanThroughSpecular(f), kLeastMean);
    body = (1.0 - s.metallic) * through;
  }
  float albedo = luminance(s.baseColor);
  float coat = kUseClearcoat ? s.clearcoat * clearcoatFresnel(abs(dot(s.clearcoatNormal, woW))) : 0.0;
  LobeShares w;
  w.diffuse = body * (1.0 - s.transmission) * albedo;
  w.transmission = body * s.transmission * max(albedo, 0.05);
  w.reflection = reflectance;
  w.clearcoat = coat;
  // A lobe that exists keeps a share, so that its weight stays bounded where the estimate above is too small.
  if (reflectance > 0.0) w.reflection = max(w.reflection, 0.05 * (w.diffuse + w.transmission));
  float sum = w.diffuse + w.transmission + w.reflection + w.clearcoat;
  float scale = sum > 0.0 ? 1.0 / sum : 0.0;
  f.shares = LobeShares(w.diffuse * scale, w.reflection * scale, w.transmission * scale, w.clearcoat * scale);
  return f;
}

bool isMirror(float alpha) { return alpha <= kMinAlpha; }

// Whether what is transmitted keeps its direction: a smooth thin wall, or no change of index.
bool isPane(Bsdf f) {
  return kUseTransmission && f.shares.transmission > 0.0 && isMirror(f.s.alpha) && (f.thin || f.eta == 1.0);
}
// What smooth transmission lets through where the viewer's direction makes `cosO` with the half vector, without 1/eta².
vec3 smoothTransmittance(Bsdf f, vec3 woW, float cosO) {
  float through = (1.0 - f.s.metallic) * f.s.transmission * (1.0 - maxComponent(dielectricFresnel(f, cosO)));
  return f.s.baseColor * through * underClearcoat(f, woW);
}
// What a pane lets through of light that arrives straight from behind; as sampleBsdf() does.
vec3 paneTransmittance(Bsdf f, vec3 woW) { return f.woL.z > 0.0 ? smoothTransmittance(f, woW, f.woL.z) : vec3(0.0); }

// Value * |cos| of the clearcoat alone, and its pdf.
float evaluateClearcoat(Bsdf f, vec3 woW, vec3 wiW, out float pdf) {
  pdf = 0.0;
  if (!kUseClearcoat || f.shares.clearcoat <= 0.0 || isMirror(f.s.clearcoatAlpha)) return 0.0;
  vec3 t, b;
  makeFrame(f.s.clearcoatNormal, t, b);
  vec3 wo = vec3(dot(woW, t), dot(woW, b), dot(woW, f.s.clearcoatNormal));
  vec3 wi = vec3(dot(wiW, t), dot(wiW, b), dot(wiW, f.s.clearcoatNormal));
  if (wo.z <= 0.0 || wi.z <= 0.0) return 0.0;
  vec3 h = normalize(wo + wi);
  float cosH = dot(wo, h);
  pdf = visibleNormalPdf(wo, h, f.s.clearcoatAlpha) / (4.0 * max(cosH, 1e-7));
  return f.s.clearcoat * clearcoatFresnel(cosH) * ggxD(h, f.s.clearcoatAlpha) * ggxG2(wo, wi, f.s.clearcoatAlpha) / (4.0 * wo.z);
}

// Value * |cos| and pdf per unit solid angle of all lobes that are not mirrors.
vec3 evaluateBsdf(Bsdf f, vec3 woW, vec3 wiW, out float pdf) {
  pdf = 0.0;
  vec3 wo = f.woL, wi = toLocal(f, wiW);
  bool reflected = dot(f.s.geometricNormal, wiW) > 0.0;
  float alpha = f.s.alpha;
  vec3 value = vec3(0.0);
  if (reflected) {
    float coatPdf, coat = evaluateClearcoat(f, woW, wiW, coatPdf);
    pdf = f.shares.clearcoat * coatPdf;
    if (wi.z <= 0.0) return vec3(coat);  // below a bump of the layers under it
    vec3 h = normalize(wo + wi);
    float cosH = clamp(dot(wo, h), 0.0, 1.0);
    float body = (1.0 - f.s.metallic) * (1.0 - f.s.transmission) * diffuseUnderSpecular(f, wi.z, cosH);
    value = f.diffuse ? f.s.baseColor * (body * kInvPi * wi.z) : vec3(0.0);
    pdf += f.shares.diffuse * wi.z * kInvPi;
    if (kUseSpecular && !isMirror(alpha) && f.shares.reflection > 0.0) {
      value += reflectionFresnel(f, cosH) * (ggxD(h, alpha) * ggxG2(wo, wi, alpha) / (4.0 * wo.z));
      pdf += f.shares.reflection * visibleNormalPdf(wo, h, alpha) / (4.0 * max(cosH, 1e-7));
    }
    return value * underClearcoat(f, woW) + coat;
  }
  if (!kUseTransmission || f.shares.transmission <= 0.0 || isMirror(alpha) || wi.z >= 0.0) return vec3(0.0);
  float weight = (1.0 - f.s.metallic) * f.s.transmission;
  if (f.thin) {  // the reflection lobe turned over: what enters one face leaves the other undeviated but rough
    vec3 mirrored = vec3(wi.xy, -wi.z);
    vec3 h = normalize(wo + mirrored);
    float cosH = clamp(dot(wo, h), 0.0, 1.0);
    float through = weight * (1.0 - maxComponent(dielectricFresnel(f, cosH)));
    value = f.s.baseColor * (through * ggxD(h, alpha) * ggxG2(wo, mirrored, alpha) / (4.0 * wo.z));
    pdf = f.shares.transmission * visibleNormalPdf(wo, h, alpha) / (4.0 * max(cosH, 1e-7));
  } else {       // [Walter et al. 2007], radiance scaled by 1/eta²
    vec3 h = wo + wi * f.eta;
    float len = length(h);
    if (!(len > 1e-7)) return vec3(0.0);
    h /= len;
    if (h.z < 0.0) h = -h;
    float cosO = dot(wo, h), cosI = dot(wi, h);
    if (cosO <= 0.0 || cosI >= 0.0) return vec3(0.0);
    float denominator = square(cosI + cosO / f.eta);
    float jacobian = -cosI / denominator;
    float through = weight * (1.0 - maxComponent(dielectricFresnel(f, cosO)));
    value = f.s.baseColor * (through * ggxD(h, alpha) * ggxG2(wo, vec3(wi.xy, -wi.z), alpha) * cosO * jacobian
                             / (wo.z * f.eta * f.eta));
    pdf = f.shares.transmission * visibleNormalPdf(wo, h, alpha) * jacobian;
  }
  return value * underClearcoat(f, woW);
}

BsdfSample mirrorSample(Bsdf f, vec3 woW, vec3 dirW, vec3 weight, bool transmitted) {
  return BsdfSample(dirW, weight, 0.0, true, transmitted);
}

// Whether a sample went on straight behind a pane, where light sampling goes on, too.
bool passesPane(Bsdf f, BsdfSample s) { return kUsePanes && s.mirror && s.transmitted && isPane(f); }

const BsdfSample kNoSample = BsdfSample(vec3(0.0), vec3(0.0), 0.0, false, false);

// Of a rough surface the direction alone; zero where there is none.
BsdfSample sampleTransmission(Bsdf f, vec3 woW, vec3 h, bool mirror, out vec3 dirW) {
  vec3 wo = f.woL;
  float cosO = dot(wo, h);
  dirW = vec3(0.0);
  if (f.thin) {
    vec3 wi = 2.0 * cosO * h - wo;
    if (wi.z <= 0.0) return kNoSample;
    dirW = toWorld(f, vec3(wi.xy, -wi.z));
  } else {
    float sin2T = (1.0 - cosO * cosO) / (f.eta * f.eta);
    if (sin2T >= 1.0) return kNoSample;
    vec3 wi = -wo / f.eta + (cosO / f.eta - sqrt(1.0 - sin2T)) * h;
    if (wi.z >= 0.0) return kNoSample;
    dirW = normalize(toWorld(f, wi));
  }
  if (dot(f.s.geometricNormal, dirW) >= 0.0) dirW = vec3(0.0);
  if (!mirror || dirW == vec3(0.0)) return kNoSample;
  vec3 weight = smoothTransmittance(f, woW, cosO) / f.shares.transmission;
  if (!f.thin) weight /= f.eta * f.eta;
  return mirrorSample(f, woW, dirW, weight, true);
}

// Picks a lobe by `uLobe` in [0, 1) and a direction by `u`. A weight of 0 ends the path.
BsdfSample sampleBsdf(Bsdf f, vec3 woW, float uLobe, vec2 u) {
  vec3 wo = f.woL;
  if (wo.z <= 0.0) return kNoSample;
  bool mirror = isMirror(f.s.alpha);
  vec3 dirW;
  if (uLobe < f.shares.diffuse) {
    dirW = toWorld(f, sampleCosineHemisphere(u));
  } else if (kUseSpecular && uLobe < f.shares.diffuse + f.shares.reflection) {
    vec3 h = mirror ? vec3(0.0, 0.0, 1.0) : sampleVisibleNormal(wo, f.s.alpha, u);
    vec3 wi = 2.0 * dot(wo, h) * h - wo;
    dirW = toWorld(f, wi);
    if (wi.z <= 0.0 || dot(f.s.geometricNormal, dirW) <= 0.0) return kNoSample;
    if (mirror)
      return mirrorSample(f, woW, dirW, reflectionFresnel(f, wo.z) * (underClearcoat(f, woW) / f.shares.reflection), false);
  } else if (kUseTransmission && uLobe < f.shares.diffuse + f.shares.reflection + f.shares.transmission) {
    vec3 h = mirror ? vec3(0.0, 0.0, 1.0) : sampleVisibleNormal(wo, f.s.alpha, u);
    BsdfSample delta = sampleTransmission(f, woW, h, mirror, dirW);
    if (mirror || dirW == vec3(0.0)) return delta;
  } else if (kUseClearcoat && f.shares.clearcoat > 0.0) {  // shares that round to less than 1 leave a gap that is no coat's
    vec3 n = f.s.clearcoatNormal;
    if (isMirror(f.s.clearcoatAlpha)) {
      float cosO = dot(n, woW);
      dirW = 2.0 * cosO * n - woW;
      if (cosO <= 0.0 || dot(f.s.geometricNormal, dirW) <= 0.0) return kNoSample;
      return mirrorSample(f, woW, dirW, vec3(f.s.clearcoat * clearcoatFresnel(cosO) / f.shares.clearcoat), false);
    }
    vec3 t, b;
    makeFrame(n, t, b);
    vec3 local = vec3(dot(woW, t), dot(woW, b), dot(woW, n));
    vec3 h = sampleVisibleNormal(local, f.s.clearcoatAlpha, u);
    vec3 wi = 2.0 * dot(local, h) * h - local;
    if (wi.z <= 0.0) return kNoSample;
    dirW = t * wi.x + b * wi.y + n * wi.z;
    if (dot(f.s.geometricNormal, dirW) <= 0.0) return kNoSample;
  } else {
    return kNoSample;
  }
  BsdfSample result = kNoSample;
  result.dirW = normalize(dirW);
  vec3 value = evaluateBsdf(f, woW, result.dirW, result.pdf);
  if (!(result.pdf > 0.0)) return kNoSample;
  result.weight = value / result.pdf;
  result.transmitted = dot(f.s.geometricNormal, result.dirW) < 0.0;
  return result;
}

#endif
