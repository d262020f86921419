// Prefix sums over a workgroup of 256 invocations.
#ifndef LIMN_WORKGROUP_SCAN_GLSL
#define LIMN_WORKGROUP_SCAN_GLSL

shared uint scan[256];

// Inclusive. Every invocation calls it.
uint scanInclusive(uint value) {
  uint l = gl_LocalInvocationIndex;
  scan[l] = value;
  for (uint step = 1u; step < 256u; step <<= 1) {
    barrier();
    uint left = l >= step ? scan[l - step] : 0u;
    barrier();
    scan[l] += left;
  }
  barrier();
  return scan[l];
}

#endif
