#include "server/metrics.hpp"
#include "server/service.hpp"

namespace limn::server {
namespace {

HttpReply plain(int status, std::string text) {
  HttpReply reply;
  reply.status = status;
  reply.text = std::move(text);
  reply.headers.emplace_back("cache-control:", "no-store");
  return reply;
}

/// The value of `name` in "a=1&b=2", without decoding: tokens are made of characters that need none.
std::string queryValue(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const std::string_view part = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), part.size() + 1));
    const size_t equals = part.find('=');
    if (equals != std::string_view::npos && part.substr(0, equals) == name) return std::string(part.substr(equals + 1));
  }
  return "";
}

HttpReply redirect(std::string location) {
  HttpReply reply = plain(303, "");
  reply.headers.emplace_back("location:", std::move(location));
  return reply;
}

}  // namespace

HttpReply Service::onHttp(const HttpRequest& asked) {
  const AccessPolicy& access = m_config.transport.access;
  HttpRequest request = asked;
  std::string& path = request.headers.path;
  // A probe asks at the root; a page knows its own path alone.
  const auto isProbe = [&](const char* name) { return path == name || path == access.basePath + name; };
  if (isProbe("/healthz")) return plain(200, "alive\n");
  if (isProbe("/readyz")) return m_ready && !m_transport->draining() ? plain(200, "ready\n") : plain(503, "not ready\n");
  if (const Verdict host = judgeHost(access, request.headers); !host.allowed())
    return plain(host.status, host.reason + "\n");
  if (path == "/metrics") {
    if (!tokenMatches(access, request.headers)) return plain(401, "a valid token is needed\n");
    HttpReply reply = plain(200, metrics());
    reply.mime = MetricsText::kMime;
    return reply;
  }
  if (path == access.basePath && !path.empty()) return redirect(access.basePath + "/");
  if (!path.starts_with(access.basePath + "/")) return plain(404, "nothing is here\n");
  path.erase(0, access.basePath.size());

  // The link with the token is opened once; a cookie, which browsers send with the socket's handshake, takes its place.
  const std::string token = queryValue(request.query, "token");
  if (path == "/" && !token.empty() && !access.token.empty()) {
    if (!equalInConstantTime(access.token, token)) return plain(401, "the token is wrong\n");
    HttpReply reply = redirect(access.basePath + "/");
    reply.headers.emplace_back("set-cookie:", tokenCookieFor(request.headers.host) + "=" + token +
                                                  "; HttpOnly; SameSite=Strict; Path=" + access.basePath + "/");
    return reply;
  }
  return serveSite(m_config.site, request);
}

std::string Service::metrics() const {
  const TransportCounters& wire = m_transport->counters();
  const Status status = m_replies.status();
  MetricsText out;
  out.gauge("limn_clients", "Open WebSockets.", wire.clients);
  out.gauge("limn_connections", "Open sockets, HTTP included.", wire.connections);
  out.counter("limn_sessions_total", "WebSockets opened.", double(m_counters.sessions));
  out.counter("limn_connections_refused_total", "Sockets closed at once, over a limit.",
              double(wire.connectionsRefused));
  out.counter("limn_upgrades_refused_total", "Upgrades refused by policy.", double(wire.upgradesRefused));
  out.counter("limn_http_requests_total", "HTTP requests answered.", double(wire.httpRequests));
  out.counter("limn_http_refused_total", "HTTP requests answered with an error.", double(wire.httpRefused));
  out.counter("limn_messages_received_total", "Messages of clients.", double(wire.messagesReceived));
  out.counter("limn_bytes_received_total", "Payload bytes of clients.", double(wire.bytesReceived));
  out.counter("limn_messages_sent_total", "Messages to clients.", double(wire.messagesSent));
  out.counter("limn_bytes_sent_total", "Payload bytes to clients.", double(wire.bytesSent));
  out.counter("limn_messages_oversized_total", "Messages over the limit.", double(wire.oversizedMessages));
  out.counter("limn_read_pauses_total", "Times a client was slowed down.", double(wire.readPauses));
  out.counter("limn_stalled_total", "Clients cut off because they took nothing.", double(wire.stalledKills));
  out.counter("limn_slow_readers_total", "Clients cut off because too much waited for them.",
              double(m_counters.slowReaders));
  out.counter("limn_hello_timeouts_total", "Clients closed without a hello.", double(m_counters.helloTimeouts));
  out.counter("limn_ack_timeouts_total", "Clients closed without acknowledgements.", double(m_counters.ackTimeouts));
  out.counter("limn_frames_encoded_total", "Pictures encoded.", double(m_counters.framesEncoded));
  out.counter("limn_frames_sent_total", "Pictures sent.", double(m_counters.framesSent));
  out.counter("limn_frame_bytes_total", "Bytes of pictures sent.", double(m_counters.frameBytes));
  out.counter("limn_frames_replaced_total", "Pictures replaced by newer ones before they were sent.",
              double(framesReplaced()));
  out.counter("limn_frames_acknowledged_total", "Acknowledgements of pictures.", double(m_counters.acknowledgements));
  out.counter("limn_edits_total", "Edits accepted from clients.", double(m_counters.edits));
  out.counter("limn_requests_total", "Requests to the renderer.", double(m_counters.requests));
  out.counter("limn_errors_total", "Error messages to clients.", double(m_counters.errors));
  out.counter("limn_loads_total", "Scenes asked for.", double(m_counters.loads));
  out.counter("limn_log_lines_suppressed_total", "Lines of libwebsockets left out of the log.",
              double(wire.logLinesSuppressed));
  out.gauge("limn_callback_max_ms", "Longest callback of the event loop [ms].", wire.maxCallbackMs);
  out.gauge("limn_ready", "1 when clients are taken.", m_ready && !m_transport->draining() ? 1 : 0);
  out.gauge("limn_render_idle", "1 while the loop sleeps.", status.idle ? 1 : 0);
  out.gauge("limn_render_steps", "Passes since the restart.", status.steps);
  out.gauge("limn_render_mean_samples", "Samples a pixel.", status.meanSamples);
  out.gauge("limn_render_estimated_error", "Estimated relMSE.", status.estimatedError);
  out.gauge("limn_render_rays_per_second", "Rays a second.", status.raysPerSecond);
  out.counter("limn_render_edits_applied_total", "Edits applied.", double(status.editsApplied));
  out.counter("limn_render_restarts_total", "Restarts of the sampling.", double(status.restarts));
  out.counter("limn_render_frames_total", "Pictures published.", double(status.framesPublished));
  out.counter("limn_render_quanta_total", "Quanta of work.", double(status.quanta));
  out.counter("limn_render_pipelines_total", "Pipelines created.", status.pipelinesCreated);
  out.gauge("limn_render_discarded_samples", "Samples that were not finite.", double(status.discardedSamples));
  out.beginGauges("limn_device_memory_bytes", "Device memory by owner.");
  for (const auto& [owner, bytes] : status.memory)
    out.sample("limn_device_memory_bytes", "owner", owner, double(bytes));
  out.beginGauges("limn_stage_ms", "Time by stage [ms]; build and warmUp of the scene, the others since the restart.");
  for (const StageTime& stage : status.stages) out.sample("limn_stage_ms", "stage", stage.name, stage.ms);
  out.beginGauges("limn_technique_figure", "About the parts of the technique in use, by name.");
  for (const auto& [name, value] : status.figures) out.sample("limn_technique_figure", "name", name, value);
  return out.text();
}

uint64_t Service::framesReplaced() const {
  uint64_t sum = m_counters.framesReplaced;
  for (const auto& [id, session] : m_sessions) sum += session.framesReplaced;
  return sum;
}

}  // namespace limn::server
