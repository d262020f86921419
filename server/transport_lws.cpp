#include "server/transport_lws.hpp"

#include <unistd.h>

#include <algorithm>

#include "protocol/messages.gen.hpp"
#include "renderer/base/clock.hpp"

namespace limn::server {
namespace {

const lws_retry_bo_t kPingPolicy{
    .retry_ms_table = nullptr, .retry_ms_table_count = 0, .conceal_count = 0,
    .secs_since_valid_ping = 20, .secs_since_valid_hangup = 60, .jitter_percent = 0};

/// Tells how long a callback held the loop.
class CallbackTimer {
 public:
  explicit CallbackTimer(TransportCounters& counters) : m_counters(counters) {}
  ~CallbackTimer() { m_counters.maxCallbackMs = std::max(m_counters.maxCallbackMs, (nowSeconds() - m_begin) * 1e3); }
  CallbackTimer(const CallbackTimer&) = delete;
  CallbackTimer& operator=(const CallbackTimer&) = delete;

 private:
  TransportCounters& m_counters;
  double m_begin = nowSeconds();
};

std::string numericAddress(const std::string& address) {
  if (address == "localhost") return "127.0.0.1";
  if (address.starts_with('[') && address.ends_with(']')) return address.substr(1, address.size() - 2);
  return address;
}

}  // namespace

Result<std::unique_ptr<Transport>> Transport::open(const TransportConfig& config, TransportHandler& handler) {
  auto transport = std::make_unique<LwsTransport>(config, handler);
  if (const Result<void> listening = transport->listen(); !listening) return listening.error();
  return std::unique_ptr<Transport>(std::move(transport));
}

LwsTransport::LwsTransport(const TransportConfig& config, TransportHandler& handler)
    : m_config(config), m_handler(handler) {
  m_timer.owner = this;
}

LwsTransport::~LwsTransport() {
  if (m_context) {
    lws_sul_cancel(&m_timer.sul);
    lws_context_destroy(m_context);
  }
}

Result<void> LwsTransport::listen() {
  const std::string address = numericAddress(m_config.address);
  const std::string place = m_config.address + ":" + std::to_string(m_config.port);
  if (!isIpLiteral(address))
    return Error{"listen", "the address to listen on must be an IP address or localhost", place};
  installLwsLog();

  // protocols[0] answers HTTP and is what lws takes for sockets without a subprotocol: confirmUpgrade has refused
  // those.
  m_protocols[0] = {"http", &LwsTransport::httpCallback, sizeof(LwsHttp*), kFragmentBytes, 0, nullptr,
                    kFragmentBytes + LWS_PRE};
  m_protocols[1] = {
      protocol::kSubprotocol.data(), &LwsTransport::socketCallback, sizeof(LwsPeer*), kFragmentBytes, 0, nullptr,
      kFragmentBytes + LWS_PRE};

  lws_context_creation_info info{};
  info.options =
      LWS_SERVER_OPTION_EXPLICIT_VHOSTS | LWS_SERVER_OPTION_VALIDATE_UTF8 | LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
  if (address.find(':') == std::string::npos) info.options |= LWS_SERVER_OPTION_DISABLE_IPV6;
  info.port = m_config.port;
  info.iface = address == "0.0.0.0" || address == "::" ? nullptr : address.c_str();
  info.protocols = m_protocols.data();
  info.user = this;
  info.uid = info.gid = gid_t(-1);
  info.pt_serv_buf_size = kFragmentBytes + LWS_PRE;
  info.fd_limit_per_thread = m_config.maxConnections + 56;
  info.timeout_secs_ah_idle = 5;
  info.timeout_secs = 5;
  info.keepalive_timeout = 5;
  info.max_http_header_pool = 32;
  info.max_http_header_data = 8192;
  info.ka_time = 30;
  info.ka_interval = 5;
  info.ka_probes = 3;
  info.retry_and_idle_policy = &kPingPolicy;
  info.extensions = nullptr;
  info.server_string = "limnd";
  info.vhost_name = "limnd";

  m_context = lws_create_context(&info);
  if (!m_context) return Error{"listen", "no event loop: " + lastLwsError(), place};
  m_vhost = lws_create_vhost(m_context, &info);
  if (!m_vhost) return Error{"listen", "the address is taken or not ours: " + lastLwsError(), place};
  const int port = lws_get_vhost_listen_port(m_vhost);
  if (port <= 0) return Error{"listen", "the address cannot be listened on: " + lastLwsError(), place};
  m_port = uint16_t(port);
  return {};
}

void LwsTransport::run() {
  scheduleTick();
  while (!m_finished)
    if (lws_service(m_context, 0) < 0) break;
}

void LwsTransport::wake() { lws_cancel_service(m_context); }

void LwsTransport::drain() {
  m_drainAsked = true;
  wake();
}

int LwsTransport::httpCallback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length) {
  LwsTransport& self = of(wsi);
  const CallbackTimer timer(self.m_counters);
  return self.onHttpEvent(wsi, reason, user, in, length);
}

int LwsTransport::socketCallback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length) {
  LwsTransport& self = of(wsi);
  const CallbackTimer timer(self.m_counters);
  return self.onSocketEvent(wsi, reason, user, in, length);
}

int LwsTransport::onHttpEvent(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length) {
  auto** slot = static_cast<LwsHttp**>(user);
  switch (reason) {
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
      onWakeUp();
      return 0;  // anything else would close the event pipe, and no wake-up would ever arrive again
    case LWS_CALLBACK_FILTER_NETWORK_CONNECTION: return filterNetwork(wsi, in);
    case LWS_CALLBACK_SERVER_NEW_CLIENT_INSTANTIATED: rememberConnection(wsi); return 0;
    case LWS_CALLBACK_WSI_DESTROY: forgetConnection(wsi); return 0;
    case LWS_CALLBACK_FILTER_HTTP_CONNECTION: return filterHttp(wsi);
    case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE: return confirmUpgrade(wsi);
    case LWS_CALLBACK_HTTP: return answerHttp(wsi, slot, std::string_view(static_cast<const char*>(in), length));
    case LWS_CALLBACK_HTTP_WRITEABLE: return writeHttp(wsi, slot);
    case LWS_CALLBACK_HTTP_BODY:
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
    case LWS_CALLBACK_ESTABLISHED: return -1;  // no bodies, and no socket without our subprotocol
    case LWS_CALLBACK_HTTP_DROP_PROTOCOL:
    case LWS_CALLBACK_CLOSED_HTTP:
      if (slot) {
        delete *slot;
        *slot = nullptr;
      }
      return 0;
    default: return 0;
  }
}

int LwsTransport::onSocketEvent(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length) {
  auto** slot = static_cast<LwsPeer**>(user);
  switch (reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION: return confirmUpgrade(wsi);
    case LWS_CALLBACK_ESTABLISHED: return openPeer(wsi, slot);
    case LWS_CALLBACK_RECEIVE: return slot && *slot ? receive(**slot, in, length) : -1;
    case LWS_CALLBACK_SERVER_WRITEABLE: return slot && *slot ? writePeer(**slot) : -1;
    case LWS_CALLBACK_CLOSED: closePeer(slot); return 0;
    default: return 0;
  }
}

void LwsTransport::onWakeUp() {
  if (m_drainAsked && !m_drainBegun) beginDrain(nowSeconds());
  m_handler.onWake();
}

void LwsTransport::onTimer(lws_sorted_usec_list_t* timer) {
  static_assert(offsetof(Timer, sul) == 0);
  LwsTransport& self = *reinterpret_cast<Timer*>(timer)->owner;
  self.tick();
  if (!self.m_finished) self.scheduleTick();
}

void LwsTransport::scheduleTick() {
  lws_sul_schedule(m_context, 0, &m_timer.sul, &LwsTransport::onTimer, lws_usec_t(kTickSeconds * LWS_US_PER_SEC));
}

void LwsTransport::tick() {
  const double now = nowSeconds();
  m_counters.logLinesSuppressed += takeSuppressedLwsLines();
  for (auto& [id, peer] : m_peers) watchPeer(*peer, now);
  m_handler.onTick();
  if (m_drainBegun && (m_peers.empty() || now > m_drainEnd)) {
    m_finished = true;
    lws_cancel_service(m_context);
  }
}

void LwsTransport::beginDrain(double now) {
  m_drainBegun = true;
  m_drainEnd = now + m_config.drainSeconds;
  m_handler.onDrain();
}

}  // namespace limn::server
