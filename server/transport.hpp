#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/messages.gen.hpp"
#include "renderer/base/result.hpp"
#include "server/access.hpp"

namespace limn::server {

using ConnectionId = uint64_t;  ///< of one WebSocket; from 1, never used twice

/// Why a connection is closed.
enum class CloseCode : uint16_t {
  normal = protocol::kCloseNormal, goingAway = protocol::kCloseGoingAway, unacceptable = protocol::kCloseUnacceptable,
  policy = protocol::kClosePolicy, tooBig = protocol::kCloseTooBig, internal = protocol::kCloseInternal
};

struct TransportConfig {
  std::string address = "127.0.0.1";         ///< IPv4, IPv6 or "localhost"
  uint16_t port = 0;                         ///< 0: the system picks one
  AccessPolicy access;
  uint32_t maxClients = 16;                  ///< open WebSockets
  uint32_t maxConnections = 200;             ///< open sockets, HTTP included
  uint32_t maxConnectionsPerPeer = 100;      ///< of one IP address
  size_t maxMessageBytes = protocol::kMaxControlBytes;   ///< incoming
  uint32_t maxFragments = protocol::kMaxFragments;              ///< of one incoming message
  double messagesPerSecond = 400, messageBurst = 800;                 ///< incoming, per connection; then reading pauses
  double bytesPerSecond = 4.0 * (1 << 20), byteBurst = 8.0 * (1 << 20);
  double stalledSeconds = 10.0;              ///< a peer that takes nothing for so long is cut off
  double drainSeconds = 5.0;                 ///< the longest a drain waits for peers to close
};

/// A message on its way out. `head` belongs to this connection, `body` may be shared with others and is never written
/// to.
struct OutgoingMessage {
  bool binary = false;
  std::string head;
  std::shared_ptr<const std::vector<uint8_t>> body;
  size_t size() const { return head.size() + (body ? body->size() : 0); }
};

struct HttpRequest {
  RequestHeaders headers;         ///< path is relative to the base path: "/", "/metrics"
  std::string query;              ///< without "?"
  std::string ifNoneMatch;
  bool acceptsGzip = false;
  bool fromLoopback = false;
};
struct HttpReply {
  int status = 200;
  std::string mime = "text/plain; charset=utf-8";
  std::vector<std::pair<std::string, std::string>> headers;  ///< names lower case, with the colon: "etag:"
  std::string text;               ///< the body, or
  std::string_view fixed;         ///< bytes that outlive the process's last connection
  std::string_view body() const { return fixed.empty() ? std::string_view(text) : fixed; }
};

/// What the transport counts. Loop thread.
struct TransportCounters {
  uint64_t connectionsRefused = 0, upgradesRefused = 0, httpRequests = 0, httpRefused = 0;
  uint64_t messagesReceived = 0, bytesReceived = 0, messagesSent = 0, bytesSent = 0, fragmentsSent = 0;
  uint64_t oversizedMessages = 0, readPauses = 0, stalledKills = 0, logLinesSuppressed = 0;
  uint32_t connections = 0, clients = 0;
  double maxCallbackMs = 0.0;     ///< the longest callback since the start
};

/// What the transport calls, always on the loop thread. Nothing here may block.
class TransportHandler {
 public:
  virtual ~TransportHandler() = default;
  virtual bool acceptsClients() = 0;  ///< whether an upgrade may be granted now
  virtual void onOpen(ConnectionId id) = 0;
  /// A whole text message, valid UTF-8.
  virtual void onMessage(ConnectionId id, std::string_view text) = 0;
  /// The peer can take a message: the newest is made now. Nothing: wantWrite() asks again.
  virtual std::optional<OutgoingMessage> nextMessage(ConnectionId id) = 0;
  /// The last byte of a message was handed to the system.
  virtual void onSent(ConnectionId id) = 0;
  virtual void onClose(ConnectionId id) = 0;
  virtual HttpReply onHttp(const HttpRequest& request) = 0;
  virtual void onWake() = 0;      ///< some thread called wake(); calls may have been merged
  virtual void onTick() = 0;      ///< about every 50 ms
  virtual void onDrain() = 0;     ///< once: say good-bye and close every connection
};

/// HTTP and WebSocket on one port, one thread. All calls on the loop thread, but for wake() and drain().
class Transport {
 public:
  /// Listens at once. Errors: "listen".
  static Result<std::unique_ptr<Transport>> open(const TransportConfig& config, TransportHandler& handler);
  virtual ~Transport() = default;

  virtual uint16_t port() const = 0;
  /// Serves until a drain is over.
  virtual void run() = 0;
  virtual void wake() = 0;        ///< any thread
  /// Any thread: upgrades are refused from now on, the handler says good-bye, and run() returns when every WebSocket is
  /// gone or `drainSeconds` are over. HTTP is answered until then, so that /readyz can tell.
  virtual void drain() = 0;
  virtual bool draining() const = 0;
  virtual void wantWrite(ConnectionId id) = 0;
  /// Closes with a code, after the message that is being sent.
  virtual void close(ConnectionId id, CloseCode code, std::string_view reason) = 0;
  /// Cuts the connection off without a handshake.
  virtual void kill(ConnectionId id) = 0;
  virtual const TransportCounters& counters() const = 0;
};

}  // namespace limn::server
