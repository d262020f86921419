#include "protocol/frame.hpp"

#include <algorithm>
#include <array>

#include "protocol/frame_bytes.hpp"

namespace limn::protocol {
namespace {

constexpr uint32_t kPolynomial = 0x82F63B78u;  // Castagnoli, bits reversed

/// kTables[k][b]: the CRC of byte b followed by k zero bytes.
constexpr auto kTables = [] {
  std::array<std::array<uint32_t, 256>, 8> tables{};
  for (uint32_t b = 0; b < 256; ++b) {
    uint32_t crc = b;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) ? kPolynomial : 0u);
    tables[0][b] = crc;
  }
  for (size_t k = 1; k < 8; ++k)
    for (size_t b = 0; b < 256; ++b) tables[k][b] = (tables[k - 1][b] >> 8) ^ tables[0][tables[k - 1][b] & 0xFF];
  return tables;
}();

}  // namespace

uint32_t crc32c(std::span<const uint8_t> bytes, uint32_t crc) {
  crc = ~crc;
  // Slicing by 8: eight bytes a turn, each through the table for its distance from the end.
  while (bytes.size() >= 8) {
    const uint32_t low = crc ^ load<uint32_t>(bytes, 0);
    const uint32_t high = load<uint32_t>(bytes, 4);
    crc = kTables[7][low & 0xFF] ^ kTables[6][(low >> 8) & 0xFF] ^ kTables[5][(low >> 16) & 0xFF] ^ kTables[4][low >> 24] ^
          kTables[3][high & 0xFF] ^ kTables[2][(high >> 8) & 0xFF] ^ kTables[1][(high >> 16) & 0xFF] ^ kTables[0][high >> 24];
    bytes = bytes.subspan(8);
  }
  for (const uint8_t byte : bytes) crc = (crc >> 8) ^ kTables[0][(crc ^ byte) & 0xFF];
  return ~crc;
}

std::vector<uint8_t> encodeFrame(FrameHeader header, std::span<const uint8_t> payload) {
  LIMN_CHECK(payload.size() <= UINT32_MAX);
  header.payloadBytes = uint32_t(payload.size());
  header.crc32c = crc32c(payload);
  std::vector<uint8_t> message(kFrameHeaderBytes + payload.size());
  encodeFrameHeader(header, std::span(message).first<kFrameHeaderBytes>());
  std::copy(payload.begin(), payload.end(), message.begin() + kFrameHeaderBytes);
  return message;
}

Result<FrameView> decodeFrame(std::span<const uint8_t> message) {
  Result<FrameHeader> header = decodeFrameHeader(message);
  if (!header) return header.error();
  const std::span<const uint8_t> payload = message.subspan(kFrameHeaderBytes);
  if (payload.size() != header->payloadBytes)
    return headerError("bad-message", "the payload is not as long as the header says", message.size());
  if (crc32c(payload) != header->crc32c) return headerError("bad-message", "the payload's CRC is wrong", kFrameHeaderBytes);
  return FrameView{*header, payload};
}

}  // namespace limn::protocol
