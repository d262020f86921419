#version 460
// Writes the counts of an indirect dispatch.
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) writeonly buffer Out { uint counts[]; };
layout(push_constant) uniform Push { uvec4 groups; };

void main() {
  counts[4] = groups.x;
  counts[5] = groups.y;
  counts[6] = groups.z;
}
