#include "renderer/film/exr_header.hpp"

#include <algorithm>
#include <cstring>
#include <optional>

namespace limn {
namespace {

constexpr uint32_t kMagic = 20000630;
constexpr uint32_t kDeepFlag = 0x800, kMultiPartFlag = 0x1000;
constexpr size_t kLongestName = 255;

/// Little-endian cursor that never passes the end; `failed` stays set once it would have.
struct Cursor {
  std::span<const uint8_t> bytes;
  size_t at = 0;
  bool failed = false;

  std::span<const uint8_t> take(size_t count) {
    if (failed || count > bytes.size() - at) {
      failed = true;
      return {};
    }
    at += count;
    return bytes.subspan(at - count, count);
  }
  int32_t integer() {
    const std::span<const uint8_t> four = take(4);
    int32_t value = 0;
    if (!four.empty()) std::memcpy(&value, four.data(), 4);  // every machine we run on is little-endian
    return value;
  }
  std::string name() {
    std::string text;
    for (std::span<const uint8_t> one = take(1); !one.empty() && one[0] != 0; one = take(1)) {
      text.push_back(char(one[0]));
      if (text.size() > kLongestName) failed = true;
    }
    return text;
  }
};

struct Window {
  int32_t low[2] = {}, high[2] = {};
  bool operator==(const Window&) const = default;
  int64_t side(int axis) const { return int64_t(high[axis]) - low[axis] + 1; }
};

struct Channel {
  std::string name;
  int32_t type = 0;  // 0: uint32, 1: half, 2: float
  int32_t samplingX = 1, samplingY = 1;
};

Window readWindow(Cursor& value) {
  Window window;
  for (int32_t& edge : window.low) edge = value.integer();
  for (int32_t& edge : window.high) edge = value.integer();
  return window;
}

std::vector<Channel> readChannels(Cursor& value) {
  std::vector<Channel> channels;
  for (std::string name = value.name(); !name.empty() && !value.failed; name = value.name()) {
    Channel channel{name};
    channel.type = value.integer();
    value.take(4);  // perceptual linearity and three reserved bytes
    channel.samplingX = value.integer();
    channel.samplingY = value.integer();
    channels.push_back(channel);
  }
  return channels;
}

struct Attributes {
  std::optional<Window> data, display;
  std::vector<Channel> channels;
};

/// Reads attributes up to the empty name that ends the header.
Attributes readAttributes(Cursor& cursor) {
  Attributes found;
  for (std::string name = cursor.name(); !name.empty() && !cursor.failed; name = cursor.name()) {
    const std::string type = cursor.name();
    const int32_t size = cursor.integer();
    Cursor value{cursor.take(size < 0 ? SIZE_MAX : size_t(size))};
    if (cursor.failed) break;
    if (name == "dataWindow" && type == "box2i") found.data = readWindow(value);
    if (name == "displayWindow" && type == "box2i") found.display = readWindow(value);
    if (name == "channels" && type == "chlist") found.channels = readChannels(value);
    cursor.failed = value.failed;
  }
  return found;
}

std::optional<Error> judge(const Attributes& found, const ExrLimits& limits, const std::string& place) {
  if (!found.data || !found.display || found.channels.empty())
    return Error{"bad-file", "the header lacks its windows or channels", place};
  const int64_t width = found.data->side(0), height = found.data->side(1);
  if (width < 1 || height < 1) return Error{"bad-file", "the data window is empty", place};
  if (width > limits.maxSide || height > limits.maxSide)
    return Error{"limit", "a side exceeds " + std::to_string(limits.maxSide) + " pixels", place};
  if (found.channels.size() > limits.maxChannels)
    return Error{"limit", "more than " + std::to_string(limits.maxChannels) + " channels", place};
  if (uint64_t(width) * uint64_t(height) * found.channels.size() * 4 > limits.maxPixelBytes)
    return Error{"limit", "the pixels exceed " + std::to_string(limits.maxPixelBytes) + " bytes", place};
  if (*found.data != *found.display)
    return Error{"unsupported", "cropped: the data window is not the display window", place};
  for (const Channel& channel : found.channels) {
    if (channel.type < 0 || channel.type > 2)
      return Error{"bad-file", "channel " + channel.name + " has an unknown type", place};
    if (channel.type == 0) return Error{"unsupported", "channel " + channel.name + " holds integers", place};
    if (channel.samplingX != 1 || channel.samplingY != 1)
      return Error{"unsupported", "channel " + channel.name + " is subsampled", place};
  }
  return std::nullopt;
}

}  // namespace

Result<ExrHeader> readExrHeader(std::span<const uint8_t> bytes, const ExrLimits& limits, const std::string& place) {
  Cursor cursor{bytes};
  const uint32_t magic = uint32_t(cursor.integer());
  const uint32_t version = uint32_t(cursor.integer());
  const bool known = !cursor.failed && magic == kMagic && (version & 0xff) == 2;
  if (!known) return Error{"bad-file", "not an OpenEXR 2 file", place};
  if (version & kDeepFlag) return Error{"unsupported", "a deep image", place};
  if (version & kMultiPartFlag) return Error{"unsupported", "a multi-part file", place};

  const Attributes found = readAttributes(cursor);
  if (cursor.failed) return Error{"bad-file", "the header is truncated at byte " + std::to_string(cursor.at), place};
  if (std::optional<Error> refused = judge(found, limits, place)) return *refused;

  ExrHeader header{uint32_t(found.data->side(0)), uint32_t(found.data->side(1)), {}};
  for (const Channel& channel : found.channels) header.channels.push_back(channel.name);
  return header;
}

}  // namespace limn
