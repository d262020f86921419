#pragma once
#include <compare>
#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/session/messages.hpp"

namespace limn::server {

enum class ImageCodec : uint8_t { jpeg, png };

/// How a picture is turned into bytes; clients that ask for the same share them.
struct EncodingKey {
  ImageCodec codec = ImageCodec::jpeg;
  uint8_t quality = 70;        ///< JPEG, 1..100; 0 for PNG
  bool fullChroma = false;     ///< JPEG 4:4:4 rather than 4:2:0
  auto operator<=>(const EncodingKey&) const = default;
};

constexpr EncodingKey kLossless{ImageCodec::png, 0, true};

using Bytes = std::vector<uint8_t>;

/// JPEG by libjpeg-turbo or PNG (8-bit RGB, no colour chunks: the pixels are what the film resolved to). The picture is
/// width*height*4 bytes. Errors: "internal". Encode thread.
Result<Bytes> encodeImage(const Frame& frame, const EncodingKey& key);

/// A picture in one encoding; never changed after it was made.
struct EncodedFrame {
  std::shared_ptr<const Frame> frame;
  EncodingKey key;
  std::shared_ptr<const Bytes> bytes;
  uint32_t crc32c = 0;         ///< of the bytes
  float encodeMs = 0.0f;
};

}  // namespace limn::server
