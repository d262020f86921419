// What GGX microfacets reflect in all when light scatters once among them: rational fits to the integrals of ggx.glsl's
// functions, for alpha in [0, 1]. tests/gpu/formulas_test.cpp holds them to quadrature.
#ifndef LIMN_GGX_ALBEDO_GLSL
#define LIMN_GGX_ALBEDO_GLSL
#include "shaders/lib/math.glsl"

// Directional albedo seen at `cosO`, within 0.01: every microfacet reflects fully.
float ggxAlbedo(float cosO, float alpha) {
  precise float x = cosO / max(cosO + 4.0 * alpha, 1e-20);
  precise float top0 = 1.0026 + alpha * (-0.5382 + alpha * 0.0240), top1 = -4.1855 + alpha * (13.578 - alpha * 5.4854);
  precise float top2 = 12.540 - alpha * (19.417 + alpha * 14.650), top3 = -0.7394 + alpha * (-11.966 + alpha * 39.098);
  precise float bottom0 = 1.0 - 0.5080 * alpha, bottom1 = -3.4646 + 14.743 * alpha, bottom2 = 11.020 - 27.996 * alpha;
  precise float top = top0 + x * (top1 + x * (top2 + x * top3)), bottom = bottom0 + x * (bottom1 + x * bottom2);
  return clamp(top / bottom, 0.0, 1.0);
}

// The same where every microfacet reflects Schlick's weight (1 - cos)^5, within 0.005.
float ggxSchlickAlbedo(float cosO, float alpha) {
  float r = sqrt(alpha);
  precise float x = 1.0 - cosO, y = cosO * inversesqrt(max(cosO * cosO + 9.0 * alpha * alpha, 1e-20));
  precise float top0 = 0.0021 + r * (-0.0036 + r * 0.0086), top1 = -0.1040 + r * (0.3036 - r * 0.4738);
  precise float top2 = 0.8280 + r * (-2.6882 + r * 3.6173), top3 = -2.3280 + r * (7.4378 - r * 8.4652);
  precise float top4 = 2.6480 + r * (-6.5345 + r * 6.0689);
  precise float bottom0 = 1.0 + r * (0.1786 + r * 5.8130), bottom1 = 0.8913 - r * (3.1588 + r * 6.2317);
  precise float bottom2 = -1.5779 + r * (2.0572 + r * 0.7184), bottom3 = 0.7344 + r * (-0.5500 + r * 3.8607);
  precise float top = top0 + x * (top1 + x * (top2 + x * (top3 + x * top4)));
  precise float bottom = bottom0 + y * (bottom1 + y * (bottom2 + y * bottom3));
  return clamp(top / bottom, 0.0, 1.0);
}

// Means of both over the cosine-weighted hemisphere, within 0.005 and 0.002.
float meanGgxAlbedo(float alpha) { return 1.0 / (1.0 + 1.43 * pow(alpha, 1.73)); }
float meanGgxSchlickAlbedo(float alpha) {
  float r = sqrt(alpha);
  precise float mean = 0.04642 + r * (0.0587 + r * (-0.51054 + r * (0.7048 - r * 0.29715)));
  return mean;
}

#endif
