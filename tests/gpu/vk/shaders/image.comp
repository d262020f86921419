#version 460
// Layer 1 of the source at its texel centre, its channels turned around, into layer 0 of the target.
layout(local_size_x = 4, local_size_y = 4) in;
layout(set = 0, binding = 0) uniform sampler2DArray source;
layout(set = 0, binding = 1, rgba8) uniform image2DArray target;
layout(set = 0, binding = 2) writeonly buffer Out { vec4 outputs[]; };

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  const ivec2 size = imageSize(target).xy;
  if (any(greaterThanEqual(at, size))) return;
  const vec4 texel = textureLod(source, vec3((vec2(at) + 0.5) / vec2(size), 1.0), 0.0);
  imageStore(target, ivec3(at, 0), texel.abgr);
  outputs[at.y * size.x + at.x] = imageLoad(target, ivec3(at, 0));
}
