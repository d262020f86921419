#include "server/encoders.hpp"

#include <png.h>
#include <turbojpeg.h>

#include <csetjmp>
#include <memory>

namespace limn::server {
namespace {

constexpr int kPngLevel = 2;   ///< of zlib; 1..3 differ by a few percent of size and a factor of 2 in time

Result<Bytes> encodeJpeg(const Frame& frame, const EncodingKey& key) {
  const std::unique_ptr<void, int (*)(tjhandle)> encoder(tjInitCompress(), &tjDestroy);
  if (!encoder) return Error{"internal", "no JPEG encoder", ""};
  const int width = int(frame.info.width), height = int(frame.info.height);
  const int sampling = key.fullChroma ? TJSAMP_444 : TJSAMP_420;
  Bytes bytes(tjBufSize(width, height, sampling));
  unsigned char* out = bytes.data();
  unsigned long size = bytes.size();
  if (tjCompress2(encoder.get(), frame.rgba.data(), width, 0, height, TJPF_RGBX, &out, &size, sampling, key.quality,
                  TJFLAG_NOREALLOC | TJFLAG_FASTDCT) != 0)
    return Error{"internal", tjGetErrorStr2(encoder.get()), ""};
  bytes.resize(size);
  return bytes;
}

void appendToBytes(png_structp png, png_bytep data, size_t size) {
  auto& bytes = *static_cast<Bytes*>(png_get_io_ptr(png));
  bytes.insert(bytes.end(), data, data + size);
}

/// libpng leaves by longjmp: nothing with a destructor lives in this frame.
bool writePng(png_structp png, png_infop info, const Frame& frame, Bytes& bytes) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, &bytes, &appendToBytes, nullptr);
  png_set_IHDR(png, info, frame.info.width, frame.info.height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, kPngLevel);
  png_set_filter(png, 0, PNG_FILTER_SUB);
  png_write_info(png, info);
  png_set_filler(png, 0, PNG_FILLER_AFTER);
  const size_t stride = size_t(frame.info.width) * 4;
  for (uint32_t y = 0; y < frame.info.height; ++y) png_write_row(png, frame.rgba.data() + y * stride);
  png_write_end(png, info);
  return true;
}

Result<Bytes> encodePng(const Frame& frame) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  Bytes bytes;
  bytes.reserve(frame.rgba.size() / 2);
  const bool written = info && writePng(png, info, frame, bytes);
  png_destroy_write_struct(&png, &info);
  if (!written) return Error{"internal", "the PNG encoder failed", ""};
  return bytes;
}

}  // namespace

Result<Bytes> encodeImage(const Frame& frame, const EncodingKey& key) {
  const bool whole = frame.info.width > 0 && frame.info.height > 0 &&
                     frame.rgba.size() == size_t(frame.info.width) * frame.info.height * 4;
  if (!whole) return Error{"internal", "a picture without all of its pixels", ""};
  return key.codec == ImageCodec::png ? encodePng(frame) : encodeJpeg(frame, key);
}

}  // namespace limn::server
