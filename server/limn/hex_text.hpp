#pragma once
#include <cstdint>
#include <cstdio>
#include <string>

namespace limn {

/// A hash as the wire and the files write it: 16 lower-case hexadecimal digits.
inline std::string hexText(uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace limn
