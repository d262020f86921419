// The device's BVH, as renderer/visibility writes it and shaders/lib/trace.glsl reads it: nodes with up to four
// children.
#ifndef LIMN_BVH_SHARED_H
#define LIMN_BVH_SHARED_H
#include "shaders/shared/shared.h"

// The sampler types of the two tables, for whoever declares their bindings.
#define BVH_NODE_SAMPLER usamplerBuffer
#define BVH_TRIANGLE_SAMPLER samplerBuffer

#ifndef LIMN_GLSL
namespace limn::shared {
#endif

LIMN_CONST_UINT(kNoTriangle, 0xffffffffu);      // Hit::triangle of a miss
LIMN_CONST_UINT(kBvhAlphaBit, 0x80000000u);     // in the id word of a triangle: hits ask alphaAccepts()
LIMN_CONST_UINT(kBvhTriangleTexels, 3u);        // three corners; w of the first holds the id word
LIMN_CONST_UINT(kBvhNodeTexels, 3u);            // node n is texels 3n..3n+2; node 0 is the root
LIMN_CONST_UINT(kBvhBaseMask, 0x00ffffffu);     // of childBase and triangleBase
LIMN_CONST_UINT(kBvhLeafTriangles, 3u);         // most triangles of one child
LIMN_CONST_UINT(kBvhMaxHeight, 17u);            // nodes on a path; each but the last may leave one stack entry

#ifndef LIMN_GLSL
// Inner children come first and lie side by side in the node table; then children that are leaves, whose triangles lie
// side by side in the triangle table in the order of `triangleMask`. A child's box is origin + scale * (low, high),
// scale a power of two.
struct BvhNode {
  float origin[3];        // [m], render space
  uint scaleExponents;    // 8 bits an axis from bit 0: scale's exponent field; bits 24..: number of inner children
  uint low[3];            // an axis each: 8 bits a child from bit 0
  uint high[3];           // as low
  uint childBase;         // first inner child; bits 24..31: bits 0..7 of triangleMask, which has 3 bits a child
  uint triangleBase;      // first triangle; bits 24..27: bits 8..11 of triangleMask
};
LIMN_ASSERT_SIZE(BvhNode, kBvhNodeTexels * 16);
}  // namespace limn::shared
#endif
#endif
