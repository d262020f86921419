// GGX microfacets in the frame of the normal (z up). alpha > kMinAlpha; sharper lobes are mirrors and never come here.
#ifndef LIMN_GGX_GLSL
#define LIMN_GGX_GLSL
#include "shaders/lib/math.glsl"

// Density of microfacet normals [1/sr]; sin² is taken from x and y, for 1 - cos² loses every digit of a sharp lobe.
float ggxD(vec3 h, float alpha) {
  float a2 = alpha * alpha;
  float sin2 = h.x * h.x + h.y * h.y;
  float d = a2 * h.z * h.z + sin2;
  return a2 / (kPi * d * d);
}

float ggxLambda(vec3 w, float alpha) {
  float cos2 = w.z * w.z;
  float tan2 = (w.x * w.x + w.y * w.y) / max(cos2, 1e-20);
  return 0.5 * (sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}
float ggxG1(vec3 w, float alpha) { return 1.0 / (1.0 + ggxLambda(w, alpha)); }
// Height-correlated Smith. [Heitz 2014]
float ggxG2(vec3 wo, vec3 wi, float alpha) { return 1.0 / (1.0 + ggxLambda(wo, alpha) + ggxLambda(wi, alpha)); }

// Normal visible from `wo` (z > 0). [Heitz 2018]
vec3 sampleVisibleNormal(vec3 wo, float alpha, vec2 u) {
  vec3 v = normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
  float len2 = v.x * v.x + v.y * v.y;
  vec3 t1 = len2 > 0.0 ? vec3(-v.y, v.x, 0.0) * inversesqrt(len2) : vec3(1.0, 0.0, 0.0);
  vec3 t2 = cross(v, t1);
  float r = sqrt(u.x), phi = 2.0 * kPi * u.y;
  float p1 = r * cos(phi), p2 = r * sin(phi);
  float s = 0.5 * (1.0 + v.z);
  p2 = (1.0 - s) * sqrt(max(0.0, 1.0 - p1 * p1)) + s * p2;
  vec3 n = p1 * t1 + p2 * t2 + sqrt(max(0.0, 1.0 - p1 * p1 - p2 * p2)) * v;
  return normalize(vec3(alpha * n.x, alpha * n.y, max(1e-7, n.z)));
}

// pdf of sampleVisibleNormal per unit solid angle of the normal.
float visibleNormalPdf(vec3 wo, vec3 h, float alpha) {
  return ggxG1(wo, alpha) * ggxD(h, alpha) * max(dot(wo, h), 0.0) / max(wo.z, 1e-7);
}

float schlickWeight(float cosTheta) {
  float m = clamp(1.0 - cosTheta, 0.0, 1.0), m2 = m * m;
  return m2 * m2 * m;
}

// Unpolarised Fresnel reflectance; eta = ior of the far side / ior of the near side.
float fresnelDielectric(float cosI, float eta) {
  cosI = clamp(cosI, 0.0, 1.0);
  float sin2T = (1.0 - cosI * cosI) / (eta * eta);
  if (sin2T >= 1.0) return 1.0;
  float cosT = sqrt(1.0 - sin2T);
  float parallel = (eta * cosI - cosT) / (eta * cosI + cosT);
  float perpendicular = (cosI - eta * cosT) / (cosI + eta * cosT);
  return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

#endif
