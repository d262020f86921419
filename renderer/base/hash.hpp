#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace limn {

/// FNV-1a, 64 bit, continued from `seed`: names and scene hashes, not security.
constexpr uint64_t fnv1a(std::string_view bytes, uint64_t seed = 0xcbf29ce484222325ull) {
  for (const char c : bytes) seed = (seed ^ uint8_t(c)) * 0x100000001b3ull;
  return seed;
}

inline uint64_t fnv1a(const void* data, size_t size, uint64_t seed = 0xcbf29ce484222325ull) {
  return fnv1a(std::string_view(static_cast<const char*>(data), size), seed);
}

}  // namespace limn
