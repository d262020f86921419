#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/scene/gltf_document.hpp"

namespace limn::gltf {

/// How integer components become floats.
enum class Integers {
  asDeclared,  ///< divided by their range when the accessor says "normalized"
  normalized
};  ///< always (colours, weights and texture coordinates of plain glTF must be)

/// Elements of accessor `index` as floats, `components` each, tightly packed: strides, sparse replacement and
/// normalisation done; integers c become max(c / maximum, -1). An accessor without data gives zeros. Throws Fault at
/// /accessors/index. T: float, or double where the file's 32-bit integers matter.
std::vector<float> readFloats(const Document& document, int index, uint32_t components,
                              Integers integers = Integers::asDeclared);

/// Elements of an accessor of unsigned integers, `components` each.
std::vector<uint32_t> readUnsigned(const Document& document, int index, uint32_t components);

/// Elements of accessor `index`.
uint64_t countOf(const Document& document, int index);

}  // namespace limn::gltf
