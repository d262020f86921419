#version 460
// Counts workgroups.
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Out { uint count; };

void main() { atomicAdd(count, 1u); }
