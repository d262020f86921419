#include "server/journal_lines.hpp"

#include <cstdio>
#include <cstdlib>

#include "protocol/frame.hpp"
#include "server/limn/hex_text.hpp"

namespace limn::server {
namespace {

constexpr size_t kSumDigits = 8, kHashDigits = 16;
constexpr std::string_view kContents = ",\"contents\":\"", kEnd = "\"}";   // around the digits, at the end of a load

std::string sumOf(std::string_view json) {
  char digits[kSumDigits + 1];
  std::snprintf(digits, sizeof digits, "%08x", protocol::crc32c({reinterpret_cast<const uint8_t*>(json.data()), json.size()}));
  return digits;
}

/// Takes the contents off the JSON; 0 where there are none.
uint64_t takeContents(std::string& json) {
  const size_t length = kContents.size() + kHashDigits + kEnd.size();
  if (json.size() < length || json.compare(json.size() - length, kContents.size(), kContents) != 0) return 0;
  const std::string digits = json.substr(json.size() - kHashDigits - kEnd.size(), kHashDigits);
  json.resize(json.size() - length);
  json += '}';
  return std::strtoull(digits.c_str(), nullptr, 16);
}

}  // namespace

std::string lineOf(const Accepted& accepted) {
  std::string json = protocol::encode(accepted.message);
  if (accepted.contents != 0) {
    json.pop_back();
    json.append(kContents).append(hexText(accepted.contents)).append(kEnd);
  }
  return sumOf(json) + " " + json + "\n";
}

bool isWhole(std::string_view line) {
  if (line.size() <= kSumDigits || line[kSumDigits] != ' ') return false;
  return sumOf(line.substr(kSumDigits + 1)) == line.substr(0, kSumDigits);
}

Result<Accepted> acceptedOf(std::string_view line) {
  std::string json(line.substr(kSumDigits + 1));
  const uint64_t contents = takeContents(json);
  Result<protocol::ClientMessage> message = protocol::decodeClient(json);
  if (!message) return message.error();
  return Accepted{message.take(), contents};
}

}  // namespace limn::server
