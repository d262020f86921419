#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace limn::server {

/// Puts the pieces of an incoming message together and keeps it within its limits.
class MessageAssembler {
 public:
  enum class State { more, complete, tooBig, tooManyFragments, emptyFragment };

  MessageAssembler(size_t maxBytes, uint32_t maxFragments) : m_maxBytes(maxBytes), m_maxFragments(maxFragments) {}

  /// `endsFrame`: the last piece of a frame; `endsMessage`: that frame is the message's last.
  State add(std::string_view piece, bool endsFrame, bool endsMessage) {
    if (m_complete) reset();
    if (piece.size() > m_maxBytes - m_text.size()) return State::tooBig;
    m_text.append(piece);
    m_frameBytes += piece.size();
    if (!endsFrame) return State::more;
    const bool empty = m_frameBytes == 0;
    m_frameBytes = 0;
    if (++m_fragments > m_maxFragments) return State::tooManyFragments;
    if (empty && !endsMessage) return State::emptyFragment;
    m_complete = endsMessage;
    return endsMessage ? State::complete : State::more;
  }
  std::string_view text() const { return m_text; }

 private:
  void reset() {
    m_complete = false;
    m_fragments = 0;
    m_text.clear();
    if (m_text.capacity() > 65536) m_text.shrink_to_fit();
  }

  size_t m_maxBytes;
  uint32_t m_maxFragments, m_fragments = 0;
  size_t m_frameBytes = 0;
  std::string m_text;
  bool m_complete = false;
};

}  // namespace limn::server
