// The frame header's bytes, and damaged frames.
#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "protocol/frame.hpp"

namespace limn::protocol {
namespace {

std::vector<uint8_t> bytes(std::string_view text) { return {text.begin(), text.end()}; }

TEST(ProtocolFrame, CrcOfThePublishedVectors) {
  EXPECT_EQ(crc32c(bytes("123456789")), 0xE3069283u);
  EXPECT_EQ(crc32c({}), 0u);
  // RFC 3720, appendix B.4.
  EXPECT_EQ(crc32c(std::vector<uint8_t>(32, 0x00)), 0x8A9136AAu);
  EXPECT_EQ(crc32c(std::vector<uint8_t>(32, 0xFF)), 0x62A8AB43u);
  std::vector<uint8_t> rising(32);
  std::iota(rising.begin(), rising.end(), uint8_t(0));
  EXPECT_EQ(crc32c(rising), 0x46DD794Eu);
}

TEST(ProtocolFrame, CrcCanBeContinuedAnywhere) {
  std::vector<uint8_t> data(100);
  std::iota(data.begin(), data.end(), uint8_t(7));
  const uint32_t whole = crc32c(data);
  for (size_t cut = 0; cut <= data.size(); ++cut)
    EXPECT_EQ(crc32c(std::span(data).subspan(cut), crc32c(std::span(data).first(cut))), whole) << cut;
}

TEST(ProtocolFrame, FieldsStandWhereTheSpecificationSays) {
  FrameHeader header;
  header.frameId = 0x01020304;
  header.x = 0x0506;
  header.estimatedError = std::numeric_limits<float>::infinity();
  header.stageMs[5] = 1.0f;
  const std::vector<uint8_t> message = encodeFrame(header, bytes("abc"));
  EXPECT_EQ(std::string(message.begin(), message.begin() + 4), "LMN1");
  EXPECT_EQ(message[4], 1);
  EXPECT_EQ(std::vector<uint8_t>(message.begin() + 12, message.begin() + 16), (std::vector<uint8_t>{4, 3, 2, 1}));
  EXPECT_EQ(std::vector<uint8_t>(message.begin() + 28, message.begin() + 30), (std::vector<uint8_t>{6, 5}));
  EXPECT_EQ(std::vector<uint8_t>(message.begin() + 104, message.begin() + 108), (std::vector<uint8_t>{0, 0, 0x80, 0x3F}));
  EXPECT_EQ(message[108], 3);
  EXPECT_EQ(message.size(), kFrameHeaderBytes + 3);
}

TEST(ProtocolFrame, DamagedFramesAreRefused) {
  const std::vector<uint8_t> good = encodeFrame(FrameHeader{}, bytes("payload"));
  ASSERT_TRUE(decodeFrame(good).ok());
  const auto refusal = [&](size_t offset, uint8_t value) {
    std::vector<uint8_t> bad = good;
    bad[offset] = value;
    const auto frame = decodeFrame(bad);
    return frame.ok() ? std::string("taken") : frame.error().code + " " + frame.error().place;
  };
  EXPECT_EQ(refusal(0, 'X'), "bad-message byte 0");
  EXPECT_EQ(refusal(4, 2), "version byte 4");
  EXPECT_EQ(refusal(5, 2), "out-of-range byte 5");
  EXPECT_EQ(refusal(6, 4), "out-of-range byte 6");
  EXPECT_EQ(refusal(8, 3), "out-of-range byte 8");
  EXPECT_EQ(refusal(10, 7), "out-of-range byte 10");
  EXPECT_EQ(refusal(11, 1), "bad-message byte 11");
  EXPECT_EQ(refusal(108, 8), "bad-message byte " + std::to_string(good.size()));
  EXPECT_EQ(refusal(kFrameHeaderBytes, 'X'), "bad-message byte 116");
}

TEST(ProtocolFrame, TruncatedFramesAreRefusedAtEveryLength) {
  const std::vector<uint8_t> good = encodeFrame(FrameHeader{}, bytes("payload"));
  for (size_t length = 0; length < good.size(); ++length) EXPECT_FALSE(decodeFrame(std::span(good).first(length)).ok()) << length;
}

TEST(ProtocolFrame, OnlyTheErrorMayBeInfinite) {
  FrameHeader header;
  header.estimatedError = header.errorHigh = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(decodeFrame(encodeFrame(header, {})).ok());
  header.estimatedError = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(decodeFrame(encodeFrame(header, {})).error().code, "out-of-range");
  header.estimatedError = 0.0f;
  header.renderMs = std::numeric_limits<float>::infinity();
  EXPECT_EQ(decodeFrame(encodeFrame(header, {})).error().code, "out-of-range");
}

}  // namespace
}  // namespace limn::protocol
