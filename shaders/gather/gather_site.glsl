// Sites of gathers, points as sites see them, and the lobes of both. Included after the bindings.
#ifndef LIMN_GATHER_SITE_GLSL
#define LIMN_GATHER_SITE_GLSL

struct Site {
  uint id;                // of its random numbers
  bool valid;
  vec3 posR;
  vec3 geometricNormal, t, b, n;
  float extent;           // [m] largest coordinate of the triangle's corners, for offsetOrigin
  float clearance;        // [m] points less high above the surface are part of it, or rounding
  bool glossy;            // has a rough glossy lobe
  vec3 wo;                // viewer in the frame
  float alpha;            // of the glossy lobe
  vec3 f0, f90;           // its Fresnel term at normal and grazing incidence
  float albedo;           // luminance
};

const float kLeastF0 = 0.01;  // quotients by reflectances below this stay bounded

Site siteAt(uint id, vec3 posR, float extent, vec3 geometricNormal, vec3 normal) {
  Site s;
  s.id = id;
  s.valid = true;
  s.posR = posR;
  s.extent = extent;
  s.geometricNormal = geometricNormal;
  s.n = normal;
  makeFrame(normal, s.t, s.b);
  s.clearance = maxComponent(abs(posR)) * (16.0 / 16777216.0);
  s.glossy = false;
  s.wo = vec3(0.0, 0.0, 1.0);
  s.alpha = 1.0;
  s.f0 = s.f90 = vec3(0.0);
  s.albedo = 1.0;
  return s;
}

#ifdef LIMN_GATHER_POINTS
Site makeSite(uint entry) {
  uvec4 point = texelFetch(points, int(entry >> 1));
  vec3 n = octDecode(point.w) * ((entry & 1u) != 0u ? -1.0 : 1.0);
#ifdef LIMN_GATHER_CORRECT
  PointSite site = pointSites[entry >> 1];
  float extent = facetOf(texelFetch(triangles, int(site.triangle)).xyz, cornerWeights(site.barycentrics), n).extent;
#else
  float extent = 0.0;
#endif
  return siteAt(entry, uintBitsToFloat(point.xyz), extent, n, n);
}
#else
Site makeSite(uint pixel) {
  GatherSite g = sites[pixel];
  vec3 normal = octDecode(g.normal);
  bool valid = g.triangle != kNoIndex;
  uint triangle = valid ? g.triangle : 0u;
  vec3 viewDir = camera.perspective != 0u ? normalize(camera.eyeR - g.posR) : -camera.forward;
  Surface surface = makeSurface(triangle, g.barycentrics, viewDir);
  Site s = siteAt(pixel, g.posR, surface.extent, surface.geometricNormal, normal);
  s.valid = valid;
  if (kUseSpecular) {
    Bsdf f = roughPart(makeBsdf(surface, viewDir));
    s.glossy = f.shares.reflection > 0.0;
    s.wo = vec3(dot(viewDir, s.t), dot(viewDir, s.b), max(dot(viewDir, s.n), 1e-3));
    s.alpha = max(surface.alpha, kSplatAlpha);
    s.f0 = s.glossy ? mix(f.dielectricF0, surface.baseColor, surface.metallic) : vec3(0.0);
    s.f90 = s.glossy ? mix(vec3(f.dielectricF90), vec3(1.0), surface.metallic) : vec3(0.0);
    s.albedo = s.glossy ? luminance(gatheredAlbedo(f)) * kInvPi : 1.0;  // alone, the lobe's weight does not matter
  }
  return s;
}
#endif

// The glossy lobe's value times the cosine at the site, without Fresnel; that factor's weight in `schlick`.
float glossyValue(Site s, vec3 wi, out float schlick) {
  vec3 h = normalize(s.wo + wi);
  schlick = schlickWeight(dot(s.wo, h));
  return ggxD(h, s.alpha) * ggxG2(s.wo, wi, s.alpha) / (4.0 * s.wo.z);
}

// Radiance that the lobes of a point send along `dirW`, away from it, on that side of its surface. The geometric normal
// tells the side, the shading normal turns the lobes; where it looks away from `dirW`, that grazes it. [IPP §3.2, §4]
vec3 lobeRadiance(uint point, vec3 dirW) {
  float side = dot(octDecode(texelFetch(points, int(point)).w), dirW) < 0.0 ? -1.0 : 1.0;
  vec3 n = octDecode(pointLobes[point].normal) * side;
  float alpha = pointLobes[point].alpha;
  vec3 f0 = unpackRgbe(pointLobes[point].reflectance), t, b, sum = vec3(0.0);
  makeFrame(n, t, b);
  vec3 wo = vec3(dot(dirW, t), dot(dirW, b), max(dot(dirW, n), 1e-2));
  for (uint i = 0u; i < kLobesPerPoint; ++i) {
    PointLobe lobe = pointLobes[point].lobe[i];
    vec3 dirToLight = octDecode(lobe.dirToLight);
    vec3 wi = vec3(dot(dirToLight, t), dot(dirToLight, b), dot(dirToLight, n));
    bool lit = lobe.irradiance != 0u && wi.z > 0.0;
    wi.z = max(wi.z, 1e-2);
    vec3 h = normalize(wo + wi);
    vec3 fresnel = f0 + (1.0 - f0) * schlickWeight(dot(wo, h));
    float value = ggxD(h, alpha) * ggxG2(wo, wi, alpha) / (4.0 * wo.z * wi.z);
    sum += lit ? unpackRgbe(lobe.irradiance) * fresnel * value : vec3(0.0);
  }
  return sum;
}

// How much more important its lobes make a point: 1 where it has none, up to 5.
float glossyStrength(uint entry, vec3 dirW) {
  vec4 radiance = texelFetch(pointRadiance, int(entry));
  if (radiance.w <= 0.0) return 1.0;
  float glossy = luminance(lobeRadiance(entry >> 1, dirW)), diffuse = luminance(radiance.rgb);
  return 1.0 + 4.0 * glossy / max(glossy + diffuse, 1e-20);
}

// A point as a site sees it.
struct View {
  bool above;       // in front of the surface
  vec3 d;           // [m] from the site
  vec3 local;       // the same in the site's frame
  float d2;
  float sinkCosine; // cosine at the point, times the distance; negative where the back faces the site
};

View look(Site s, uint point) {
  uvec4 raw = texelFetch(points, int(point));
  View v;
  v.d = uintBitsToFloat(raw.xyz) - s.posR;
  v.d2 = dot(v.d, v.d);
  v.local = vec3(dot(v.d, s.t), dot(v.d, s.b), dot(v.d, s.n));
  v.above = dot(v.d, s.geometricNormal) > s.clearance && v.local.z > 0.0 && v.d2 > 1e-36;
  v.d2 = max(v.d2, 1e-36);
  v.sinkCosine = -dot(octDecode(raw.w), v.d);
  return v;
}

// Solid angle [sr] of a disk of `area` there, times the distance: bounded however near it is. [IPP eq. 5]
float diskSolidAngle(View v, float area) {
  return 2.0 * kPi * area * abs(v.sinkCosine) / (area + 2.0 * kPi * v.d2);
}

#endif
