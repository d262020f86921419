#include <algorithm>

#include "renderer/base/clock.hpp"
#include "renderer/base/log.hpp"
#include "server/convert.hpp"
#include "server/service.hpp"

namespace limn::server {
namespace {

Error error(std::string_view code, std::string message, std::string place = "") {
  return {std::string(code), std::move(message), std::move(place)};
}

std::vector<protocol::Encoding> frameEncodings(const ClientSession& session) {
  std::vector<protocol::Encoding> encodings;
  if (session.takesJpeg) encodings.push_back(protocol::Encoding::jpeg);
  if (session.takesPng) encodings.push_back(protocol::Encoding::png);
  return encodings;
}

std::vector<std::string> stageNames(const std::vector<StageTime>& stages) {
  constexpr size_t kAnnounced = std::tuple_size_v<decltype(protocol::FrameHeader::stageMs)>;
  std::vector<std::string> names;
  for (size_t i = 0; i < std::min(stages.size(), kAnnounced); ++i) names.push_back(stages[i].name);
  return names;
}

std::string placeIn(uint32_t seq, const std::string& pointer) { return "seq " + std::to_string(seq) + " " + pointer; }

/// What a log may hold of a text that a stranger chose.
std::string printable(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 64)) out.push_back(c >= ' ' && c <= '~' ? c : '?');
  return out;
}

}  // namespace

/// One overload a message; `hello` has come before.
struct MessageHandler {
  Service& service;
  ClientSession& session;

  void operator()(const protocol::ClientHello& hello) const {
    service.sendError(session, hello.seq, error(protocol::kErrorHelloFirst, "hello was said already"));
  }
  void operator()(const protocol::Ping& ping) const { service.send(session, protocol::Pong{ping.seq, nowSeconds()}); }
  void operator()(const protocol::Load& load) const {
    const bool taken = service.askLoader(session, SceneJob{{session.id(), load.seq}, load.uri, nowSeconds()});
    service.m_counters.loads += taken;
    if (taken) service.rememberUnacknowledged({session.id(), load.seq}, load);
  }
  void operator()(const protocol::SetCamera& camera) const {
    service.edit(session, camera.seq, {protocol::CameraEdit{camera.view}}, "/edits/0/view");
  }
  void operator()(const protocol::SetMessage& set) const { service.edit(session, set.seq, {set.edit}, "/edits/0"); }
  void operator()(const protocol::Batch& batch) const { service.edit(session, batch.seq, batch.edits, ""); }
  void operator()(const protocol::Pick& pick) const {
    service.ask(session, pick.seq, PickRequest{{session.id(), pick.seq}, pick.x, pick.y});
  }
  void operator()(const protocol::AckFrame& ack) const {
    ++service.m_counters.acknowledgements;
    if (session.flow.acknowledged(ack.frameId, nowSeconds()) == FlowControl::Ack::neverSent)
      return service.sendError(session, ack.seq, error(protocol::kErrorBadAck, "no such frame was sent"));
    service.distributeFrames();
  }
  void operator()(const protocol::Save& save) const {
    const std::vector<std::string> layers = save.layers.value_or(std::vector<std::string>());
    for (const std::string& layer : layers)
      if (std::find(service.m_config.layers.begin(), service.m_config.layers.end(), layer) ==
          service.m_config.layers.end())
        return service.sendError(session, save.seq,
                                 error(protocol::kErrorUnknownName, "no such layer: " + printable(layer),
                                       placeIn(save.seq, "/layers")));
    if (session.savingSeq != 0)
      return service.sendError(session, save.seq, error(protocol::kErrorBusy, "a file is being made already"));
    if (service.ask(session, save.seq, SaveRequest{{session.id(), save.seq}, layers})) session.savingSeq = save.seq;
  }
  void operator()(const protocol::Describe& describe) const {
    service.ask(session, describe.seq, DescribeRequest{{session.id(), describe.seq}});
  }
  void operator()(const protocol::Wait& wait) const {
    if (wait.error) {
      if (session.unanswered >= ClientSession::kMaxUnanswered)
        return service.sendError(session, wait.seq, error(protocol::kErrorBusy, "too many requests wait"));
      session.errorWaits.push_back({wait.seq, wait.steps.value_or(1), *wait.error, false});
      ++session.unanswered;
      service.tellWatched();
      if (const auto frame = service.m_frames.newest()) service.checkErrorWaits(session, frame->info);
      return;
    }
    service.ask(session, wait.seq, WaitRequest{{session.id(), wait.seq}, wait.steps.value_or(0)});
  }
  void operator()(const protocol::ClientBye&) const { service.closeSession(session, CloseCode::normal, "good-bye"); }
};

void Service::onMessage(ConnectionId id, std::string_view text) {
  ClientSession* session = find(id);
  if (!session || session->closing) return;
  uint32_t seq = 0;
  const Result<protocol::ClientMessage> message = protocol::decodeClient(text, &seq);
  if (seq != 0 && seq <= session->lastSeq)
    return sendError(*session, seq,
                     error(protocol::kErrorBadSeq, "seq must rise; the last was " + std::to_string(session->lastSeq)));
  session->lastSeq = std::max(session->lastSeq, seq);
  if (!message) return sendError(*session, seq, message.error());
  if (session->greeted) return std::visit(MessageHandler{*this, *session}, *message);
  if (const auto* hello = std::get_if<protocol::ClientHello>(&*message)) return greet(*session, *hello);
  sendError(*session, seq, error(protocol::kErrorHelloFirst, "hello must be the first message"));
}

void Service::greet(ClientSession& session, const protocol::ClientHello& hello) {
  if (hello.version != protocol::kVersion) {
    sendError(session, hello.seq, error(protocol::kErrorVersion, "this server speaks version 1"));
    return closeSession(session, CloseCode::policy, "another version");
  }
  const auto takes = [&](protocol::Encoding e) {
    return !hello.encodings || std::find(hello.encodings->begin(), hello.encodings->end(), e) != hello.encodings->end();
  };
  session.takesJpeg = takes(protocol::Encoding::jpeg);
  session.takesPng = takes(protocol::Encoding::png);
  session.watching = hello.watch.value_or(true) && (session.takesJpeg || session.takesPng);
  session.greeted = true;
  session.helloSeq = hello.seq;
  const Status status = m_replies.status();
  const auto frame = m_frames.newest();
  session.stages = stageNames(frame && !frame->info.stages.empty() ? frame->info.stages : status.stages);
  if (session.stages.empty()) session.stages = m_config.stages;

  const TransportConfig& transport = m_config.transport;
  protocol::ServerHello answer;
  answer.seq = hello.seq;
  answer.version = protocol::kVersion;
  answer.server = m_config.serverName;
  answer.device = status.device;
  answer.clientId = session.id();
  answer.limits = {
      uint32_t(transport.maxMessageBytes),  protocol::kMaxFragmentBytes, uint32_t(FlowControl::kFramesInFlight),
      protocol::kMaxEditsPerBatch,          m_config.maxImageSide,       transport.maxClients,
      uint32_t(transport.messagesPerSecond)};
  answer.techniques = toWire(m_config.techniques);
  answer.toneMaps.assign(protocol::kToneMaps.begin(), protocol::kToneMaps.end());
  answer.encodings = frameEncodings(session);
  answer.layers = m_config.layers;
  answer.stages = session.stages;
  answer.editable = protocol::editableTargets();
  send(session, answer);
  askForScene(session);
  tellWatched();
  distributeFrames();
  logInfo("client " + std::to_string(session.id()) + ": " + printable(hello.client));
}

// The client did not ask, so a full box is no error of its: the next tick tries again.
void Service::askForScene(ClientSession& session) {
  if (!session.greeted || session.sceneAsked || session.closing) return;
  session.sceneAsked = m_mailbox.push(DescribeRequest{{session.id(), session.helloSeq}});
  if (!session.sceneAsked) return;
  ++m_counters.requests;
  ++session.unanswered;
}

void Service::addEdit(EditJob& job, const protocol::Edit& wire, View& view) {
  const auto* sky = std::get_if<protocol::EnvironmentEdit>(&wire);
  if (sky && sky->image && !sky->image->empty()) job.images.push_back({job.request.edits.size(), *sky->image});
  job.request.edits.push_back(editFromWire(wire, view));
}

void Service::edit(ClientSession& session, uint32_t seq, const std::vector<protocol::Edit>& edits, std::string_view unsaid) {
  EditJob job{{{session.id(), seq}, {}, nowSeconds()}, {}};
  View view = m_view;
  bool moves = false;
  protocol::Batch whole{seq, {}};          // with every field that the renderer completes
  for (const protocol::Edit& wire : edits) {
    const auto* size = std::get_if<protocol::ImageEdit>(&wire);
    if (size && std::max(size->width, size->height) > m_config.maxImageSide)
      return sendError(session, seq,
                       error(protocol::kErrorOutOfRange,
                             "pictures have at most " + std::to_string(m_config.maxImageSide) + " pixels a side",
                             placeIn(seq, (unsaid.empty() ? "/edits/" + std::to_string(whole.edits.size()) : std::string()) +
                                              (size->width > m_config.maxImageSide ? "/width" : "/height"))));
    addEdit(job, wire, view);
    const bool isView = std::holds_alternative<protocol::CameraEdit>(wire);
    whole.edits.push_back(isView ? protocol::Edit(protocol::CameraEdit{toWire(view)}) : wire);
    moves |= isView;
  }
  const bool taken = job.images.empty() ? ask(session, seq, std::move(job.request)) : askLoader(session, std::move(job));
  if (!taken) return;
  rememberUnacknowledged({session.id(), seq}, std::move(whole));
  if (moves) noteMoved({session.id(), seq}, view);
  m_unsaid.emplace(std::pair(session.id(), seq), unsaid);
  session.lastEditSeq = seq;
  ++m_counters.edits;
}

void Service::noteMoved(const Origin& by, const View& view) {
  m_view = view;
  m_viewEdits.emplace(by.client, by.seq);
}

bool Service::askLoader(ClientSession& session, LoaderJob job) {
  const uint32_t seq = originOf(job).seq;
  if (session.readingSeq != 0) {
    sendError(session, seq, error(protocol::kErrorBusy, "a file is being read for this client already"));
    return false;
  }
  if (!m_loader->request(std::move(job))) {
    sendError(session, seq, error(protocol::kErrorBusy, "too many files wait to be read"));
    return false;
  }
  session.readingSeq = seq;
  ++session.unanswered;
  return true;
}

bool Service::ask(ClientSession& session, uint32_t seq, Request request) {
  ++m_counters.requests;
  const bool taken = session.unanswered < ClientSession::kMaxUnanswered && m_mailbox.push(std::move(request));
  if (taken) ++session.unanswered;
  else sendError(session, seq, error(protocol::kErrorBusy, "too many requests wait"));
  return taken;
}

}  // namespace limn::server
