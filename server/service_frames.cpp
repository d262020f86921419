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
    else if (session.joined) {
      session.take(made->second);
      m_transport->wantWrite(id);
    }
  }
  if (!wanted.empty()) m_encoder->want(newest, std::move(wanted));
}

void Service::offer(const std::shared_ptr<const EncodedFrame>& encoded) {
  for (auto& [id, session] : m_sessions) {
    if (!session.joined || !session.wantsFrame() || !session.isNew(*encoded->frame)) continue;
    if (session.encodingFor(*encoded->frame) != encoded->key) continue;
    session.take(encoded);
    m_transport->wantWrite(id);
  }
}

}  // namespace limn::server
