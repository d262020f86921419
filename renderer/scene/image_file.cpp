#include "renderer/scene/image_file.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "renderer/scene/oiio_input.hpp"

namespace limn {
namespace {

uint32_t bigEndian(const uint8_t* p, int count) {
  uint32_t v = 0;
  for (int i = 0; i < count; ++i) v = v << 8 | p[i];
  return v;
}

Result<ImageHeader> checked(ImageHeader header) {
  if (header.width == 0 || header.height == 0) return Error{"bad-file", "the image has no texels", ""};
  return header;
}

/// Whether the chunks fit into the file up to IEND. OpenImageIO leaks memory when libpng meets the end of the file.
bool pngIsWhole(std::span<const uint8_t> b) {
  for (size_t at = 8; b.size() - at >= 12;) {
    const size_t length = bigEndian(b.data() + at, 4);
    if (length > b.size() - at - 12) return false;
    if (std::memcmp(b.data() + at + 4, "IEND", 4) == 0) return true;
    at += 12 + length;
  }
  return false;
}

Result<ImageHeader> pngHeader(std::span<const uint8_t> b) {
  if (b.size() < 33 || std::memcmp(b.data() + 12, "IHDR", 4) != 0) {
    return Error{"bad-file", "the PNG has no header", ""};
  }
  if (!pngIsWhole(b)) return Error{"bad-file", "the PNG is cut off", ""};
  return checked({ImageHeader::Format::png, bigEndian(b.data() + 16, 4), bigEndian(b.data() + 20, 4), b[24] == 16});
}

/// Walks the markers up to the start of frame.
Result<ImageHeader> jpegHeader(std::span<const uint8_t> b) {
  for (size_t at = 2; at + 4 <= b.size();) {
    if (b[at] != 0xff) return Error{"bad-file", "the JPEG's markers are broken", ""};
    const uint8_t marker = b[at + 1];
    if (marker == 0xff) {  // fill byte
      ++at;
      continue;
    }
    const size_t length = bigEndian(b.data() + at + 2, 2);
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame && at + 9 <= b.size()) {
      return checked(
          {ImageHeader::Format::jpeg, bigEndian(b.data() + at + 7, 2), bigEndian(b.data() + at + 5, 2), false});
    }
    if (length < 2) break;
    at += 2 + length;
  }
  return Error{"bad-file", "the JPEG has no frame header", ""};
}

/// Formats that files name although glTF's core knows PNG and JPEG only.
const char* foreignFormat(std::span<const uint8_t> b) {
  const auto startsWith = [&](std::string_view magic) {
    return b.size() >= magic.size() && std::memcmp(b.data(), magic.data(), magic.size()) == 0;
  };
  if (startsWith("RIFF")) return "WebP";
  if (startsWith("\xabKTX")) return "KTX";
  if (startsWith("GIF8")) return "GIF";
  if (startsWith("DDS ")) return "DDS";
  if (startsWith("BM")) return "BMP";
  return nullptr;
}

/// One, two or three channels become four: grey is spread, missing alpha is 255.
void spreadChannels(std::vector<uint8_t>& rgba, size_t texels, int channels) {
  for (size_t i = texels; i-- > 0;) {  // from behind, because the packed texels lie at the front of the same memory
    uint8_t in[4] = {};
    std::copy_n(rgba.data() + i * size_t(channels), channels, in);
    const bool grey = channels < 3;
    const uint8_t out[4] = {in[0], grey ? in[0] : in[1], grey ? in[0] : in[2],
                            channels == 2   ? in[1]
                            : channels == 4 ? in[3]
                                            : uint8_t(255)};
    std::copy_n(out, 4, rgba.data() + i * 4);
  }
}

}  // namespace

Result<ImageHeader> readImageHeader(std::span<const uint8_t> bytes) {
  constexpr uint8_t kPng[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (bytes.size() >= 8 && std::memcmp(bytes.data(), kPng, 8) == 0) return pngHeader(bytes);
  if (bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff) return jpegHeader(bytes);
  if (const char* name = foreignFormat(bytes))
    return Error{"unsupported", std::string("the image is ") + name + ", not PNG or JPEG", ""};
  return Error{"bad-file", "the image is neither PNG nor JPEG", ""};
}

Result<Image> decodeImage(std::span<const uint8_t> bytes, const ImageHeader& header) {
  const bool png = header.format == ImageHeader::Format::png;
  OIIO::Filesystem::IOMemReader memory(const_cast<uint8_t*>(bytes.data()), bytes.size());
  auto opened = openOiio(png ? "png" : "jpeg", memory);
  if (!opened) return opened.error();
  OIIO::ImageInput& input = **opened;

  const OIIO::ImageSpec spec = input.spec();
  if (spec.width != int(header.width) || spec.height != int(header.height) || spec.nchannels < 1 ||
      spec.nchannels > 4) {
    return Error{"bad-file", "the image's parts contradict each other", ""};
  }
  Image image;
  image.width = header.width;
  image.height = header.height;
  const size_t texels = size_t(header.width) * header.height;
  image.rgba8.resize(texels * 4);
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, image.rgba8.data())) {
    return Error{"bad-file", "the image cannot be decoded: " + oiioMessage(input), ""};
  }
  if (spec.nchannels < 4) spreadChannels(image.rgba8, texels, spec.nchannels);
  return image;
}

}  // namespace limn
