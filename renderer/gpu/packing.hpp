#pragma once
#include <cstdint>

#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

namespace limn::gpu {

/// Unit vector to 2x16-bit octahedral coordinates; shaders/lib/math.glsl decodes. Error below 7e-5 rad.
inline uint32_t octEncode(glm::vec3 n) {
  n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  glm::vec2 e(n.x, n.y);
  if (n.z < 0.0f)
    e = {(1.0f - std::abs(n.y)) * (n.x >= 0.0f ? 1.0f : -1.0f), (1.0f - std::abs(n.x)) * (n.y >= 0.0f ? 1.0f : -1.0f)};
  return glm::packSnorm2x16(e);
}

/// First of a vertex's two texels: normal, tangent with its handedness in bit 0, first texture coordinates.
/// Second: second texture coordinates, colour as four halves.
struct PackedVertex {
  uint32_t normal = 0, tangent = 0;
  float u0 = 0.0f, v0 = 0.0f;
  float u1 = 0.0f, v1 = 0.0f;
  uint32_t colorRg = 0, colorBa = 0;
};
static_assert(sizeof(PackedVertex) == 32);

inline uint32_t packTangent(glm::vec3 tangent, float handedness) {
  return (octEncode(tangent) & ~1u) | (handedness < 0.0f ? 1u : 0u);
}

}  // namespace limn::gpu
