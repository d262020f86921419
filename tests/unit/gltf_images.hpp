#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace limn::test {

/// A file made by OpenImageIO's writer of that name, in memory.
inline std::vector<uint8_t> imageBytes(const char* writer, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                                       const void* texels) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  auto output = OIIO::ImageOutput::create(writer);
  output->set_ioproxy(&memory);
  output->open(std::string("memory.") + writer, spec);
  output->write_image(type, texels);
  output->close();
  return bytes;
}

/// A PNG of 8 or 16 bits whose texel (x, y) has channels x*10 + y*40 + c (times 257 when of 16 bits).
inline std::vector<uint8_t> pngBytes(int width, int height, int channels, bool sixteen = false) {
  std::vector<uint16_t> wide;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) wide.push_back(uint16_t(x * 10 + y * 40 + c));
    }
  }
  if (sixteen) {
    for (uint16_t& v : wide) v = uint16_t(v * 257);
    return imageBytes("png", OIIO::ImageSpec(width, height, channels, OIIO::TypeDesc::UINT16), OIIO::TypeDesc::UINT16,
                      wide.data());
  }
  const std::vector<uint8_t> narrow(wide.begin(), wide.end());
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  return imageBytes("png", spec, OIIO::TypeDesc::UINT8, narrow.data());
}

inline std::string asString(const std::vector<uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace limn::test
