#pragma once
#include <libwebsockets.h>

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "protocol/messages.gen.hpp"
#include "server/message_assembler.hpp"
#include "server/token_bucket.hpp"
#include "server/transport.hpp"

namespace limn::server {

constexpr size_t kFragmentBytes = protocol::kMaxFragmentBytes;
constexpr double kTickSeconds = 0.05;

/// One WebSocket. Loop thread.
struct LwsPeer {
  LwsPeer(ConnectionId peerId, lws* handle, const TransportConfig& config)
      : id(peerId), wsi(handle), incoming(config.maxMessageBytes, config.maxFragments),
        messages(config.messagesPerSecond, config.messageBurst), bytes(config.bytesPerSecond, config.byteBurst) {}

  ConnectionId id;
  lws* wsi;
  MessageAssembler incoming;
  TokenBucket messages, bytes;
  bool readingPaused = false;
  bool killed = false;

  std::optional<OutgoingMessage> outgoing;
  size_t sent = 0;                       ///< bytes of `outgoing` handed to lws
  double waitingSince = 0.0;             ///< a write was asked for and not granted since then; 0: none
  std::vector<uint8_t> scratch;          ///< LWS_PRE | one fragment: lws writes its header in front of the payload

  CloseCode closeCode = CloseCode::normal;
  std::string closeReason;
  bool closing = false;
};

/// One HTTP exchange. Loop thread.
struct LwsHttp {
  HttpReply reply;
  size_t sent = 0;
};

/// Transport over libwebsockets 4.1.6; no other file but transport_lws*.cpp knows the library.
class LwsTransport final : public Transport {
 public:
  LwsTransport(const TransportConfig& config, TransportHandler& handler);
  ~LwsTransport() override;
  LwsTransport(const LwsTransport&) = delete;
  LwsTransport& operator=(const LwsTransport&) = delete;

  Result<void> listen();

  uint16_t port() const override { return m_port; }
  void run() override;
  void wake() override;
  void drain() override;
  bool draining() const override { return m_drainAsked; }
  void wantWrite(ConnectionId id) override;
  void close(ConnectionId id, CloseCode code, std::string_view reason) override;
  void kill(ConnectionId id) override;
  const TransportCounters& counters() const override { return m_counters; }

 private:
  static int httpCallback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length);
  static int socketCallback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length);
  static LwsTransport& of(lws* wsi) { return *static_cast<LwsTransport*>(lws_context_user(lws_get_context(wsi))); }
  int onHttpEvent(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length);
  int onSocketEvent(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length);

  // transport_lws.cpp
  void onWakeUp();
  void tick();
  void beginDrain(double now);
  static void onTimer(lws_sorted_usec_list_t* timer);
  void scheduleTick();

  // transport_lws_http.cpp
  int filterNetwork(lws* wsi, void* in);
  void rememberConnection(lws* wsi);
  void forgetConnection(lws* wsi);
  int filterHttp(lws* wsi);
  int confirmUpgrade(lws* wsi);
  int answerHttp(lws* wsi, LwsHttp** slot, std::string_view path);
  int writeHttp(lws* wsi, LwsHttp** slot);
  int sendHttpHeaders(lws* wsi, const HttpReply& reply);

  // transport_lws_ws.cpp
  int openPeer(lws* wsi, LwsPeer** slot);
  int receive(LwsPeer& peer, void* in, size_t length);
  int receiveWhole(LwsPeer& peer);
  int writePeer(LwsPeer& peer);
  int writeFragment(LwsPeer& peer);
  void closePeer(LwsPeer** slot);
  void watchPeer(LwsPeer& peer, double now);
  LwsPeer* find(ConnectionId id);
  void askToWrite(LwsPeer& peer);

  const TransportConfig m_config;
  TransportHandler& m_handler;
  lws_context* m_context = nullptr;
  lws_vhost* m_vhost = nullptr;
  std::array<lws_protocols, 3> m_protocols{};
  struct Timer { lws_sorted_usec_list_t sul{}; LwsTransport* owner = nullptr; } m_timer;
  uint16_t m_port = 0;

  std::unordered_map<ConnectionId, std::unique_ptr<LwsPeer>> m_peers;
  std::unordered_map<lws*, std::string> m_connections;  ///< open sockets and the addresses they come from
  ConnectionId m_nextId = 1;
  TransportCounters m_counters;

  std::atomic<bool> m_drainAsked{false};  ///< written by any thread
  bool m_drainBegun = false;
  double m_drainEnd = 0.0;                ///< [s]
  bool m_finished = false;
};

/// Routes lws' own log lines to ours, a few a second; returns and forgets how many were left out.
void installLwsLog();
uint64_t takeSuppressedLwsLines();
std::string lastLwsError();

/// The headers the policy looks at, of a request whose header table is still attached.
RequestHeaders readHeaders(lws* wsi, std::string_view path);

}  // namespace limn::server
