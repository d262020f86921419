#pragma once
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages.gen.hpp"
#include "server/flow_control.hpp"
#include "server/transport.hpp"

namespace limn::server {

/// A wait for an estimated error, and maybe for steps too; the renderer knows waits for steps only.
struct ErrorWait {
  uint32_t seq = 0;
  uint32_t steps = 1;
  float error = 0.0f;          ///< relMSE, for the upper end of its interval
  bool asked = false;          ///< the film's hash was asked for
};

/// The text of a message, or, in place of a scene that is longer than any message may be, of the error that says so.
std::string textOf(const protocol::ServerMessage& message);

/// What the daemon knows of one connection. Loop thread.
class ClientSession {
 public:
  static constexpr size_t kMaxQueuedBytes = 16u << 20;  ///< then a reader is too slow
  static constexpr size_t kMostCountedBytes = kMaxQueuedBytes / 4;  ///< of one message: few long ones may wait, not many
  static constexpr uint32_t kMaxUnanswered = 2048;      ///< requests on their way through the renderer

  ClientSession(ConnectionId id, double now) : m_id(id), m_openedAt(now) {}

  ConnectionId id() const { return m_id; }
  double age(double now) const { return now - m_openedAt; }

  /// Queues a text message. False when the reader is too slow.
  [[nodiscard]] bool queue(std::string text);
  /// Queues the scene as somebody else left it, in the place of one that was not sent yet. False as above.
  [[nodiscard]] bool queueScene(std::string text);
  /// Takes such a scene from the queue: there is a newer one.
  void dropScene();
  /// Queues a file as a binary message. False as above.
  [[nodiscard]] bool queueFile(uint32_t seq, std::shared_ptr<const std::vector<uint8_t>> file);
  /// The oldest queued message.
  std::optional<OutgoingMessage> takeQueued();
  /// Whether a picture goes before what is queued: scenes that follow each other leave it its turn.
  bool pictureIsNext() const { return ready && (m_queue.empty() || (m_queue.front().isScene && m_sceneSent)); }
  size_t queuedMessages() const { return m_queue.size(); }

  /// Whether the renderer has to go on for this client: it watches, or waits for an error that pictures tell.
  bool needsPictures() const { return watching || !errorWaits.empty(); }
  /// Whether a picture may be encoded for this client. It is sent once the client has joined.
  bool wantsFrame() const { return greeted && watching && !closing && !ready && flow.hasCredit(); }
  bool isNew(const Frame& frame) const { return frame.info.frameId > newestFrameId; }
  EncodingKey encodingFor(const Frame& frame) const { return flow.encodingFor(frame.info.phase, takesJpeg, takesPng); }
  /// Takes a picture that waits to be written; counts those which it replaces.
  void take(std::shared_ptr<const EncodedFrame> frame);
  /// The message of the picture that waits.
  OutgoingMessage takeFrame(double now);

  // State of the conversation; service*.cpp writes it.
  bool greeted = false;                ///< hello came and was good
  bool sceneAsked = false;             ///< of the renderer, for the scene that a joining client is told
  bool joined = false;                 ///< that scene was queued: before it come no statuses, pictures and other scenes
  bool watching = false;               ///< pictures are wanted
  bool takesJpeg = true, takesPng = true;
  uint32_t lastSeq = 0, helloSeq = 0;
  uint32_t unanswered = 0;
  uint32_t readingSeq = 0;             ///< of the load or edit whose file the loader reads; 0: none
  uint32_t savingSeq = 0;              ///< of the save whose file is not being written yet; 0: none
  std::vector<ErrorWait> errorWaits;
  uint32_t lastEditSeq = 0;            ///< of an edit that changes something, as far as is known
  uint32_t lastEffectiveSeq = 0;       ///< of an acknowledged edit that did
  std::vector<std::string> stages;     ///< announced in hello
  std::optional<protocol::Status> lastStatus;
  std::optional<CloseCode> closing;    ///< once everything queued is written
  std::string closeReason;

  FlowControl flow;
  std::shared_ptr<const EncodedFrame> ready;   ///< encoded, not begun to be written
  uint64_t newestFrameId = 0;
  uint64_t framesSent = 0, framesReplaced = 0;

 private:
  struct Queued {
    OutgoingMessage message;
    bool isScene = false;              ///< of queueScene()
  };
  bool push(OutgoingMessage message, bool isScene = false);

  ConnectionId m_id;
  double m_openedAt;
  std::deque<Queued> m_queue;
  size_t m_queuedBytes = 0;            ///< as they count
  size_t m_bytesBefore = 0;            ///< written since the last picture, which comes after them
  bool m_sceneSent = false;            ///< since the last picture
};

}  // namespace limn::server
