#version 460
// Sums what two texel buffers and a uniform block hold, one invocation an element.
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) uniform samplerBuffer floats;
layout(set = 0, binding = 1) uniform usamplerBuffer words;
layout(set = 0, binding = 2) uniform Block { vec4 bias; };
layout(set = 0, binding = 3) writeonly buffer Out { vec4 outputs[]; };

void main() {
  const int i = int(gl_GlobalInvocationID.x);
  if (i < textureSize(floats)) outputs[i] = texelFetch(floats, i) + float(texelFetch(words, i).x) + bias;
}
