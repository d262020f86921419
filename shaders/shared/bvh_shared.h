// The device's BVH, as C++ writes it and shaders/lib/trace.glsl reads it. renderer/visibility/bvh_layout.cpp is the writer.
#ifndef LIMN_BVH_SHARED_H
#define LIMN_BVH_SHARED_H
#include "shaders/shared/shared.h"

// The sampler types of the two tables, for whoever declares their bindings.
#define BVH_NODE_SAMPLER usamplerBuffer
#define BVH_TRIANGLE_SAMPLER samplerBuffer

#ifndef LIMN_GLSL
namespace limn::shared {
#endif

LIMN_CONST_UINT(kNoTriangle, 0xffffffffu);          // Hit::triangle of a miss
LIMN_CONST_UINT(kBvhAlphaBit, 0x80000000u);         // in the id word of a triangle: hits ask alphaAccepts()
LIMN_CONST_UINT(kBvhTriangleTexels, 3u);            // three corners; w of the first holds the id word
LIMN_CONST_UINT(kBvhHeaderTexels, 1u);              // texel 0 of the nodes: x is the node count
LIMN_CONST_UINT(kBvhNodeTexels, 2u);                // (lower, skip link), (upper, leaf word)
LIMN_CONST_UINT(kBvhLeafCountBits, 4u);             // leaf word: first triangle << bits | count; 0 in an inner node

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
