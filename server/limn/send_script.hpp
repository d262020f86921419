#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "protocol/messages.gen.hpp"
#include "renderer/base/result.hpp"

namespace limn {

/// One line of a script for `limn send`.
struct ScriptMessage {
  size_t line = 0;                     ///< in the file, from 1
  std::string place;                   ///< "edits.jsonl:3"
  protocol::ClientMessage message;     ///< seq 0, whatever the line says: the client numbers it among its own messages
};

/// Reads one JSON message a line, with or without a seq; blank lines are passed over. The whole script is read before
/// anything is sent.
/// Errors: those of the protocol's strict reading, with `place`, the line and the pointer as their place.
Result<std::vector<ScriptMessage>> parseScript(const std::string& text, const std::string& place);
Result<std::vector<ScriptMessage>> readScript(const std::filesystem::path& file);

/// The error with the script's `place` before its own.
Error errorAt(const std::string& place, Error error);

/// Whether the message changes what is seen, so that it is worth waiting for a frame that shows it.
bool isEdit(const protocol::ClientMessage& message);

}  // namespace limn
