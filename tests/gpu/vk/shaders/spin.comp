#version 460
// Keeps the device busy for a time that grows with `turns`.
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Out { uint state; };
layout(push_constant) uniform Push { uint turns; };

void main() {
  uint x = state;
  for (uint i = 0; i < turns; ++i) x = (x ^ (x >> 7)) * 1664525u + i;
  state = x;
}
