#pragma once
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "renderer/base/result.hpp"

namespace limn::protocol {

/// Little-endian stores and loads of the frame header.
template <std::unsigned_integral T>
void store(std::span<uint8_t> out, size_t offset, T value) {
  for (size_t i = 0; i < sizeof(T); ++i) out[offset + i] = uint8_t(value >> (8 * i));
}
inline void store(std::span<uint8_t> out, size_t offset, float value) { store(out, offset, std::bit_cast<uint32_t>(value)); }

template <class T>
T load(std::span<const uint8_t> in, size_t offset) {
  if constexpr (std::same_as<T, float>) {
    return std::bit_cast<float>(load<uint32_t>(in, offset));
  } else {
    T value = 0;
    for (size_t i = 0; i < sizeof(T); ++i) value = T(value | T(T(in[offset + i]) << (8 * i)));
    return value;
  }
}

inline Error headerError(const char* code, const char* message, size_t byte) {
  return {code, message, "byte " + std::to_string(byte)};
}

}  // namespace limn::protocol
