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

bool ClientSession::push(OutgoingMessage message) {
  const size_t bytes = counted(message);
  if (m_queuedBytes + bytes > kMaxQueuedBytes) return false;
  m_queuedBytes += bytes;
  m_queue.push_back(std::move(message));
  return true;
}

bool ClientSession::queue(const protocol::ServerMessage& message) {
  return push({false, protocol::encode(message), nullptr});
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
  OutgoingMessage message = std::move(m_queue.front());
  m_queue.pop_front();
  m_queuedBytes -= counted(message);
  if (message.body) {
    m_fileBytes += message.size();
    savingSeq = 0;
  }
  return message;
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
  OutgoingMessage message{true, headerBytes(header), frame->bytes};
  flow.sent(header.frameId, message.size() + std::exchange(m_fileBytes, 0), now);
  return message;
}

}  // namespace limn::server
