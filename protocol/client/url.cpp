#include "protocol/client/url.hpp"

#include <charconv>

namespace limn::protocol {
namespace {

Error badUrl(std::string_view text) {
  return {"bad-message", "not an address like ws://host:port/ws", std::string(text)};
}

}  // namespace

std::string ServerUrl::authority() const {
  const std::string name = host.find(':') == std::string::npos ? host : "[" + host + "]";
  return port == (tls ? 443 : 80) ? name : name + ":" + std::to_string(port);
}

Result<ServerUrl> parseServerUrl(std::string_view text) {
  ServerUrl url;
  std::string_view rest = text;
  if (const size_t colon = rest.find("://"); colon != std::string_view::npos) {
    const std::string_view scheme = rest.substr(0, colon);
    url.tls = scheme == "wss" || scheme == "https";
    if (!url.tls && scheme != "ws" && scheme != "http") return badUrl(text);
    rest.remove_prefix(colon + 3);
  }
  url.port = url.tls ? 443 : 80;

  const size_t slash = rest.find_first_of("/?");
  std::string_view authority = rest.substr(0, slash);
  url.path = slash == std::string_view::npos ? "/" : std::string(rest.substr(slash));
  if (url.path.front() != '/') url.path.insert(0, "/");
  if (url.path.back() == '/') url.path.append("ws");

  size_t hostEnd = authority.find(':');
  if (authority.starts_with('[')) {
    const size_t bracket = authority.find(']');
    if (bracket == std::string_view::npos) return badUrl(text);
    url.host = authority.substr(1, bracket - 1);
    hostEnd = bracket + 1 < authority.size() ? bracket + 1 : std::string_view::npos;
    if (hostEnd != std::string_view::npos && authority[hostEnd] != ':') return badUrl(text);
  } else {
    url.host = authority.substr(0, hostEnd);
  }
  if (hostEnd != std::string_view::npos) {
    const std::string_view digits = authority.substr(hostEnd + 1);
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), url.port);
    if (code != std::errc{} || end != digits.data() + digits.size() || url.port == 0) return badUrl(text);
  }
  if (url.host.empty()) return badUrl(text);
  return url;
}

}  // namespace limn::protocol
