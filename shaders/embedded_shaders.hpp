#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace limn {

/// SPIR-V words of the module built under that name (shaders/shaders.cmake); empty when there is none.
std::span<const uint32_t> embeddedShader(std::string_view name);

}  // namespace limn
