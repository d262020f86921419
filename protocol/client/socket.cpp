#include "protocol/client/socket.hpp"

#include <algorithm>

#include "renderer/base/clock.hpp"

namespace limn::protocol {
namespace {

constexpr size_t kMaxFrameBytes = size_t(1) << 30;
constexpr uint16_t kCloseNoCode = 1005, kCloseAbnormal = 1006;  // never on the wire; RFC 6455, 7.4.1

}  // namespace

Client::Socket::Socket(const ClientOptions& options, ServerUrl url) : m_options(options), m_url(std::move(url)) {
  m_closing.code = kCloseAbnormal;
  m_scratch.resize(LWS_PRE + kMaxFragmentBytes);
}

Client::Socket::~Socket() {
  {
    const std::lock_guard lock(m_mutex);
    m_stop = true;
  }
  if (m_thread.joinable()) {
    lws_cancel_service(m_context);
    m_thread.join();
  }
  if (m_context) lws_context_destroy(m_context);
}

Result<void> Client::Socket::open() {
  lws_set_log_level(LLL_ERR, nullptr);  // what goes wrong is told as Errors and events
  m_protocols[0] = {m_options.subprotocol.c_str(), &Socket::callback, 0, kMaxFragmentBytes, 0, this, LWS_PRE + kMaxFragmentBytes};
  m_protocols[1] = {nullptr, nullptr, 0, 0, 0, nullptr, 0};

  lws_context_creation_info info{};
  info.port = CONTEXT_PORT_NO_LISTEN;
  info.protocols = m_protocols.data();
  info.user = this;
  info.fd_limit_per_thread = 16;
  info.pt_serv_buf_size = kMaxFragmentBytes;
  info.options = LWS_SERVER_OPTION_JUST_USE_RAW_ORIGIN | (m_url.tls ? LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT : 0);
  m_context = lws_create_context(&info);
  if (!m_context) return Error{"internal", "cannot create a socket context", ""};

  m_thread = std::thread([this] { serve(); });
  std::unique_lock lock(m_mutex);
  const auto decided = [this] { return m_state != State::connecting; };
  if (!m_changed.wait_for(lock, std::chrono::duration<double>(m_options.connectSeconds), decided))
    return Error{"io", "no answer", m_options.url};
  if (!m_upgraded) return Error{"io", m_refusal, m_options.url};
  return {};
}

void Client::Socket::serve() {
  const std::string authority = m_url.authority();
  lws_client_connect_info connect{};
  connect.context = m_context;
  connect.address = m_url.host.c_str();
  connect.port = m_url.port;
  connect.path = m_url.path.c_str();
  connect.host = authority.c_str();
  connect.origin = m_options.origin.empty() ? nullptr : m_options.origin.c_str();
  connect.protocol = m_options.subprotocol.c_str();
  connect.local_protocol_name = m_protocols[0].name;
  connect.ssl_connection = m_url.tls ? LCCSCF_USE_SSL : 0;
  connect.pwsi = &m_wsi;
  if (!lws_client_connect_via_info(&connect)) finish({kCloseAbnormal, "cannot connect"});

  const auto running = [this] {
    const std::lock_guard lock(m_mutex);
    return !m_stop && m_state != State::closed;
  };
  while (running() && lws_service(m_context, 0) >= 0) {
  }
}

int Client::Socket::callback(lws* wsi, lws_callback_reasons reason, void*, void* in, size_t length) {
  auto* self = static_cast<Socket*>(lws_context_user(lws_get_context(wsi)));
  return self ? self->onEvent(wsi, reason, in, length) : 0;
}

int Client::Socket::onEvent(lws* wsi, lws_callback_reasons reason, void* in, size_t length) {
  const std::string_view text = in ? std::string_view(static_cast<const char*>(in), length) : std::string_view();
  switch (reason) {
    case LWS_CALLBACK_CLIENT_APPEND_HANDSHAKE_HEADER: return appendHeaders(wsi, in, length);
    case LWS_CALLBACK_CLIENT_ESTABLISHED: {
      const std::lock_guard lock(m_mutex);
      m_state = State::open;
      m_upgraded = true;
      m_changed.notify_all();
      return 0;
    }
    case LWS_CALLBACK_CLIENT_CONNECTION_ERROR: {
      const unsigned status = lws_http_client_http_response(wsi);
      finish({kCloseAbnormal, status ? "refused with HTTP status " + std::to_string(status) : std::string(text)});
      return 0;
    }
    case LWS_CALLBACK_CLIENT_RECEIVE: return receive(wsi, static_cast<const uint8_t*>(in), length);
    case LWS_CALLBACK_CLIENT_WRITEABLE: return write(wsi);
    case LWS_CALLBACK_WS_PEER_INITIATED_CLOSE:
      m_closing.code = length >= 2 ? uint16_t(uint8_t(text[0]) << 8 | uint8_t(text[1])) : kCloseNoCode;
      if (length > 2) m_closing.reason = text.substr(2);
      return 0;
    case LWS_CALLBACK_CLIENT_CLOSED: finish(m_closing); return 0;
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED: onWake(m_wsi); return 0;
    default: return 0;
  }
}

int Client::Socket::appendHeaders(lws* wsi, void* in, size_t length) {
  if (m_options.token.empty()) return 0;
  auto** cursor = static_cast<unsigned char**>(in);
  const std::string value = "Bearer " + m_options.token;
  return lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>("authorization:"),
                                     reinterpret_cast<const unsigned char*>(value.data()), int(value.size()), cursor,
                                     *cursor + length);
}

/// Service thread. What other threads asked for is done here, because only this thread may touch the connection.
void Client::Socket::onWake(lws* wsi) {
  const std::lock_guard lock(m_mutex);
  if (m_state != State::open || !wsi) return;
  if (m_reading != m_reads) lws_rx_flow_control(wsi, m_reading ? 1 : 0);
  m_reads = m_reading;
  if (!m_outgoing.empty() || m_closeCode) lws_callback_on_writable(wsi);
}

int Client::Socket::receive(lws* wsi, const uint8_t* bytes, size_t length) {
  m_incoming.insert(m_incoming.end(), bytes, bytes + length);
  const bool binary = lws_frame_is_binary(wsi) != 0;
  if (m_incoming.size() > (binary ? kMaxFrameBytes : size_t(kMaxServerTextBytes))) {
    deliver(Broken{{"limit", "a message of the server is too long", ""}});
    return -1;
  }
  if (!lws_is_final_fragment(wsi) || lws_remaining_packet_payload(wsi) > 0) return 0;
  std::vector<uint8_t> whole;
  whole.swap(m_incoming);
  if (binary) deliverFrame(std::move(whole));
  else deliverText({reinterpret_cast<const char*>(whole.data()), whole.size()});
  return 0;
}

/// Service thread. One fragment a call, copied because lws writes its header in front of the payload and masks it in place.
int Client::Socket::write(lws* wsi) {
  if (!m_current) {
    const std::lock_guard lock(m_mutex);
    if (m_outgoing.empty()) {
      if (!m_closeCode) return 0;
      lws_close_reason(wsi, lws_close_status(*m_closeCode), nullptr, 0);
      m_closing = {*m_closeCode, "closed by the client"};
      return -1;
    }
    m_current = std::move(m_outgoing.front());
    m_outgoing.pop_front();
    m_sent = 0;
  }
  const std::vector<uint8_t>& bytes = m_current->bytes;
  const size_t count = std::min<size_t>(bytes.size() - m_sent, kMaxFragmentBytes);
  std::copy_n(bytes.begin() + ptrdiff_t(m_sent), count, m_scratch.begin() + LWS_PRE);
  const bool first = m_sent == 0, last = m_sent + count == bytes.size();
  const int kind = m_current->binary ? LWS_WRITE_BINARY : LWS_WRITE_TEXT;
  const auto flags = lws_write_protocol(lws_write_ws_flags(kind, first, last));
  if (lws_write(wsi, m_scratch.data() + LWS_PRE, count, flags) < 0) return -1;
  m_sent += count;
  if (last) m_current.reset();
  lws_callback_on_writable(wsi);
  return 0;
}

void Client::Socket::finish(Closed closed) {
  m_wsi = nullptr;
  const std::lock_guard lock(m_mutex);
  if (m_state == State::closed) return;
  m_state = State::closed;
  m_refusal = closed.reason.empty() ? "the connection ended" : closed.reason;
  m_events.push_back(std::move(closed));
  m_changed.notify_all();
}

void Client::Socket::deliverText(std::string_view json) {
  if (m_options.recorder) {
    const Result<void> checked = m_options.recorder->text(Direction::toClient, json);
    if (!checked) return deliver(Broken{checked.error()});
  }
  Result<ServerMessage> message = decodeServer(json);
  if (message) return deliver(ReceivedMessage{message.take(), std::string(json), nowSeconds()});
  if (message.error().code != kErrorUnknownOp) deliver(Broken{message.error()});
}

void Client::Socket::deliverFrame(std::vector<uint8_t> message) {
  const Result<FrameView> view = decodeFrame(message);
  if (!view) return deliver(Broken{view.error()});
  if (m_options.recorder) (void)m_options.recorder->frame(message);
  if (m_options.acks == FrameAcks::onArrival && view->header.kind == FrameKind::image)
    send(AckFrame{0, view->header.frameId, {}, {}, false});
  deliver(ReceivedFrame{std::move(message), view->header, nowSeconds()});
}

void Client::Socket::deliver(Event event) {
  const std::lock_guard lock(m_mutex);
  const auto isImage = [](const Event& e) {
    const auto* frame = std::get_if<ReceivedFrame>(&e);
    return frame && frame->header.kind == FrameKind::image;
  };
  if (m_options.newestFrameOnly && isImage(event)) std::erase_if(m_events, isImage);
  m_events.push_back(std::move(event));
  m_changed.notify_all();
}

uint32_t Client::Socket::send(ClientMessage message) {
  uint32_t seq = seqOf(message);
  {
    const std::lock_guard lock(m_mutex);
    if (seq == 0) seq = m_lastSeq + 1;
    m_lastSeq = std::max(m_lastSeq, seq);
    std::visit([seq](auto& m) { m.seq = seq; }, message);
    const std::string json = encode(message);
    if (m_options.recorder) (void)m_options.recorder->text(Direction::toServer, json);  // a test may mean to send what is wrong
    m_outgoing.push_back({false, {json.begin(), json.end()}});
  }
  lws_cancel_service(m_context);
  return seq;
}

void Client::Socket::push(Outgoing message) {
  {
    const std::lock_guard lock(m_mutex);
    m_outgoing.push_back(std::move(message));
  }
  lws_cancel_service(m_context);
}

void Client::Socket::setReading(bool reading) {
  {
    const std::lock_guard lock(m_mutex);
    m_reading = reading;
  }
  lws_cancel_service(m_context);
}

void Client::Socket::close(uint16_t code) {
  {
    const std::lock_guard lock(m_mutex);
    m_closeCode = code;
  }
  lws_cancel_service(m_context);
}

}  // namespace limn::protocol
