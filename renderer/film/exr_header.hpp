#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "renderer/base/result.hpp"

namespace limn {

/// What may be read; checked against the header before anything is decoded or allocated.
struct ExrLimits {
  uint64_t maxFileBytes = 2ull << 30;
  uint64_t maxPixelBytes = 2ull << 30;  ///< width * height * channels * 4
  uint32_t maxSide = 65'536;            ///< [pixel]
  uint32_t maxChannels = 256;
};

/// The part of an OpenEXR header that decides whether we read the file.
struct ExrHeader {
  uint32_t width = 0, height = 0;       ///< of the data window, which equals the display window
  std::vector<std::string> channels;    ///< as the file names them
};

/// Reads the header of a single-part flat OpenEXR file with half and float channels.
/// Errors: "bad-file" (not OpenEXR, truncated, contradicts itself), "unsupported" (deep, multi-part, cropped,
/// subsampled or integer channels), "limit". `place` names the file in them. [OpenEXR file layout, openexr.com]
Result<ExrHeader> readExrHeader(std::span<const uint8_t> bytes, const ExrLimits& limits, const std::string& place);

}  // namespace limn
