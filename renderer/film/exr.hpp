#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/film/exr_header.hpp"
#include "renderer/film/film_image.hpp"

namespace limn {

/// Encodes as one-part scan-line OpenEXR, 32-bit float, ZIP. "beauty" becomes the main R,G,B; other layers of three
/// channels "name.R" (normal: "normal.X"), of one channel "name" (depth: "depth.Z"). Metadata become string attributes.
/// The same image gives the same bytes. Errors: "bad-image" (a layer's size is wrong), "io". Any thread.
Result<std::vector<uint8_t>> encodeExr(const FilmImage& image);

/// encodeExr() into a file that appears whole or not at all.
Result<void> writeExr(const std::filesystem::path& file, const FilmImage& image);

/// Reads any flat single-part OpenEXR of half or float channels. Channels are grouped into layers by their prefix;
/// those that form no R,G,B or X,Y,Z become layers of one channel. All string attributes become metadata.
/// Errors: those of readExrHeader(); "bad-file" when the pixels cannot be decoded. `place` names the source in them.
Result<FilmImage> decodeExr(std::span<const uint8_t> bytes, const std::string& place, const ExrLimits& limits = {});
Result<FilmImage> readExr(const std::filesystem::path& file, const ExrLimits& limits = {});

/// As readExr(), but the layers have no data: for what a file says about itself.
Result<FilmImage> readExrWithoutPixels(const std::filesystem::path& file, const ExrLimits& limits = {});

/// `rgba` as FrameSlot has it: width*height*4, sRGB-encoded, row 0 on top. Alpha is left out. Errors: "io".
Result<std::vector<uint8_t>> encodePng(uint32_t width, uint32_t height, std::span<const uint8_t> rgba);
Result<void> writePng(const std::filesystem::path& file, uint32_t width, uint32_t height,
                      std::span<const uint8_t> rgba);

}  // namespace limn
