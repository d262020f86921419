#include "server/limn/send_script.hpp"

#include <sstream>

#include "protocol/json_value.hpp"
#include "renderer/base/file_bytes.hpp"

namespace limn {
namespace {

constexpr uint64_t kLongestScript = 64ull << 20;  // [byte]

/// The message with a seq that reads as valid where it has none of its own.
std::string withSeq(const std::string& line) {
  const Result<protocol::JsonValue> json = protocol::parseJson(line, protocol::kMaxJsonDepth);
  if (!json || !json->object() || json->object()->empty() || json->find("seq")) return line;
  std::string numbered = line;
  numbered.insert(numbered.find('{') + 1, "\"seq\":1,");
  return numbered;
}

}  // namespace

Result<std::vector<ScriptMessage>> parseScript(const std::string& text, const std::string& place) {
  std::vector<ScriptMessage> script;
  std::istringstream lines(text);
  size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == line.npos) continue;
    const std::string where = place + ":" + std::to_string(number);
    Result<protocol::ClientMessage> message = protocol::decodeClient(withSeq(line));
    if (!message) return errorAt(where, message.error());
    std::visit([](auto& m) { m.seq = 0; }, *message);
    script.push_back({number, where, message.take()});
  }
  return script;
}

Result<std::vector<ScriptMessage>> readScript(const std::filesystem::path& file) {
  const Result<std::vector<uint8_t>> bytes = readFileBytes(file, kLongestScript);
  if (!bytes) return bytes.error();
  return parseScript(std::string(bytes->begin(), bytes->end()), file.string());
}

Error errorAt(const std::string& place, Error error) {
  error.place = error.place.empty() ? place : place + " " + error.place;
  return error;
}

bool isEdit(const protocol::ClientMessage& message) {
  return std::holds_alternative<protocol::SetCamera>(message) ||
         std::holds_alternative<protocol::SetMessage>(message) || std::holds_alternative<protocol::Batch>(message);
}

}  // namespace limn
