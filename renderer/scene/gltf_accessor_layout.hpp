#pragma once
#include <cstdint>
#include <string_view>

namespace limn::gltf {

/// Bytes of one component; 0 for a number that is no glTF component type.
constexpr uint32_t componentBytes(uint64_t componentType) {
  switch (componentType) {
    case 5120: case 5121: return 1;
    case 5122: case 5123: return 2;
    case 5125: case 5126: return 4;
    default: return 0;
  }
}

struct ElementShape { uint32_t rows = 0, columns = 1; };  ///< rows == 0: no such type

constexpr ElementShape elementShape(std::string_view type) {
  if (type == "SCALAR") return {1, 1};
  if (type == "VEC2") return {2, 1};
  if (type == "VEC3") return {3, 1};
  if (type == "VEC4") return {4, 1};
  if (type == "MAT2") return {2, 2};
  if (type == "MAT3") return {3, 3};
  if (type == "MAT4") return {4, 4};
  return {};
}

/// Bytes of one element; columns of matrices start at multiples of 4 bytes.
constexpr uint32_t elementBytes(ElementShape shape, uint32_t bytes) {
  const uint32_t column = shape.rows * bytes;
  return shape.columns == 1 ? column : (column + 3) / 4 * 4 * shape.columns;
}

}  // namespace limn::gltf
