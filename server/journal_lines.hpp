#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "protocol/messages.gen.hpp"
#include "renderer/base/result.hpp"

namespace limn::server {

/// An accepted message as a journal keeps it.
struct Accepted {
  protocol::ClientMessage message;
  uint64_t contents = 0;               ///< of the file of a `load`: LoadReport::contents; 0: not known
  bool operator==(const Accepted&) const = default;
};

/// The line of a message: CRC-32C of the JSON in hexadecimal, a blank, the JSON, its end. A load's JSON has the member `contents` too.
std::string lineOf(const Accepted& accepted);
/// Whether a line, without its end, is neither torn nor wrong.
bool isWhole(std::string_view line);
/// What a whole line says. Errors: those of protocol::decodeClient.
Result<Accepted> acceptedOf(std::string_view line);

}  // namespace limn::server
