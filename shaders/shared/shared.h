// Lets one header be read by C++ and GLSL. Structs are laid out as GL_EXT_scalar_block_layout does: no padding but our own.
#ifndef LIMN_SHARED_H
#define LIMN_SHARED_H
#ifdef LIMN_GLSL
#define LIMN_ASSERT_SIZE(name, bytes)
#define LIMN_CONST_UINT(name, value) const uint name = value
#define LIMN_CONST_FLOAT(name, value) const float name = value
#else
#include <cstdint>
#include <glm/glm.hpp>
#define LIMN_ASSERT_SIZE(name, bytes) static_assert(sizeof(name) == bytes)
#define LIMN_CONST_UINT(name, value) constexpr uint32_t name = value
#define LIMN_CONST_FLOAT(name, value) constexpr float name = value
namespace limn::shared {
using uint = uint32_t;
using glm::mat4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
}  // namespace limn::shared
#endif
#endif
