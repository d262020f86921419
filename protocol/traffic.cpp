#include "protocol/traffic.hpp"

#include <algorithm>
#include <fstream>
#include <unistd.h>

#include "protocol/frame.hpp"

namespace limn::protocol {
namespace {

std::string item(const ClientMessage& message) {
  const std::string op = "client " + std::string(opOf(message));
  if (const auto* set = std::get_if<SetMessage>(&message)) return op + " " + std::string(targetOf(set->edit));
  return op;
}

std::string item(const ServerMessage& message) { return "server " + std::string(opOf(message)); }

Result<void> checkCode(const ServerMessage& message) {
  const auto* error = std::get_if<ErrorMessage>(&message);
  const bool known = !error || std::find(kErrorCodes.begin(), kErrorCodes.end(), error->code) != kErrorCodes.end();
  if (known) return {};
  return Error{"bad-message", "\"" + error->code + "\" is no error code of the schema", "/code"};
}

/// The item's name, or what is wrong with the message.
Result<std::string> inspect(Direction direction, std::string_view json) {
  if (direction == Direction::toServer) {
    const Result<ClientMessage> message = decodeClient(json);
    if (!message) return message.error();
    return item(*message);
  }
  const Result<ServerMessage> message = decodeServer(json, Strictness::strict);
  if (!message) return message.error();
  if (const Result<void> known = checkCode(*message); !known) return known.error();
  return item(*message);
}

}  // namespace

Result<void> checkTraffic(Direction direction, std::string_view json) {
  const Result<std::string> name = inspect(direction, json);
  if (!name) return name.error();
  return {};
}

Result<void> checkTraffic(std::span<const uint8_t> frame) {
  const Result<FrameView> view = decodeFrame(frame);
  if (!view) return view.error();
  return {};
}

TrafficRecorder::TrafficRecorder(std::filesystem::path directory) : m_directory(std::move(directory)) {}

TrafficRecorder::~TrafficRecorder() {
  if (m_directory.empty()) return;
  std::error_code ignored;  // a directory that cannot be made shows up as items that nobody saw
  std::filesystem::create_directories(m_directory, ignored);
  std::ofstream file(m_directory / (std::to_string(getpid()) + ".seen"), std::ios::app);
  for (const std::string& name : m_seen) file << name << '\n';
}

Result<void> TrafficRecorder::text(Direction direction, std::string_view json) {
  const Result<std::string> name = inspect(direction, json);
  if (!name) return name.error();
  note(*name);
  return {};
}

Result<void> TrafficRecorder::frame(std::span<const uint8_t> message) {
  const Result<FrameView> view = decodeFrame(message);
  if (!view) return view.error();
  note("frame " + std::string(name(view->header.kind)));
  return {};
}

std::set<std::string> TrafficRecorder::seen() const {
  const std::lock_guard lock(m_mutex);
  return m_seen;
}

void TrafficRecorder::note(std::string item) {
  const std::lock_guard lock(m_mutex);
  m_seen.insert(std::move(item));
}

std::set<std::string> everyMessage() {
  std::set<std::string> all;
  for (const std::string_view op : kClientMessageOps)
    if (op != SetMessage::kOp) all.insert("client " + std::string(op));
  for (const std::string_view target : kEditTargets) all.insert("client set " + std::string(target));
  for (const std::string_view op : kServerMessageOps) all.insert("server " + std::string(op));
  for (const FrameKind kind : kFrameKinds) all.insert("frame " + std::string(name(kind)));
  return all;
}

std::set<std::string> seenIn(const std::filesystem::path& directory) {
  std::set<std::string> seen;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(directory, none)) {
    if (entry.path().extension() != ".seen") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) seen.insert(line);
  }
  return seen;
}

}  // namespace limn::protocol
