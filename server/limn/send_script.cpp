#include "server/limn/send_script.hpp"

#include <sstream>

#include "protocol/json_value.hpp"
#include "renderer/base/file_bytes.hpp"

namespace limn {
namespace {

constexpr uint64_t kLongestScript = 64ull << 20;  // [byte]

/// The message with a seq that reads as valid, and whether it had none of its own.
std::pair<std::string, bool> withSeq(const std::string& line) {
  const Result<protocol::JsonValue> json = protocol::parseJson(line, protocol::kMaxJsonDepth);
  if (!json || !json->object() || json->object()->empty() || json->find("seq")) return {line, false};
  std::string numbered = line;
  numbered.insert(numbered.find('{') + 1, "\"seq\":1,");
  return {numbered, true};
}

}  // namespace

Result<std::vector<ScriptMessage>> parseScript(const std::string& text, const std::string& place) {
  std::vector<ScriptMessage> script;
  std::istringstream lines(text);
  size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == line.npos) continue;
    const auto [json, added] = withSeq(line);
    Result<protocol::ClientMessage> message = protocol::decodeClient(json);
    if (!message) {
      const Error& error = message.error();
      const std::string where = place + ":" + std::to_string(number);
      return Error{error.code, error.message, error.place.empty() ? where : where + " " + error.place};
    }
    if (added) std::visit([](auto& m) { m.seq = 0; }, *message);
    script.push_back({number, message.take()});
  }
  return script;
}

Result<std::vector<ScriptMessage>> readScript(const std::filesystem::path& file) {
  const Result<std::vector<uint8_t>> bytes = readFileBytes(file, kLongestScript);
  if (!bytes) return bytes.error();
  return parseScript(std::string(bytes->begin(), bytes->end()), file.string());
}

bool isEdit(const protocol::ClientMessage& message) {
  return std::holds_alternative<protocol::SetCamera>(message) ||
         std::holds_alternative<protocol::SetMessage>(message) || std::holds_alternative<protocol::Batch>(message);
}

}  // namespace limn
