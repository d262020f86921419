#include "server/service.hpp"

#include <algorithm>

#include "renderer/base/clock.hpp"
#include "renderer/base/log.hpp"
#include "server/convert.hpp"

namespace limn::server {
namespace {

constexpr double kStatusSeconds = 0.25;

/// The schema's code for one of the renderer's, which say more than clients need to tell apart.
std::string_view wireCode(std::string_view code) {
  const auto& known = protocol::kErrorCodes;
  if (std::find(known.begin(), known.end(), code) != known.end()) return code;
  if (code == "size") return protocol::kErrorOutOfRange;
  if (code == "out-of-memory") return protocol::kErrorLimit;
  if (code.starts_with("unknown-")) return protocol::kErrorUnknownName;
  return code.starts_with("bad-") ? protocol::kErrorBadFile : protocol::kErrorInternal;
}

}  // namespace

Service::Service(ServiceConfig config, Mailbox& mailbox, FrameSlot& frames, StatusQueue& replies)
    : m_config(std::move(config)),
      m_mailbox(mailbox),
      m_frames(frames),
      m_replies(replies),
      m_aloneSince(nowSeconds()),
      m_settledAt(m_aloneSince) {}

Result<std::unique_ptr<Service>> Service::open(ServiceConfig config, Mailbox& mailbox, FrameSlot& frames,
                                               StatusQueue& replies) {
  std::unique_ptr<Service> service(new Service(std::move(config), mailbox, frames, replies));
  Result<std::unique_ptr<Transport>> transport = Transport::open(service->m_config.transport, *service);
  if (!transport) return transport.error();
  service->m_transport = transport.take();
  const auto wake = [loop = service->m_transport.get()] { loop->wake(); };
  service->m_encoder = std::make_unique<EncodeWorker>(wake);
  service->m_loader =
      std::make_unique<LoaderWorker>(service->m_config.assetRoot, service->m_config.readers, mailbox, wake);
  frames.onPublish(wake);
  replies.onPush(wake);
  return service;
}

Service::~Service() {
  // The workers wake the transport: they end first.
  finishWork();
  m_transport.reset();
}

void Service::finishWork() {
  m_encoder.reset();
  m_loader.reset();
}

void Service::setReady(bool ready) {
  m_ready = ready;
  m_transport->wake();
}

ClientSession* Service::find(ConnectionId id) {
  const auto found = m_sessions.find(id);
  return found == m_sessions.end() ? nullptr : &found->second;
}

void Service::onOpen(ConnectionId id) {
  m_sessions.try_emplace(id, id, nowSeconds());
  ++m_counters.sessions;
}

void Service::onClose(ConnectionId id) {
  if (const ClientSession* session = find(id)) m_counters.framesReplaced += session->framesReplaced;
  m_sessions.erase(id);
  m_mailbox.push(LeaveRequest{id});  // a full box only keeps a few words of somebody who is gone
  if (m_sessions.empty()) m_aloneSince = nowSeconds();
  tellWatched();
}

std::optional<OutgoingMessage> Service::nextMessage(ConnectionId id) {
  ClientSession* session = find(id);
  if (!session) return std::nullopt;
  if (!session->pictureIsNext()) {
    if (auto queued = session->takeQueued()) return queued;
    if (session->closing) m_transport->close(id, *session->closing, session->closeReason);
    return std::nullopt;
  }
  OutgoingMessage frame = session->takeFrame(nowSeconds());
  ++m_counters.framesSent;
  m_counters.frameBytes += frame.size();
  return frame;
}

void Service::onWake() {
  routeReplies();
  distributeFrames();
}

void Service::onTick() {
  const double now = nowSeconds();
  if (!m_ready) m_aloneSince = m_settledAt = now;  // nobody can come yet
  for (auto& [id, session] : m_sessions) {
    checkTimers(session, now);
    askForScene(session);
  }
  if (m_ready && (m_viewDoubtful || !m_editors.empty())) describeForAll();
  if (now - m_lastStatus >= kStatusSeconds) {
    m_lastStatus = now;
    const protocol::Status status = toWire(m_replies.status());
    for (auto& [id, session] : m_sessions)
      if (session.joined) sendStatus(session, status);
  }
  tellWatched();
  confirmJournal(now);
  catchUp(now);
  distributeFrames();
  const bool leave =
      m_config.idleExitSeconds > 0.0 && m_sessions.empty() && now - m_aloneSince > m_config.idleExitSeconds;
  if (leave && !m_transport->draining()) {
    logInfo("nobody came for a while: the daemon ends");
    m_transport->drain();
  }
}

void Service::onDrain() {
  routeReplies();  // a closing session takes no message: what the renderer said before, its own end among it, goes out first
  for (auto& [id, session] : m_sessions) {
    if (m_rendererFailed) closeSession(session, CloseCode::internal, "the renderer has ended");
    else closeSession(session, CloseCode::goingAway, "the daemon stops");
  }
}

void Service::checkTimers(ClientSession& session, double now) {
  if (session.closing) return;
  if (!session.greeted && session.age(now) > m_config.helloSeconds) {
    ++m_counters.helloTimeouts;
    closeSession(session, CloseCode::policy, "no hello came");
  } else if (session.flow.overdue(now, m_config.ackSeconds)) {
    ++m_counters.ackTimeouts;
    closeSession(session, CloseCode::policy, "acknowledgements are missing");
  }
}

void Service::send(ClientSession& session, const protocol::ServerMessage& message) {
  if (!session.closing) noteQueued(session, session.queue(textOf(message)));
}

void Service::noteQueued(ClientSession& session, bool taken) {
  if (taken) m_transport->wantWrite(session.id());
  else dropSlowReader(session);
}

void Service::sendError(ClientSession& session, uint32_t seq, const Error& error) {
  ++m_counters.errors;
  protocol::ErrorMessage message;
  if (seq != 0) message.seq = seq;
  message.code = wireCode(error.code);
  message.message = error.message;
  if (!error.place.empty()) message.place = error.place;
  else if (seq != 0) message.place = "seq " + std::to_string(seq);
  send(session, message);
}

void Service::closeSession(ClientSession& session, CloseCode code, const std::string& reason) {
  if (session.closing) return;
  if (session.greeted) send(session, protocol::ServerBye{reason});
  session.closing = code;
  session.closeReason = reason;
  session.ready = nullptr;
  m_transport->wantWrite(session.id());
}

void Service::dropSlowReader(ClientSession& session) {
  ++m_counters.slowReaders;
  session.closing = CloseCode::policy;
  m_transport->kill(session.id());
}

void Service::tellWatched() {
  bool watched = false;
  for (const auto& [id, session] : m_sessions) watched |= session.greeted && session.needsPictures() && !session.closing;
  if (watched != m_watched && m_mailbox.push(WatchRequest{watched})) m_watched = watched;  // or at the next tick
}

}  // namespace limn::server
