// The light that leaves surface points, as gathers read it: what arrives times the reflectance, both sides. One
// invocation a point.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/shared/point_shared.h"
#include "shaders/shared/relight_shared.h"
#include "shaders/lib/scene_bindings.glsl"
#include "shaders/lib/bsdf.glsl"

layout(constant_id = 16) const bool kUseLobes = true;

layout(local_size_x = 64) in;
layout(binding = BINDING_POINT_SITES, scalar) readonly buffer Sites { PointSite pointSites[]; };
layout(binding = BINDING_POINT_LIGHT, scalar) readonly buffer Light { PointLight pointLight[]; };
layout(binding = BINDING_POINT_LOBES, scalar) readonly buffer Lobes { PointLobes pointLobes[]; };
layout(binding = BINDING_POINT_RADIANCE_OUT, scalar) writeonly buffer Radiance { vec4 pointRadiance[]; };
layout(push_constant, scalar) uniform Push { ComposePush push; };

// Shares of arriving light that leave again.
struct Reflectances {
  vec3 diffuse;      // on the same side
  vec3 specular;     // on the same side, by microfacets
  vec3 transmitted;  // on the other side
  bool pane;         // direct light passes it straight, and the points behind it have it already
};

// Mean of the exact Fresnel term over the cosine-weighted hemisphere, which is nothing where the index does not change;
// within 0.002 of the integral for indices up to 1.8.
vec3 meanFresnel(Surface s, vec3 f0, float f90) {
  return f0 + (f90 - f0) * ((1.0 - exp(-5.4 * (s.ior - 1.0))) * (1.2 / 21.0));
}

// Mean of what microfacets reflect of light that arrives from everywhere.
vec3 meanReflectance(Bsdf f) {
  float albedo = meanGgxAlbedo(f.s.alpha), schlick = meanGgxSchlickAlbedo(f.s.alpha);
  vec3 dielectric = f.exactFresnel ? meanFresnel(f.s, f.dielectricF0, f.dielectricF90) * albedo
                                   : dielectricAlbedo(f, albedo, schlick);
  return mix(dielectric, metalAlbedo(f, albedo, schlick), f.s.metallic);
}

Reflectances reflectancesOf(Surface s) {
  Bsdf f = makeBsdf(s, s.normal);
  float under = underClearcoat(f, s.clearcoatNormal), body = (1.0 - s.metallic) * under;
  float entering = max(1.0 - maxComponent(dielectricFresnel(f, 1.0)), 0.0);
  Reflectances r;
  r.diffuse = s.baseColor * (body * (1.0 - s.transmission) * (f.exactFresnel ? entering : meanThroughSpecular(f)));
  r.transmitted = kUseTransmission ? s.baseColor * (body * s.transmission * entering) : vec3(0.0);
  r.pane = kUsePanes && isPane(f);
  r.specular = kUseSpecular ? meanReflectance(f) * under + (1.0 - under) : vec3(0.0);
  return r;
}

// Lobes give the glossy reflection of direct light; all else that microfacets reflect or let pass leaves diffusely, so
// that no energy is lost.
vec3 leaving(Reflectances r, vec3 direct, vec3 indirect, vec3 directBehind, vec3 indirectBehind, bool hasLobes) {
  vec3 all = direct + indirect, behind = (r.pane ? vec3(0.0) : directBehind) + indirectBehind;
  return r.diffuse * all + r.specular * (hasLobes ? indirect : all) + r.transmitted * behind;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.slotCount * push.clusterCount) return;
  uint point = i / push.slotCount * push.clusterSize + push.firstSlot + i % push.slotCount;
  PointSite site = pointSites[point];
  Surface s = makeSurface(site.triangle, site.barycentrics, vec3(0.0));  // no viewer: the front, its normal not bent
  vec3 front = s.baseColor, back = s.baseColor;
  bool hasLobes = false;
  if ((s.flags & kMaterialUnlit) == 0u) {
    if (kUseLobes && push.lobes != 0u) hasLobes = pointLobes[point].alpha > 0.0;
    PointLight light = pointLight[point];
    Reflectances r = reflectancesOf(s);
    front = leaving(r, light.directFront, light.indirectFront, light.directBack, light.indirectBack, hasLobes);
    back = leaving(r, light.directBack, light.indirectBack, light.directFront, light.indirectFront, hasLobes);
  }
  float w = hasLobes ? 1.0 : 0.0;
  pointRadiance[2u * point] = vec4(front, w);
  pointRadiance[2u * point + 1u] = vec4(back, w);
}
