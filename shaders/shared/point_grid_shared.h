// A hashed grid over surface points, as C++ and GLSL see it.
#ifndef LIMN_POINT_GRID_SHARED_H
#define LIMN_POINT_GRID_SHARED_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

// Head of POINT_GRID, floats as their bits; the first entries of the buckets follow, and the end of the last one.
struct PointGridInfo {
  vec3 originR;      // [m], corner of cell (0, 0, 0)
  float cellsPerM;   // [1/m]; a cell is twice as wide as points reach; 0: the grid is empty
  float radius;      // [m], how far points reach
  uint bucketMask;   // number of buckets less 1; a power of two, at least 8
};
LIMN_ASSERT_SIZE(PointGridInfo, 24);
LIMN_CONST_UINT(kPointGridInfoWords, 6u);

// Points of a bucket that are looked at; what lies beyond is never read, so that loops stay bounded.
LIMN_CONST_UINT(kPointGridMaxEntries, 64u);
// Share of the radius a point's plane may miss a position by.
LIMN_CONST_FLOAT(kPointGridPlaneReach, 0.4f);

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
