#include "server/client_session.hpp"

#include <algorithm>
#include <utility>

#include "protocol/frame.hpp"
#include "server/convert.hpp"

namespace limn::server {
namespace {

std::string headerBytes(const protocol::FrameHeader& header) {
  std::string bytes(protocol::kFrameHeaderBytes, '\0');
  protocol::encodeFrameHeader(header, std::span<uint8_t, protocol::kFrameHeaderBytes>(
                                          reinterpret_cast<uint8_t*>(bytes.data()), protocol::kFrameHeaderBytes));
  return bytes;
}

size_t counted(const OutgoingMessage& message) { return std::min(message.size(), ClientSession::kMostCountedBytes); }

}  // namespace

/// The message, or in place of one that is longer than any may be, a scene, the error that says so.
std::string textOf(const protocol::ServerMessage& message) {
  std::string text = protocol::encode(message);
  if (text.size() <= protocol::kMaxServerTextBytes) return text;
  const auto* scene = std::get_if<protocol::SceneMessage>(&message);
  protocol::ErrorMessage error;
  if (scene) error.seq = scene->seq;
  error.code = protocol::kErrorLimit;
  error.message = "the description of the scene has " + std::to_string(text.size()) + " bytes, a message at most " +
                  std::to_string(protocol::kMaxServerTextBytes);
  if (error.seq) error.place = "seq " + std::to_string(*error.seq);
  return protocol::encode(error);
}

bool ClientSession::push(OutgoingMessage message, bool isScene) {
  const size_t bytes = counted(message);
  if (m_queuedBytes + bytes > kMaxQueuedBytes) return false;
  m_queuedBytes += bytes;
  m_queue.push_back({std::move(message), isScene});
  return true;
}

bool ClientSession::queue(std::string text) { return push({false, std::move(text), nullptr}); }

bool ClientSession::queueScene(std::string text) {
  dropScene();
  return push({false, std::move(text), nullptr}, true);
}

void ClientSession::dropScene() {
  std::erase_if(m_queue, [this](const Queued& queued) {
    if (queued.isScene) m_queuedBytes -= counted(queued.message);
    return queued.isScene;
  });
}

bool ClientSession::queueFile(uint32_t seq, std::shared_ptr<const std::vector<uint8_t>> file) {
  protocol::FrameHeader header;
  header.kind = protocol::FrameKind::file;
  header.encoding = protocol::Encoding::exr;
  header.ackSeq = seq;
  header.payloadBytes = uint32_t(file->size());
  header.crc32c = protocol::crc32c(*file);
  return push({true, headerBytes(header), std::move(file)});
}

std::optional<OutgoingMessage> ClientSession::takeQueued() {
  if (m_queue.empty()) return std::nullopt;
  Queued next = std::move(m_queue.front());
  m_queue.pop_front();
  m_queuedBytes -= counted(next.message);
  m_bytesBefore += next.message.size();
  m_sceneSent |= next.isScene;
  if (next.message.body) savingSeq = 0;
  return std::move(next.message);
}

void ClientSession::take(std::shared_ptr<const EncodedFrame> frame) {
  const uint64_t id = frame->frame->info.frameId;
  if (newestFrameId > 0) framesReplaced += id - newestFrameId - 1;
  newestFrameId = id;
  ready = std::move(frame);
}

OutgoingMessage ClientSession::takeFrame(double now) {
  const std::shared_ptr<const EncodedFrame> frame = std::exchange(ready, nullptr);
  protocol::FrameHeader header = frameHeader(frame->frame->info, m_id, stages);
  const bool lossless = frame->key.codec == ImageCodec::png;
  header.encoding = lossless ? protocol::Encoding::png : protocol::Encoding::jpeg;
  header.quality = frame->key.quality;
  if (lossless) header.flags |= protocol::kFrameLossless;
  if (lossless && frame->frame->info.phase == Phase::converged) header.flags |= protocol::kFrameFinal;
  header.replaced = uint32_t(framesReplaced);
  header.encodeMs = frame->encodeMs;
  header.payloadBytes = uint32_t(frame->bytes->size());
  header.crc32c = frame->crc32c;
  ++framesSent;
  m_sceneSent = false;
  OutgoingMessage message{true, headerBytes(header), frame->bytes};
  flow.sent(header.frameId, message.size() + std::exchange(m_bytesBefore, 0), now);
  return message;
}

}  // namespace limn::server
