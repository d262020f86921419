#version 460
// out[i] = in[first + i] * scale + kAdd for i < count
layout(constant_id = 0) const uint kAdd = 0;
layout(local_size_x_id = 1) in;
layout(set = 0, binding = 0) readonly buffer In { uint inputs[]; };
layout(set = 0, binding = 3) writeonly buffer Out { uint outputs[]; };
layout(push_constant) uniform Push { uint first; uint count; uint scale; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < count) outputs[i] = inputs[first + i] * scale + kAdd;
}
