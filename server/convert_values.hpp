#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include <glm/glm.hpp>

#include "renderer/scene/scene.hpp"

namespace limn::server {

/// The enumerations of the schema stand in the order of the renderer's.
template <class To, class From>
To same(From value) {
  return To(uint32_t(value));
}

template <glm::length_t L, class T>
std::array<T, size_t(L)> array(const glm::vec<L, T>& from) {
  std::array<T, size_t(L)> out{};
  for (size_t i = 0; i < out.size(); ++i) out[i] = from[glm::length_t(i)];
  return out;
}

/// Nothing in place of kNone.
inline std::optional<uint32_t> index(int32_t value) {
  return value == kNone ? std::nullopt : std::optional(uint32_t(value));
}

}  // namespace limn::server
