// The examples in protocol/golden are read and written again byte for byte, and between them show every message.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/frame.hpp"
#include "protocol/traffic.hpp"

namespace limn::protocol {
namespace {

const std::filesystem::path kGolden = std::filesystem::path(LIMN_SOURCE_DIR) / "protocol/golden";

struct Example {
  std::string place;  ///< "client_set.jsonl:3"
  Direction direction;
  std::string json;
};

std::vector<Example> examples() {
  std::vector<Example> all;
  for (const auto& entry : std::filesystem::directory_iterator(kGolden)) {
    if (entry.path().extension() != ".jsonl") continue;
    const std::string name = entry.path().filename().string();
    const Direction direction = name.starts_with("client_") ? Direction::toServer : Direction::toClient;
    std::ifstream file(entry.path());
    int number = 0;
    for (std::string line; std::getline(file, line);) all.push_back({name + ":" + std::to_string(++number), direction, line});
  }
  return all;
}

std::string reWritten(const Example& example) {
  if (example.direction == Direction::toServer) {
    const auto message = decodeClient(example.json);
    return message ? encode(*message) : message.error().text();
  }
  const auto message = decodeServer(example.json, Strictness::strict);
  return message ? encode(*message) : message.error().text();
}

std::vector<uint8_t> bytesOfHex(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<uint8_t> bytes;
  for (std::string line; std::getline(file, line);)
    for (size_t i = 0; i + 1 < line.size(); i += 2) bytes.push_back(uint8_t(std::stoul(line.substr(i, 2), nullptr, 16)));
  return bytes;
}

TEST(ProtocolGolden, MessagesAreWrittenAsTheyWereRead) {
  ASSERT_GE(examples().size(), 40u);
  for (const Example& example : examples()) EXPECT_EQ(reWritten(example), example.json) << example.place;
}

TEST(ProtocolGolden, EveryMessageHasAnExample) {
  TrafficRecorder recorder;
  for (const Example& example : examples()) {
    const auto checked = recorder.text(example.direction, example.json);
    EXPECT_TRUE(checked.ok()) << example.place << " " << checked.error().text();
  }
  for (const char* name : {"frame_moving.hex", "frame_final.hex", "frame_file.hex"})
    EXPECT_TRUE(recorder.frame(bytesOfHex(kGolden / name)).ok()) << name;
  EXPECT_EQ(recorder.seen(), everyMessage());
}

TEST(ProtocolGolden, FramesAreWrittenAsTheyWereRead) {
  for (const char* name : {"frame_moving.hex", "frame_final.hex", "frame_file.hex"}) {
    const std::vector<uint8_t> bytes = bytesOfHex(kGolden / name);
    const auto frame = decodeFrame(bytes);
    ASSERT_TRUE(frame.ok()) << name << " " << frame.error().text();
    EXPECT_EQ(encodeFrame(frame->header, frame->payload), bytes) << name;
  }
}

TEST(ProtocolGolden, TheMovingFrameSaysWhatItWasMadeWith) {
  const std::vector<uint8_t> bytes = bytesOfHex(kGolden / "frame_moving.hex");
  const auto frame = decodeFrame(bytes);
  ASSERT_TRUE(frame.ok());
  const FrameHeader& h = frame->header;
  EXPECT_EQ(h.kind, FrameKind::image);
  EXPECT_EQ(h.encoding, Encoding::jpeg);
  EXPECT_EQ(h.flags, kFrameMoving | kFrameFull);
  EXPECT_EQ(h.quality, 60);
  EXPECT_EQ(h.frameId, 4294967295u);
  EXPECT_EQ(h.ackSeq, 2147483648u);
  EXPECT_EQ(h.viewRevision, 65536u);
  EXPECT_EQ(h.fullHeight, 720);
  EXPECT_EQ(h.imageWidth, 640);
  EXPECT_EQ(h.replaced, 17u);
  EXPECT_TRUE(std::isinf(h.estimatedError));
  EXPECT_EQ(h.msSinceEdit, 33.5f);
  EXPECT_EQ(h.stageMs[2], 0.75f);
  EXPECT_EQ(frame->payload.size(), 8u);
}

}  // namespace
}  // namespace limn::protocol
