#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "renderer/base/result.hpp"

namespace limn::protocol {

/// Where a server listens.
struct ServerUrl {
  bool tls = false;
  std::string host;      ///< name or address, IPv6 without brackets
  uint16_t port = 80;
  std::string path;      ///< of the WebSocket, with query: "/ws"
  std::string authority() const;  ///< for the Host header: "[::1]:8080"
};

/// Reads "ws://host:port/path", "http://host:port/" (as a person copies it from the browser: "ws" is appended to a path that
/// ends in "/") or "host:port". Error "bad-message" when it is none of these.
Result<ServerUrl> parseServerUrl(std::string_view text);

}  // namespace limn::protocol
