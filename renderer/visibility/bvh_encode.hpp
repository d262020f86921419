#pragma once
#include <cstdint>
#include <span>

#include "renderer/visibility/bvh_build.hpp"
#include "shaders/shared/bvh_shared.h"

namespace limn {

struct EncodedChild {
  Box box;
  uint32_t triangles = 0;  ///< of a leaf, at most kBvhLeafTriangles; 0: an inner child
};

/// A node around `box` with up to four children inside it, the `innerCount` inner ones first. The encoded boxes
/// contain the children's with a margin over what rounding in the shader can take away (bvh_encode.cpp has the
/// estimate).
shared::BvhNode encodeNode(const Box& box, std::span<const EncodedChild> children, uint32_t innerCount,
                           uint32_t childBase, uint32_t triangleBase);

}  // namespace limn
