// Where surface points lie, by cells. BINDING_POINT_GRID and BINDING_POINT_GRID_ENTRIES are built by
// renderer/cache/point_grid.cpp, whose pointWeight() and bucketOf() say the same as those here. The inner loop of a
// look-up turns at most 8 * kPointGridMaxEntries = 512 times.
#ifndef LIMN_POINT_CELLS_GLSL
#define LIMN_POINT_CELLS_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/point_grid_shared.h"
#include "shaders/shared/point_shared.h"
#include "shaders/shared/scene_shared.h"

layout(binding = BINDING_POINTS) uniform usamplerBuffer gridPoints;
layout(binding = BINDING_POINT_GRID) uniform usamplerBuffer pointGrid;
layout(binding = BINDING_POINT_GRID_ENTRIES) uniform usamplerBuffer pointGridEntries;

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

// Corner of the 2x2x2 cells that hold every point in reach of posR.
ivec3 pointGridBase(PointGridInfo info, vec3 posR) {
  return ivec3(floor(clamp((posR - info.originR) * info.cellsPerM - 0.5, vec3(-1.0e6), vec3(1.0e6))));
}

// First entry and end of the cell of number `c` of those eight.
uvec2 pointGridCell(PointGridInfo info, ivec3 base, int c) {
  uint bucket = pointGridBucket(base + ivec3(c & 1, c >> 1 & 1, c >> 2), info.bucketMask);
  uint first = texelFetch(pointGrid, int(kPointGridInfoWords + bucket)).x;
  uint end = texelFetch(pointGrid, int(kPointGridInfoWords + bucket + 1u)).x;
  return uvec2(first, min(end, first + kPointGridMaxEntries));
}

// The point that counts most at posR, on a surface of which the side that the unit `normal` points to is seen, as
// 2 * point + side; kNoIndex where none is in reach. Points of the other face of a thin body do not count.
uint nearestPointSide(vec3 posR, vec3 normal, bool frontFace) {
  PointGridInfo info = pointGridInfo();
  ivec3 base = pointGridBase(info, posR);
  float best = 0.0;
  uint nearest = kNoIndex, side = frontFace ? 0u : 1u;
  for (int c = 0; c < 8; ++c) {
    uvec2 cell = pointGridCell(info, base, c);
    for (uint e = cell.x; e < cell.y; ++e) {
      uint point = texelFetch(pointGridEntries, int(e)).x;
      uvec4 raw = texelFetch(gridPoints, int(point));
      float cosine = dot(octDecode(raw.w), frontFace ? normal : -normal);
      float weight = pointGridWeight(uintBitsToFloat(raw.xyz) - posR, normal, cosine, info.radius);
      bool nearer = weight > best;
      best = nearer ? weight : best;
      nearest = nearer ? 2u * point + side : nearest;
    }
  }
  return nearest;
}

#endif
