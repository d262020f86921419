// Means of the indirect light that surface points near a position carry.
#ifndef LIMN_POINT_GRID_GLSL
#define LIMN_POINT_GRID_GLSL
#include "shaders/lib/point_cells.glsl"

layout(binding = BINDING_POINT_LIGHT, scalar) readonly buffer GridLights { PointLight gridPointLights[]; };

// Which sides of the points count.
const uint kGridFront = 0u;   // those that the geometric normal points to
const uint kGridBack = 1u;
const uint kGridEither = 2u;  // of every point the side that faces along the normal; mixes the faces of thin bodies

struct GridLight {
  vec3 indirect;  // irradiance / pi, weighted mean; 0 without weight
  float weight;   // sum of weights: about 3 amid an even surface, above 0.5 all over it, near 0 where little is known
};

// Mean indirect light at posR on the side that the unit `normal` points to, over the points of the grid near it.
// `sides` says which sides of the points count: that of the surface seen, kGridFront or kGridBack, or kGridEither.
GridLight lookUpPointGrid(vec3 posR, vec3 normal, uint sides) {
  GridLight result = GridLight(vec3(0.0), 0.0);
  PointGridInfo info = pointGridInfo();
  ivec3 base = pointGridBase(info, posR);
  for (int c = 0; c < 8; ++c) {
    uvec2 cell = pointGridCell(info, base, c);
    for (uint e = cell.x; e < cell.y; ++e) {
      uint point = texelFetch(pointGridEntries, int(e)).x;
      uvec4 raw = texelFetch(gridPoints, int(point));
      float cosine = dot(octDecode(raw.w), normal);
      bool back = sides == kGridEither ? cosine < 0.0 : sides == kGridBack;
      float weight = pointGridWeight(uintBitsToFloat(raw.xyz) - posR, normal, back ? -cosine : cosine, info.radius);
      if (weight > 0.0) {
        result.indirect += weight * (back ? gridPointLights[point].indirectBack : gridPointLights[point].indirectFront);
        result.weight += weight;
      }
    }
  }
  result.indirect = result.weight > 0.0 ? result.indirect / result.weight : vec3(0.0);
  return result;
}

// The same as one value, 0 where nothing is known; without `frontFace` where the side of the surface is not known.
vec3 pointIrradiance(vec3 posR, vec3 normal, bool frontFace) {
  return lookUpPointGrid(posR, normal, frontFace ? kGridFront : kGridBack).indirect;
}
vec3 pointIrradiance(vec3 posR, vec3 normal) { return lookUpPointGrid(posR, normal, kGridEither).indirect; }

#endif
