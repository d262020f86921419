#pragma once

namespace limn {

/// Luminance of a linear colour with the primaries of ITU-R BT.709, in the unit of its channels. `rgb` is a vector or
/// points to three numbers.
template <class Rgb>
constexpr double luminance(const Rgb& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

}  // namespace limn
