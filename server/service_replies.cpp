#include <algorithm>

#include "renderer/base/clock.hpp"
#include "server/convert.hpp"
#include "server/service.hpp"

namespace limn::server {
namespace {

constexpr double kBroadcastSeconds = 0.25;   ///< between two scenes sent because somebody else edits
constexpr ConnectionId kNobody = 0;

/// The renderer's place, "/edits/N/field" of a request, as the place in the message that asked, which has not what is `unsaid`.
std::string placeInMessage(std::string place, uint32_t seq, std::string_view unsaid) {
  if (!place.starts_with("/edits/")) return place;
  if (unsaid.starts_with(place)) place.clear();
  else if (place.starts_with(unsaid)) place.erase(0, unsaid.size());
  return "seq " + std::to_string(seq) + (place.empty() ? "" : " ") + place;
}

}  // namespace

/// One overload a reply. `session` is null when the client has left, or when the daemon itself had asked. An error that
/// answers nobody concerns all: the renderer has ended.
struct ReplyHandler {
  Service& service;
  ClientSession* session;

  void operator()(const EditAck& ack) const {
    service.m_viewEdits.erase({ack.to.client, ack.to.seq});
    service.m_unsaid.erase({ack.to.client, ack.to.seq});
    const bool effective = !ack.superseded && ack.cost != CostClass::none;
    if (effective) {
      service.m_editors.insert(ack.to.client);
      service.noteAccepted(ack);
    } else {
      service.m_unacknowledged.erase({ack.to.client, ack.to.seq});
    }
    if (!session) return service.noteTakenUp(ack.to);
    doneReading(ack.to.seq);
    if (effective) session->lastEffectiveSeq = std::max(session->lastEffectiveSeq, ack.to.seq);
    else forgetEdit(ack.to.seq);
    service.send(*session, toWire(ack));
  }
  void operator()(const ErrorReply& reply) const {
    if (service.m_viewEdits.erase({reply.to.client, reply.to.seq}) > 0) service.m_viewDoubtful = true;
    const auto edit = service.m_unsaid.extract({reply.to.client, reply.to.seq});
    service.m_unacknowledged.erase({reply.to.client, reply.to.seq});
    if (reply.to.client == kNobody) return service.tellFailure(reply.error);
    if (!session) return service.noteRefused(reply);
    if (session->savingSeq == reply.to.seq) session->savingSeq = 0;
    doneReading(reply.to.seq);
    forgetEdit(reply.to.seq);
    Error error = reply.error;
    error.place = placeInMessage(std::move(error.place), reply.to.seq, edit ? edit.mapped() : std::string_view());
    service.sendError(*session, reply.to.seq, error);
  }
  void operator()(const DescribeReply& reply) const {
    service.learnView(*reply.scene);
    if (reply.to.client == kNobody) return onOwnDescription(*reply.scene);
    if (!session) return;
    if (reply.to.seq == session->helloSeq) return service.join(*session, *reply.scene);
    protocol::SceneMessage scene = toWire(*reply.scene, protocol::SceneCause::asked);
    scene.seq = reply.to.seq;
    service.send(*session, scene);
  }
  void operator()(const LoadReply& reply) const {
    service.learnView(*reply.scene);
    service.m_loadedRevision = reply.scene->sceneRevision;
    service.noteAccepted(reply);
    if (session) {
      doneReading(reply.to.seq);
      service.send(*session,
                   protocol::Loaded{reply.to.seq, reply.loadSeconds, reply.scene->sceneRevision, {reply.scene->hash}});
    }
    service.broadcastScene(*reply.scene, protocol::SceneCause::loaded, kNobody);
  }
  void operator()(const PickReply& reply) const {
    if (session) service.send(*session, toWire(reply));
  }
  void operator()(const SaveReply& reply) const {
    if (!session) return;
    service.send(*session, protocol::Saved{reply.to.seq, reply.exr->size(), protocol::Encoding::exr});
    if (!session->closing && !session->queueFile(reply.to.seq, reply.exr)) service.dropSlowReader(*session);
    service.m_transport->wantWrite(session->id());
  }
  void operator()(const WaitReply& reply) const {
    if (!session) return;
    const auto errorWait = std::find_if(session->errorWaits.begin(), session->errorWaits.end(),
                                        [&](const ErrorWait& wait) { return wait.seq == reply.to.seq; });
    if (errorWait != session->errorWaits.end()) {
      if (waitsOn(*errorWait, reply)) return;
      session->errorWaits.erase(errorWait);
      service.tellWatched();
    }
    service.send(*session, toWire(reply));
  }

 private:
  /// Whether an edit came between the picture that was good enough and the film's hash.
  bool waitsOn(ErrorWait& wait, const WaitReply& reply) const {
    if (reply.errorHigh <= wait.error || reply.converged) return false;
    wait.asked = false;
    ++session->unanswered;
    return true;
  }
  void doneReading(uint32_t seq) const {
    if (session->readingSeq == seq) session->readingSeq = 0;
  }
  /// No picture will ever show this edit: waits must not wait for it.
  void forgetEdit(uint32_t seq) const {
    if (session->lastEditSeq == seq) session->lastEditSeq = session->lastEffectiveSeq;
  }
  void onOwnDescription(const SceneSummary& scene) const {
    service.m_describing = false;
    const std::set<ConnectionId> editors = std::exchange(service.m_editors, {});
    if (editors.empty()) return;
    service.broadcastScene(scene, protocol::SceneCause::edited, editors.size() == 1 ? *editors.begin() : kNobody);
  }
};

void Service::routeReplies() {
  for (const Reply& reply : m_replies.drain()) {
    const Origin to = std::visit([](const auto& r) { return r.to; }, reply);
    ClientSession* session = find(to.client);
    if (session && session->unanswered > 0) --session->unanswered;
    std::visit(ReplyHandler{*this, session}, reply);
  }
  // An image of the journal may fail before the rest of it was asked for.
  const std::vector<ErrorReply> failures = m_begun ? m_loader->takeFailed() : std::vector<ErrorReply>();
  for (const ErrorReply& failed : failures) {
    ClientSession* session = find(failed.to.client);
    if (session && session->unanswered > 0) --session->unanswered;
    ReplyHandler{*this, session}(failed);
  }
  keepAccepted();
}

// The newest picture follows: pictures are distributed after replies.
void Service::join(ClientSession& session, const SceneSummary& scene) {
  session.joined = true;
  send(session, toWire(scene, protocol::SceneCause::joined));
  sendStatus(session, toWire(m_replies.status()));
}

void Service::tellFailure(const Error& error) {
  m_rendererFailed = true;
  for (auto& [id, session] : m_sessions)
    if (session.greeted) sendError(session, 0, error);
}

void Service::describeForAll() {
  const double now = nowSeconds();
  // An editor knows what it did itself; one that has left may have been the only one.
  const auto others = [&](const auto& entry) { return entry.second.joined && m_editors != std::set<ConnectionId>{entry.first}; };
  const bool needed = m_viewDoubtful || (!m_editors.empty() && std::any_of(m_sessions.begin(), m_sessions.end(), others));
  if (!needed) m_editors.clear();
  if (!needed || m_describing || now - m_lastBroadcast < kBroadcastSeconds) return;
  m_lastBroadcast = now;
  m_describing = m_mailbox.push(DescribeRequest{});
}

void Service::learnView(const SceneSummary& scene) {
  if (!m_viewEdits.empty()) return;   // it does not show them yet
  m_view = scene.view;
  m_viewDoubtful = false;
}

void Service::broadcastScene(const SceneSummary& scene, protocol::SceneCause cause, ConnectionId except) {
  const std::string text = textOf(toWire(scene, cause));
  for (auto& [id, session] : m_sessions) {
    if (!session.joined || session.closing || id == except) continue;
    if (cause == protocol::SceneCause::edited) {
      noteQueued(session, session.queueScene(text));
    } else {
      session.dropScene();
      noteQueued(session, session.queue(text));
    }
  }
}

void Service::sendStatus(ClientSession& session, const protocol::Status& status) {
  constexpr size_t kMaxWaiting = 8;   // a reader who is behind gets the next one
  if (session.queuedMessages() > kMaxWaiting) return;
  protocol::Status mine = status;
  mine.clients = uint32_t(m_sessions.size());
  mine.framesSent = session.framesSent;
  mine.framesReplaced = session.framesReplaced;
  if (session.lastStatus == mine) return;
  session.lastStatus = mine;
  send(session, mine);
}

void Service::checkErrorWaits(ClientSession& session, const FrameInfo& info) {
  const bool ofAnotherScene = session.readingSeq != 0 || info.sceneRevision < m_loadedRevision;
  if (session.errorWaits.empty() || ofAnotherScene) return;
  uint32_t applied = 0;
  for (const Origin& origin : info.applied)
    if (origin.client == session.id()) applied = origin.seq;
  if (applied < session.lastEditSeq) return;
  for (ErrorWait& wait : session.errorWaits) {
    const bool reached = info.errorHigh <= wait.error || info.phase == Phase::converged;
    if (reached && !wait.asked) wait.asked = m_mailbox.push(WaitRequest{{session.id(), wait.seq}, wait.steps});
  }
}

}  // namespace limn::server
