#pragma once
#include <cstdint>
#include <cstring>
#include <span>

namespace limn {

/// 64-bit hash of plain data, 8 bytes at a time: tells what changed between two looks at large arrays. Not for files or
/// wires.
template <class T>
uint64_t hashWords(std::span<const T> values, uint64_t seed = 0) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  size_t left = values.size_bytes();
  uint64_t h = seed ^ left * 0x9e3779b97f4a7c15ull;
  while (left > 0) {
    uint64_t word = 0;
    const size_t n = left < 8 ? left : 8;
    std::memcpy(&word, bytes, n);
    h = (h ^ word) * 0xbf58476d1ce4e5b9ull;
    h ^= h >> 29;
    bytes += n;
    left -= n;
  }
  return (h ^ h >> 32) * 0x94d049bb133111ebull;
}

}  // namespace limn
