// Lights as they are chosen for a receiver, and the probabilities that multiple importance sampling asks for.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/lib/scene_bindings.glsl"
#include "shaders/lib/lights.glsl"
#include "tests/gpu/shaders/light_tree.h"

layout(local_size_x = 64) in;
layout(binding = 30, scalar) buffer Out { ChosenLight result[]; };
layout(push_constant, scalar) uniform Push { LightTreePush push; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  LightReceiver at = LightReceiver(push.posR, push.normal, push.both != 0u);
  if (push.mode == kTreeChoose) {
    uint key = hash(hash(i) ^ push.seed);
    vec2 u = vec2(toUnit(key), toUnit(hash(key + 1u)));
    result[i].index = chooseLight(at, u, result[i].probability);
  } else {
    result[i] = ChosenLight(i, lightProbability(lights[i], at));
  }
}
