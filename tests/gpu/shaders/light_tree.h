#ifndef LIMN_TEST_LIGHT_TREE_H
#define LIMN_TEST_LIGHT_TREE_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

LIMN_CONST_UINT(kTreeChoose, 0u);       // a light, or kNoIndex, and its probability
LIMN_CONST_UINT(kTreeProbability, 1u);  // of each light

struct LightTreePush {
  vec3 posR;
  uint both;    // 1: the receiver has two sides
  vec3 normal;  // unit
  uint mode;    // kTree...
  uint count;   // draws or lights
  uint seed;
};

struct ChosenLight {
  uint index;
  float probability;
};

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
