#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/messages.gen.hpp"

namespace limn::protocol {

static_assert(kFrameHeaderBytes == 116, "the header of limn.v1 never changes its size");

/// CRC-32C (Castagnoli, reflected, as in RFC 3720) of `bytes`, continued from `crc`. Any thread.
uint32_t crc32c(std::span<const uint8_t> bytes, uint32_t crc = 0);

/// A binary message taken apart; `payload` points into the message.
struct FrameView {
  FrameHeader header;
  std::span<const uint8_t> payload;
};

/// A whole binary message: header, then payload. Sets payloadBytes and crc32c.
std::vector<uint8_t> encodeFrame(FrameHeader header, std::span<const uint8_t> payload);

/// Checks header, length ("bad-message") and CRC ("bad-message").
Result<FrameView> decodeFrame(std::span<const uint8_t> message);

}  // namespace limn::protocol
