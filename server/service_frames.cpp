#include "server/convert.hpp"
#include "server/service.hpp"

namespace limn::server {

void Service::distributeFrames() {
  for (const auto& encoded : m_encoder->takeDone()) {
    ++m_counters.framesEncoded;
    m_encoded[encoded->key] = encoded;
    offer(encoded);
  }
  const std::shared_ptr<const Frame> newest = m_frames.newest();
  if (!newest) return;
  std::erase_if(m_encoded, [&](const auto& entry) { return entry.second->frame != newest; });

  // Only what somebody can take now is encoded, once for all who want it alike.
  std::set<EncodingKey> wanted;
  for (auto& [id, session] : m_sessions) {
    checkErrorWaits(session, newest->info);
    if (!session.wantsFrame() || !session.isNew(*newest)) continue;
    const EncodingKey key = session.encodingFor(*newest);
    const auto made = m_encoded.find(key);
    if (made == m_encoded.end()) wanted.insert(key);
    else if (session.joined) give(session, made->second);
  }
  if (!wanted.empty()) m_encoder->want(newest, std::move(wanted));
}

void Service::offer(const std::shared_ptr<const EncodedFrame>& encoded) {
  for (auto& [id, session] : m_sessions) {
    if (!session.joined || !session.wantsFrame() || !session.isNew(*encoded->frame)) continue;
    if (session.encodingFor(*encoded->frame) != encoded->key) continue;
    give(session, encoded);
  }
}

// A picture at rest may be long on its way: that it comes is told before.
void Service::give(ClientSession& session, const std::shared_ptr<const EncodedFrame>& encoded) {
  if (encoded->key.codec == ImageCodec::png) sendStatus(session, toWire(m_replies.status()));
  session.take(encoded);
  m_transport->wantWrite(session.id());
}

}  // namespace limn::server
