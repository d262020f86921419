#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstring>

#include "renderer/base/clock.hpp"
#include "server/transport_lws.hpp"

namespace limn::server {
namespace {

constexpr int kNotSentLowWater = 131072;      ///< [byte] unsent in the system's buffer before we are asked for more
constexpr int kUnacknowledgedMs = 20000;      ///< [ms] then the connection is dead
constexpr size_t kMaxCloseReason = 123;       ///< [byte] RFC 6455 section 5.5

void tuneSocket(int socket) {
  setsockopt(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kNotSentLowWater, sizeof kNotSentLowWater);
  setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &kUnacknowledgedMs, sizeof kUnacknowledgedMs);
}

int closeNow(lws* wsi, CloseCode code, std::string_view reason) {
  std::string text(reason.substr(0, kMaxCloseReason));
  lws_close_reason(wsi, lws_close_status(code), reinterpret_cast<unsigned char*>(text.data()), text.size());
  return -1;
}

}  // namespace

LwsPeer* LwsTransport::find(ConnectionId id) {
  const auto found = m_peers.find(id);
  return found == m_peers.end() ? nullptr : found->second.get();
}

int LwsTransport::openPeer(lws* wsi, LwsPeer** slot) {
  auto peer = std::make_unique<LwsPeer>(m_nextId++, wsi, m_config);
  peer->scratch.resize(LWS_PRE + kFragmentBytes);
  tuneSocket(lws_get_socket_fd(wsi));
  *slot = peer.get();
  const ConnectionId id = peer->id;
  m_peers.emplace(id, std::move(peer));
  m_counters.clients = uint32_t(m_peers.size());
  m_handler.onOpen(id);
  return 0;
}

void LwsTransport::closePeer(LwsPeer** slot) {
  if (!slot || !*slot) return;
  const ConnectionId id = (*slot)->id;
  *slot = nullptr;
  m_peers.erase(id);
  m_counters.clients = uint32_t(m_peers.size());
  m_handler.onClose(id);
}

int LwsTransport::receive(LwsPeer& peer, void* in, size_t length) {
  const double now = nowSeconds();
  m_counters.bytesReceived += length;
  peer.bytes.take(double(length), now);
  if (peer.closing) return 0;
  if (lws_frame_is_binary(peer.wsi))
    return closeNow(peer.wsi, CloseCode::unacceptable, "messages to the daemon are text");
  const bool endsFrame = lws_remaining_packet_payload(peer.wsi) == 0;
  switch (peer.incoming.add({static_cast<const char*>(in), length}, endsFrame,
                            endsFrame && lws_is_final_fragment(peer.wsi))) {
    case MessageAssembler::State::more: return 0;
    case MessageAssembler::State::complete: return receiveWhole(peer);
    case MessageAssembler::State::tooManyFragments: return closeNow(peer.wsi, CloseCode::policy, "too many fragments");
    case MessageAssembler::State::emptyFragment: return closeNow(peer.wsi, CloseCode::policy, "an empty fragment");
    case MessageAssembler::State::tooBig: break;
  }
  ++m_counters.oversizedMessages;
  return closeNow(peer.wsi, CloseCode::tooBig, "the message is over the limit");
}

int LwsTransport::receiveWhole(LwsPeer& peer) {
  const double now = nowSeconds();
  ++m_counters.messagesReceived;
  peer.messages.take(1.0, now);
  if (!peer.readingPaused && (peer.messages.empty(now) || peer.bytes.empty(now))) {
    peer.readingPaused = true;
    ++m_counters.readPauses;
    lws_rx_flow_control(peer.wsi, 0);
  }
  m_handler.onMessage(peer.id, peer.incoming.text());
  return 0;
}

int LwsTransport::writePeer(LwsPeer& peer) {
  peer.waitingSince = 0.0;
  if (!peer.outgoing) {
    if (peer.closing) return closeNow(peer.wsi, peer.closeCode, peer.closeReason);
    peer.outgoing = m_handler.nextMessage(peer.id);
    peer.sent = 0;
    if (!peer.outgoing) return 0;
  }
  return writeFragment(peer);
}

int LwsTransport::writeFragment(LwsPeer& peer) {
  const OutgoingMessage& message = *peer.outgoing;
  const size_t total = message.size();
  const size_t size = std::min(kFragmentBytes, total - peer.sent);
  uint8_t* const payload = peer.scratch.data() + LWS_PRE;
  size_t filled = 0;
  if (peer.sent < message.head.size()) {
    filled = std::min(size, message.head.size() - peer.sent);
    std::memcpy(payload, message.head.data() + peer.sent, filled);
  }
  if (filled < size)
    std::memcpy(payload + filled, message.body->data() + (peer.sent + filled - message.head.size()), size - filled);

  const int first = peer.sent == 0, last = peer.sent + size == total;
  const auto flags = lws_write_ws_flags(message.binary ? LWS_WRITE_BINARY : LWS_WRITE_TEXT, first, last);
  if (lws_write(peer.wsi, payload, size, lws_write_protocol(flags)) < 0) return -1;
  peer.sent += size;
  m_counters.bytesSent += size;
  ++m_counters.fragmentsSent;
  if (last) {
    peer.outgoing.reset();
    ++m_counters.messagesSent;
    m_handler.onSent(peer.id);
  }
  askToWrite(peer);
  return 0;
}

void LwsTransport::askToWrite(LwsPeer& peer) {
  if (peer.waitingSince == 0.0) peer.waitingSince = nowSeconds();
  lws_callback_on_writable(peer.wsi);
}

void LwsTransport::wantWrite(ConnectionId id) {
  if (LwsPeer* peer = find(id)) askToWrite(*peer);
}

void LwsTransport::close(ConnectionId id, CloseCode code, std::string_view reason) {
  LwsPeer* peer = find(id);
  if (!peer || peer->closing) return;
  peer->closing = true;
  peer->closeCode = code;
  peer->closeReason = reason;
  askToWrite(*peer);
}

void LwsTransport::kill(ConnectionId id) {
  LwsPeer* peer = find(id);
  if (!peer || peer->killed) return;
  peer->killed = true;
  lws_set_timeout(peer->wsi, PENDING_TIMEOUT_USER_OK, LWS_TO_KILL_ASYNC);
}

void LwsTransport::watchPeer(LwsPeer& peer, double now) {
  if (peer.readingPaused && !peer.messages.empty(now) && !peer.bytes.empty(now)) {
    peer.readingPaused = false;
    lws_rx_flow_control(
        peer.wsi, LWS_RXFLOW_REASON_APPLIES_ENABLE | LWS_RXFLOW_REASON_USER_BOOL | LWS_RXFLOW_REASON_FLAG_PROCESS_NOW);
  }
  if (peer.waitingSince > 0.0 && now - peer.waitingSince > m_config.stalledSeconds && !peer.killed) {
    ++m_counters.stalledKills;
    kill(peer.id);
  }
}

}  // namespace limn::server
