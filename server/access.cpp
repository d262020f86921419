#include "server/access.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <optional>

#include "protocol/messages.gen.hpp"

namespace limn::server {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return out;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// The entries of a header list, without the blanks around them.
std::vector<std::string_view> split(std::string_view list, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const size_t end = list.find(separator);
    parts.push_back(trim(list.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    list.remove_prefix(end + 1);
  }
}

/// "http://host:port" -> "host:port"; nothing for anything else, "null" included.
std::optional<std::string_view> authorityOf(std::string_view origin) {
  for (const std::string_view scheme : {"http://", "https://"})
    if (origin.starts_with(scheme)) {
      const std::string_view authority = origin.substr(scheme.size());
      if (authority.empty() || authority.find_first_of("/?#@ ,") != std::string_view::npos) return std::nullopt;
      return authority;
    }
  return std::nullopt;
}

bool originAllowed(const AccessPolicy& policy, const RequestHeaders& headers) {
  if (!headers.hasOrigin) return true;
  const std::string origin = lower(headers.origin);
  for (const std::string& allowed : policy.allowedOrigins)
    if (origin == lower(allowed)) return true;
  const auto authority = authorityOf(origin);
  return authority && *authority == lower(headers.host);
}

std::optional<std::string> decodeBase64Url(std::string_view text) {
  std::string out;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    uint32_t value = 0;
    if (c >= 'A' && c <= 'Z') value = uint32_t(c - 'A');
    else if (c >= 'a' && c <= 'z') value = uint32_t(c - 'a') + 26;
    else if (c >= '0' && c <= '9') value = uint32_t(c - '0') + 52;
    else if (c == '-') value = 62;
    else if (c == '_') value = 63;
    else return std::nullopt;
    bits = bits << 6 | value;
    if ((count += 6) >= 8) {
      count -= 8;
      out.push_back(char(bits >> count & 0xff));
    }
  }
  return out;
}

}  // namespace

bool equalInConstantTime(std::string_view expected, std::string_view given) {
  if (expected.empty()) return false;
  size_t difference = expected.size() ^ given.size();
  for (size_t i = 0; i < given.size(); ++i)
    difference |= size_t(uint8_t(given[i]) ^ uint8_t(expected[i % expected.size()]));
  return difference == 0;
}

std::string_view hostWithoutPort(std::string_view authority) {
  if (authority.starts_with('[')) {
    const size_t end = authority.find(']');
    return end == std::string_view::npos ? authority : authority.substr(0, end + 1);
  }
  const size_t colon = authority.find(':');
  if (colon != std::string_view::npos && authority.find(':', colon + 1) != std::string_view::npos) return authority;
  return authority.substr(0, colon);
}

std::string tokenCookieFor(std::string_view host) {
  const std::string_view port = host.substr(hostWithoutPort(host).size());
  const bool number = port.size() > 1 && std::all_of(port.begin() + 1, port.end(), [](unsigned char c) { return std::isdigit(c); });
  return number ? "limn-token-" + std::string(port.substr(1)) : "limn-token";
}

bool isIpLiteral(std::string_view host) {
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const std::string text(host);
  in6_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1 || inet_pton(AF_INET6, text.c_str(), &address) == 1;
}

bool isLoopbackName(std::string_view host) {
  const std::string name = lower(host);
  if (name == "localhost" || name == "[::1]" || name == "::1") return true;
  return name.starts_with("127.") && isIpLiteral(name);
}

bool tokenMatches(const AccessPolicy& policy, const RequestHeaders& headers) {
  if (policy.token.empty()) return true;
  bool matches = false;
  const std::string cookie = tokenCookieFor(headers.host);
  constexpr std::string_view kBearer = "bearer ";
  if (lower(headers.authorization).starts_with(kBearer))
    matches |= equalInConstantTime(policy.token, trim(std::string_view(headers.authorization).substr(kBearer.size())));
  for (const std::string_view part : split(headers.cookie, ';')) {
    const size_t equals = part.find('=');
    if (equals != std::string_view::npos && part.substr(0, equals) == cookie)
      matches |= equalInConstantTime(policy.token, part.substr(equals + 1));
  }
  for (const std::string_view part : split(headers.subprotocols, ','))
    if (part.starts_with("bearer."))
      if (const auto decoded = decodeBase64Url(part.substr(7))) matches |= equalInConstantTime(policy.token, *decoded);
  return matches;
}

Verdict judgeHost(const AccessPolicy& policy, const RequestHeaders& headers) {
  const std::string host = lower(hostWithoutPort(headers.host));
  if (headers.oversized) return {400, "a header is too long"};
  if (host.empty()) return {400, "a Host header is needed"};
  if (isLoopbackName(host)) return {};
  if (!isLoopbackName(policy.listenHost) && (isIpLiteral(host) || host == lower(policy.listenHost))) return {};
  for (const std::string& origin : policy.allowedOrigins) {
    const std::string allowed = lower(origin);
    const auto authority = authorityOf(allowed);
    if (authority && host == hostWithoutPort(*authority)) return {};
  }
  return {403, "this Host is not served here"};
}

Verdict judgeUpgrade(const AccessPolicy& policy, const RequestHeaders& headers) {
  if (const Verdict host = judgeHost(policy, headers); !host.allowed()) return host;
  if (lower(headers.upgrade) != "websocket") return {400, "the only upgrade is websocket"};
  if (headers.hasBody) return {400, "requests have no body here"};
  if (headers.path != policy.socketPath()) return {404, "there is no socket at this path"};
  if (headers.version != "13") return {426, "Sec-WebSocket-Version 13 is needed"};
  if (!originAllowed(policy, headers)) return {403, "this Origin is not allowed"};
  const auto offered = split(headers.subprotocols, ',');
  if (std::find(offered.begin(), offered.end(), protocol::kSubprotocol) == offered.end())
    return {400, "subprotocol " + std::string(protocol::kSubprotocol) + " is needed"};
  if (!tokenMatches(policy, headers)) return {401, "a valid token is needed"};
  return {};
}

}  // namespace limn::server
