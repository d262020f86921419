#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/scene/scene.hpp"

namespace limn {

/// What the first bytes of a texture say.
struct ImageHeader {
  enum class Format { png, jpeg } format = Format::png;
  uint32_t width = 0, height = 0;  ///< [texel]
  bool sixteenBit = false;
};

/// Looks at magic and header only; nothing is decoded. Errors: unsupported (neither PNG nor JPEG), bad-file.
Result<ImageHeader> readImageHeader(std::span<const uint8_t> bytes);

/// Decodes to 8-bit RGBA, alpha not multiplied in. `bytes` is a file that readImageHeader has accepted and whose size
/// the caller has checked. Any thread. Errors: bad-file.
Result<Image> decodeImage(std::span<const uint8_t> bytes, const ImageHeader& header);

}  // namespace limn
