#pragma once
#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "renderer/session/mailbox.hpp"
#include "renderer/techniques/technique_info.hpp"
#include "server/client_session.hpp"
#include "server/encode_worker.hpp"
#include "server/journal.hpp"
#include "server/loader_worker.hpp"
#include "server/site.hpp"
#include "server/transport.hpp"

namespace limn::server {

struct ServiceConfig {
  TransportConfig transport;
  std::string serverName = "limnd";
  std::vector<TechniqueInfo> techniques;
  std::vector<std::string> layers;         ///< that save takes
  std::vector<std::string> stages;         ///< of a picture's times, as far as is known before the first
  uint32_t maxImageSide = 4096;            ///< [pixel]
  std::filesystem::path assetRoot;
  AssetReaders readers;
  std::span<const SiteFile> site;
  std::shared_ptr<Journal> journal;        ///< of accepted edits; null: they end with the process
  double helloSeconds = 5.0;               ///< from the handshake to the client's hello
  double ackSeconds = 10.0;                ///< without an acknowledgement while frames are in flight
  double idleExitSeconds = 0.0;            ///< without a client, then drain; 0: never
  double safeSeconds = 60.0;               ///< with all that the journal holds: then it is not what ends the process
};

/// What is counted for /metrics and tests. Loop thread.
struct ServiceCounters {
  uint64_t sessions = 0, framesSent = 0, framesReplaced = 0, framesEncoded = 0, frameBytes = 0;
  uint64_t edits = 0, requests = 0, errors = 0, loads = 0, acknowledgements = 0, helloTimeouts = 0, ackTimeouts = 0,
           slowReaders = 0;
};

/// Clients on one side, the three boxes of the renderer on the other. Knows no device.
class Service : private TransportHandler {
 public:
  /// Listens at once; upgrades are refused until setReady(true). The boxes outlive the service, and the render thread
  /// ends before the service does. Errors: "listen".
  static Result<std::unique_ptr<Service>> open(ServiceConfig config, Mailbox& mailbox, FrameSlot& frames,
                                               StatusQueue& replies);
  ~Service() override;

  /// The renderer's scene is there, seen through `view`: the renderer is asked for what a journal kept, as if a client did. Any
  /// thread, once, before the renderer looks into its mailbox and before setReady(true).
  void begin(const View& view, const std::vector<protocol::ClientMessage>& kept);
  uint16_t port() const { return m_transport->port(); }
  void run() { m_transport->run(); }       ///< the loop thread is the one that calls this; returns after a drain
  void drain() { m_transport->drain(); }   ///< any thread
  /// After run(): waits for a picture that is being encoded and a file that is being read, which may take long.
  void finishWork();
  void setReady(bool ready);               ///< any thread

 private:
  Service(ServiceConfig config, Mailbox& mailbox, FrameSlot& frames, StatusQueue& replies);

  // TransportHandler, service.cpp
  bool acceptsClients() override { return m_ready; }
  void onOpen(ConnectionId id) override;
  void onMessage(ConnectionId id, std::string_view text) override;
  std::optional<OutgoingMessage> nextMessage(ConnectionId id) override;
  void onSent(ConnectionId) override {}
  void onClose(ConnectionId id) override;
  void onWake() override;
  void onTick() override;
  void onDrain() override;
  HttpReply onHttp(const HttpRequest& request) override;

  ClientSession* find(ConnectionId id);
  void send(ClientSession& session, const protocol::ServerMessage& message);
  void sendError(ClientSession& session, uint32_t seq, const Error& error);
  void noteQueued(ClientSession& session, bool taken);
  void closeSession(ClientSession& session, CloseCode code, const std::string& reason);
  void dropSlowReader(ClientSession& session);
  void tellWatched();
  void checkTimers(ClientSession& session, double now);

  // service_messages.cpp: what clients say
  friend struct MessageHandler;
  void greet(ClientSession& session, const protocol::ClientHello& hello);
  void askForScene(ClientSession& session);
  /// `unsaid`: what the renderer's place of a field, "/edits/0/view/eye", has in front that the message does not: nothing in a `batch`.
  void edit(ClientSession& session, uint32_t seq, const std::vector<protocol::Edit>& edits, std::string_view unsaid);
  /// `view`: as the edits before leave it.
  static void addEdit(EditJob& job, const protocol::Edit& wire, View& view);
  /// An edit that leaves this view is on its way.
  void noteMoved(const Origin& by, const View& view);
  bool askLoader(ClientSession& session, LoaderJob job);
  /// False, with an error told, when too much waits already.
  bool ask(ClientSession& session, uint32_t seq, Request request);

  // service_replies.cpp: what the renderer says
  friend struct ReplyHandler;
  void routeReplies();
  void join(ClientSession& session, const SceneSummary& scene);
  void tellFailure(const Error& error);
  void describeForAll();
  void learnView(const SceneSummary& scene);
  void broadcastScene(const SceneSummary& scene, protocol::SceneCause cause, ConnectionId except);
  void sendStatus(ClientSession& session, const protocol::Status& status);
  void checkErrorWaits(ClientSession& session, const FrameInfo& info);

  // service_journal.cpp: what outlives the process
  void takeUp(const std::vector<protocol::ClientMessage>& messages);
  void askForKept(uint32_t seq, std::vector<protocol::Edit> edits);
  void rememberUnacknowledged(const Origin& from, protocol::ClientMessage message);
  void noteAccepted(const EditAck& ack);
  void noteAccepted(const LoadReply& reply);
  void noteTakenUp(const Origin& from);
  std::vector<protocol::Edit> noteSettled(const Origin& from);
  void noteRefused(const ErrorReply& reply);
  void keepAccepted();
  void catchUp(double now);
  void noteKept(const Result<void>& kept);
  void confirmJournal(double now);

  // service_frames.cpp: pictures
  void distributeFrames();
  void offer(const std::shared_ptr<const EncodedFrame>& frame);
  void give(ClientSession& session, const std::shared_ptr<const EncodedFrame>& frame);

  // service_http.cpp
  std::string metrics() const;
  uint64_t framesReplaced() const;         ///< of clients that are here and of those that left

  ServiceConfig m_config;
  Mailbox& m_mailbox;
  FrameSlot& m_frames;
  StatusQueue& m_replies;
  std::unique_ptr<Transport> m_transport;
  std::unique_ptr<EncodeWorker> m_encoder;
  std::unique_ptr<LoaderWorker> m_loader;
  std::atomic<bool> m_begun{false};        ///< begin() is over
  std::atomic<bool> m_ready{false};        ///< written by the render thread

  std::map<ConnectionId, ClientSession> m_sessions;
  std::map<EncodingKey, std::shared_ptr<const EncodedFrame>> m_encoded;  ///< of the newest picture
  ServiceCounters m_counters;
  bool m_watched = false;
  bool m_rendererFailed = false;           ///< and the daemon ends
  double m_aloneSince = 0.0;               ///< [s] no client since then

  // Written by begin() too, and not looked at before m_begun: m_view, m_viewEdits, m_takingUp.
  View m_view;                             ///< as the edits sent so far leave it; completes lenses of camera edits
  std::set<std::pair<ConnectionId, uint32_t>> m_viewEdits;  ///< client and seq of those that were not answered yet
  std::map<std::pair<ConnectionId, uint32_t>, std::string_view> m_unsaid;  ///< the same: what their places have in front
  std::map<std::pair<ConnectionId, uint32_t>, protocol::ClientMessage> m_unacknowledged;  ///< for the journal: the same
  std::vector<Accepted> m_accepted;        ///< since the journal was last written
  bool m_journalFails = false;             ///< and that was told
  double m_triedToKeep = 0.0;              ///< [s]
  std::map<uint32_t, std::vector<protocol::Edit>> m_takingUp;  ///< requests of the journal that were not answered yet, by seq
  uint32_t m_takenUp = 0;                  ///< seq of the last that was
  double m_settledAt = 0.0;                ///< [s] the last of them was answered, or the scene was there
  std::set<ConnectionId> m_editors;        ///< edited since the others were last told; some may have left
  bool m_describing = false;               ///< a describe of our own is on its way
  uint32_t m_loadedRevision = 0;           ///< of the scene that was loaded last; pictures below it show another
  bool m_viewDoubtful = false;             ///< an edit was refused
  double m_lastBroadcast = 0.0, m_lastStatus = 0.0;  ///< [s]
};

}  // namespace limn::server
