// The carry loop: one workgroup a case, its importances in, the first sample of each cluster and the expected count out.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/gather/allocation.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer In { float given[]; };
layout(binding = 30, scalar) buffer Out { vec2 result[]; };
layout(push_constant, scalar) uniform Push { uint clusters, samples, seed; };

void main() {
  uint first = gl_WorkGroupID.x * clusters;
  for (uint k = gl_LocalInvocationIndex; k < clusters; k += 64u) {
    importance[k] = given[first + k];
    clusterRun[k] = hashCombine(first + k, seed);
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    float sum = 0.0;
    for (uint k = 0u; k < clusters; ++k) sum += importance[k];
    allocate(samples, clusters, 512u, sum);
  }
  barrier();
  for (uint k = gl_LocalInvocationIndex; k < clusters; k += 64u) {
    uint end = k + 1u < clusters ? firstSample(k + 1u) : samples;
    result[first + k] = vec2(float(int(end) - int(firstSample(k))), importance[k]);
  }
}
