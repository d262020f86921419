// The g-buffer, as C++ and GLSL see it.
#ifndef LIMN_G_BUFFER_SHARED_H
#define LIMN_G_BUFFER_SHARED_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

struct GBufferTexel {
  uint triangle;      // global id; kNoTriangle where the ray leaves the scene
  vec2 barycentrics;  // weights of corners 1 and 2
  float distance;     // [m] along the camera ray from the clip plane
  vec3 posR;          // [m], render space
  uint pad;
};
LIMN_ASSERT_SIZE(GBufferTexel, 32);

struct GBufferPush {
  uint x;       // [pixel] upper left corner of the rectangle
  uint y;
  uint width;   // [pixel]
  uint height;
};
LIMN_ASSERT_SIZE(GBufferPush, 16);

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
