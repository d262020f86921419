// Means of what surface points near a position carry. BINDING_POINT_GRID and BINDING_POINT_GRID_ENTRIES are built by
// renderer/cache/point_grid.cpp, whose pointWeight() and bucketOf() say the same as those here. The inner loop of a
// look-up turns at most 8 * kPointGridMaxEntries = 512 times.
#ifndef LIMN_POINT_GRID_GLSL
#define LIMN_POINT_GRID_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/point_grid_shared.h"
#include "shaders/shared/point_shared.h"

layout(binding = BINDING_POINTS) uniform usamplerBuffer gridPoints;
layout(binding = BINDING_POINT_LIGHT, scalar) readonly buffer GridLights { PointLight gridPointLights[]; };
layout(binding = BINDING_POINT_GRID) uniform usamplerBuffer pointGrid;
layout(binding = BINDING_POINT_GRID_ENTRIES) uniform usamplerBuffer pointGridEntries;

// Which sides of the points count.
const uint kGridFront = 0u;   // those that the geometric normal points to
const uint kGridBack = 1u;
const uint kGridEither = 2u;  // of every point the side that faces along the normal; mixes the faces of thin bodies

struct GridLight {
  vec3 indirect;  // irradiance / pi, weighted mean; 0 without weight
  float weight;   // sum of weights: about 3 amid an even surface, above 0.5 all over it, near 0 where little is known
};

PointGridInfo pointGridInfo() {
  PointGridInfo info;
  info.originR.x = uintBitsToFloat(texelFetch(pointGrid, 0).x);
  info.originR.y = uintBitsToFloat(texelFetch(pointGrid, 1).x);
  info.originR.z = uintBitsToFloat(texelFetch(pointGrid, 2).x);
  info.cellsPerM = uintBitsToFloat(texelFetch(pointGrid, 3).x);
  info.radius = uintBitsToFloat(texelFetch(pointGrid, 4).x);
  info.bucketMask = texelFetch(pointGrid, 5).x;
  return info;
}

// The lowest bits are the parities of the coordinates: 2x2x2 cells are always in 8 different buckets.
uint pointGridBucket(ivec3 cell, uint mask) {
  uvec3 block = uvec3(cell >> 1) * uvec3(0x8da6b343u, 0xd8163841u, 0xcb1ab31fu);
  uint h = block.x ^ block.y ^ block.z;
  h ^= h >> 15;
  uvec3 parity = uvec3(cell & 1);
  return (h << 3 | parity.z << 2 | parity.y << 1 | parity.x) & mask;
}

// Falls smoothly to 0 at the radius, away from the plane of the normal, and as normals part.
float pointGridWeight(vec3 apart, vec3 normal, float cosine, float radius) {
  float near = max(1.0 - dot(apart, apart) / (radius * radius), 0.0);
  float height = dot(apart, normal) / (kPointGridPlaneReach * radius);
  float level = max(1.0 - height * height, 0.0);
  return near * near * level * level * max(cosine, 0.0);
}

// Mean indirect light at posR on the side that the unit `normal` points to, over the points of the grid near it.
// `sides` says which sides of the points count: that of the surface seen, kGridFront or kGridBack, or kGridEither.
GridLight lookUpPointGrid(vec3 posR, vec3 normal, uint sides) {
  GridLight result = GridLight(vec3(0.0), 0.0);
  PointGridInfo info = pointGridInfo();
  ivec3 base = ivec3(floor(clamp((posR - info.originR) * info.cellsPerM - 0.5, vec3(-1.0e6), vec3(1.0e6))));
  for (int c = 0; c < 8; ++c) {
    uint bucket = pointGridBucket(base + ivec3(c & 1, c >> 1 & 1, c >> 2), info.bucketMask);
    uint first = texelFetch(pointGrid, int(kPointGridInfoWords + bucket)).x;
    uint end = texelFetch(pointGrid, int(kPointGridInfoWords + bucket + 1u)).x;
    end = min(end, first + kPointGridMaxEntries);
    for (uint e = first; e < end; ++e) {
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
