#pragma once
#include <filesystem>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "renderer/base/result.hpp"

namespace limn::protocol {

enum class Direction { toServer, toClient };

/// Whether a text message is exactly what the schema says, unknown fields and unlisted error codes included. Any thread.
Result<void> checkTraffic(Direction direction, std::string_view json);
/// The same for a whole binary message, its length and CRC included.
Result<void> checkTraffic(std::span<const uint8_t> frame);

/// Checks the traffic of a test suite and remembers what has been seen, so that a message that no test sends is found.
/// Any thread. Items are named "client ping", "client set material", "server scene", "frame image".
class TrafficRecorder {
 public:
  /// With a directory, what was seen is left there in a file of this process's own when the recorder ends.
  explicit TrafficRecorder(std::filesystem::path directory = {});
  ~TrafficRecorder();
  TrafficRecorder(const TrafficRecorder&) = delete;
  TrafficRecorder& operator=(const TrafficRecorder&) = delete;

  Result<void> text(Direction direction, std::string_view json);
  Result<void> frame(std::span<const uint8_t> message);
  std::set<std::string> seen() const;

 private:
  void note(std::string item);

  std::filesystem::path m_directory;
  mutable std::mutex m_mutex;  // guards m_seen
  std::set<std::string> m_seen;
};

/// Every item that version 1 has.
std::set<std::string> everyMessage();
/// What the recorders that wrote into `directory` have seen, together.
std::set<std::string> seenIn(const std::filesystem::path& directory);

}  // namespace limn::protocol
