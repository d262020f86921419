#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstring>

#include "server/transport_lws.hpp"

namespace limn::server {
namespace {

constexpr int kMaxHeaderBytes = 4096;
constexpr size_t kHeaderSpace = 4096;   ///< of a reply
constexpr int kStalledHttpSeconds = 10;

/// What every reply says, besides its own headers.
constexpr const char* kContentPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "connect-src 'self' ws: wss:; worker-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";
constexpr std::pair<const char*, const char*> kEveryReply[] = {
    {"content-security-policy:", kContentPolicy},
    {"x-content-type-options:", "nosniff"},
    {"referrer-policy:", "no-referrer"},
    {"cross-origin-resource-policy:", "same-origin"},
};

/// The value of a header of the request; nothing when it is too long to be looked at.
std::optional<std::string> header(lws* wsi, lws_token_indexes token) {
  const int length = lws_hdr_total_length(wsi, token);
  if (length <= 0) return std::string();
  if (length > kMaxHeaderBytes) return std::nullopt;
  std::string text(size_t(length) + 64, '\0');
  const int copied = lws_hdr_copy(wsi, text.data(), int(text.size()), token);
  if (copied < 0) return std::nullopt;
  text.resize(std::strlen(text.c_str()));
  return text;
}

std::string peerAddress(int socket) {
  sockaddr_storage address{};
  socklen_t length = sizeof address;
  char text[INET6_ADDRSTRLEN] = "";
  if (getpeername(socket, reinterpret_cast<sockaddr*>(&address), &length) != 0) return "?";
  if (address.ss_family == AF_INET)
    inet_ntop(AF_INET, &reinterpret_cast<sockaddr_in*>(&address)->sin_addr, text, sizeof text);
  else if (address.ss_family == AF_INET6)
    inet_ntop(AF_INET6, &reinterpret_cast<sockaddr_in6*>(&address)->sin6_addr, text, sizeof text);
  return text;
}

int refuse(lws* wsi, int status, const std::string& reason) {
  lws_return_http_status(wsi, unsigned(status), reason.c_str());
  return -1;
}

}  // namespace

RequestHeaders readHeaders(lws* wsi, std::string_view path) {
  RequestHeaders headers;
  headers.path = path;
  const auto read = [&](lws_token_indexes token, std::string& into) {
    if (auto text = header(wsi, token)) into = std::move(*text);
    else headers.oversized = true;
  };
  if (path.empty()) read(WSI_TOKEN_GET_URI, headers.path);
  read(WSI_TOKEN_HOST, headers.host);
  read(WSI_TOKEN_ORIGIN, headers.origin);
  read(WSI_TOKEN_HTTP_AUTHORIZATION, headers.authorization);
  read(WSI_TOKEN_HTTP_COOKIE, headers.cookie);
  read(WSI_TOKEN_UPGRADE, headers.upgrade);
  read(WSI_TOKEN_PROTOCOL, headers.subprotocols);
  read(WSI_TOKEN_VERSION, headers.version);
  headers.hasOrigin = lws_hdr_total_length(wsi, WSI_TOKEN_ORIGIN) > 0;
  headers.hasBody = lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_CONTENT_LENGTH) > 0 ||
                    lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_TRANSFER_ENCODING) > 0;
  return headers;
}

int LwsTransport::filterNetwork(lws*, void* in) {
  const std::string address = peerAddress(int(reinterpret_cast<intptr_t>(in)));
  const auto fromThere = std::count_if(m_connections.begin(), m_connections.end(),
                                       [&](const auto& entry) { return entry.second == address; });
  if (m_connections.size() < m_config.maxConnections && fromThere < long(m_config.maxConnectionsPerPeer)) return 0;
  ++m_counters.connectionsRefused;
  return -1;
}

void LwsTransport::rememberConnection(lws* wsi) {
  m_connections[wsi] = peerAddress(lws_get_socket_fd(wsi));
  m_counters.connections = uint32_t(m_connections.size());
}

void LwsTransport::forgetConnection(lws* wsi) {
  m_connections.erase(wsi);
  m_counters.connections = uint32_t(m_connections.size());
}

int LwsTransport::filterHttp(lws* wsi) {
  const bool reads =
      lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) > 0 || lws_hdr_total_length(wsi, WSI_TOKEN_HEAD_URI) > 0;
  const bool hasBody = readHeaders(wsi, "/").hasBody;
  if (reads && !hasBody) return 0;
  ++m_counters.httpRefused;
  return reads ? refuse(wsi, 400, "requests have no body here") : refuse(wsi, 405, "GET and HEAD only");
}

int LwsTransport::confirmUpgrade(lws* wsi) {
  // The argument `in` of this callback is never touched: lws 4.1.6 may have freed what it points to (CVE-2025-11677).
  // It answers an unknown Upgrade with 403 itself and comes here all the same, on a kept-alive connection without
  // headers.
  if (lws_hdr_total_length(wsi, WSI_TOKEN_UPGRADE) <= 0) return -1;
  const RequestHeaders headers = readHeaders(wsi, "");
  Verdict verdict = judgeUpgrade(m_config.access, headers);
  if (verdict.allowed() && m_drainAsked) verdict = {503, "the daemon stops"};
  if (verdict.allowed() && !m_handler.acceptsClients()) verdict = {503, "the renderer is not ready"};
  if (verdict.allowed() && m_peers.size() >= m_config.maxClients) verdict = {503, "too many clients"};
  if (verdict.allowed()) return 0;
  ++m_counters.upgradesRefused;
  return refuse(wsi, verdict.status, verdict.reason);
}

int LwsTransport::answerHttp(lws* wsi, LwsHttp** slot, std::string_view path) {
  ++m_counters.httpRequests;
  HttpRequest request;
  request.headers = readHeaders(wsi, path);
  request.query = header(wsi, WSI_TOKEN_HTTP_URI_ARGS).value_or("");
  request.ifNoneMatch = header(wsi, WSI_TOKEN_HTTP_IF_NONE_MATCH).value_or("");
  request.acceptsGzip = header(wsi, WSI_TOKEN_HTTP_ACCEPT_ENCODING).value_or("").find("gzip") != std::string::npos;
  request.fromLoopback = isLoopbackName(peerAddress(lws_get_socket_fd(wsi)));

  auto exchange = std::make_unique<LwsHttp>();
  exchange->reply = m_handler.onHttp(request);
  if (exchange->reply.status >= 400) ++m_counters.httpRefused;
  const bool withBody = lws_hdr_total_length(wsi, WSI_TOKEN_HEAD_URI) <= 0 && !exchange->reply.body().empty();
  if (sendHttpHeaders(wsi, exchange->reply) != 0) return -1;
  if (!withBody) return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
  delete *slot;
  *slot = exchange.release();
  lws_callback_on_writable(wsi);
  return 0;
}

int LwsTransport::sendHttpHeaders(lws* wsi, const HttpReply& reply) {
  std::array<unsigned char, LWS_PRE + kHeaderSpace> space;
  unsigned char* const begin = space.data() + LWS_PRE;
  unsigned char* cursor = begin;
  unsigned char* const end = space.data() + space.size() - 1;
  if (lws_add_http_common_headers(wsi, unsigned(reply.status), reply.mime.c_str(), reply.body().size(), &cursor, end))
    return -1;
  const auto add = [&](const char* name, std::string_view value) {
    return lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>(name),
                                       reinterpret_cast<const unsigned char*>(value.data()), int(value.size()), &cursor,
                                       end);
  };
  for (const auto& [name, value] : kEveryReply)
    if (add(name, value)) return -1;
  for (const auto& [name, value] : reply.headers)
    if (add(name.c_str(), value)) return -1;
  return lws_finalize_write_http_header(wsi, begin, &cursor, end);
}

int LwsTransport::writeHttp(lws* wsi, LwsHttp** slot) {
  if (!slot || !*slot) return 0;
  LwsHttp& exchange = **slot;
  const std::string_view body = exchange.reply.body();
  const size_t size = std::min(kFragmentBytes, body.size() - exchange.sent);
  const bool last = exchange.sent + size == body.size();
  std::vector<unsigned char> piece(LWS_PRE + size);
  std::memcpy(piece.data() + LWS_PRE, body.data() + exchange.sent, size);
  lws_set_timeout(wsi, PENDING_TIMEOUT_HTTP_CONTENT, kStalledHttpSeconds);
  if (lws_write(wsi, piece.data() + LWS_PRE, size, last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < 0) return -1;
  exchange.sent += size;
  if (!last) {
    lws_callback_on_writable(wsi);
    return 0;
  }
  delete *slot;
  *slot = nullptr;
  return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
}

}  // namespace limn::server
