#include "renderer/session/mailbox.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace limn {
namespace {

bool isViewOnly(const Request& request) {
  const auto* edit = std::get_if<EditRequest>(&request);
  return edit && !edit->edits.empty() &&
         std::all_of(edit->edits.begin(), edit->edits.end(), [](const Edit& e) { return std::holds_alternative<SetView>(e); });
}

/// A request that looks at the state may not be passed by an edit that was made after it.
bool observes(const Request& request) {
  return !std::holds_alternative<EditRequest>(request) && !std::holds_alternative<WatchRequest>(request);
}

std::vector<Request>::iterator findReplaceable(std::vector<Request>& pending, uint64_t client) {
  for (auto it = pending.end(); it != pending.begin();) {
    --it;
    if (observes(*it)) return pending.end();
    if (isViewOnly(*it) && std::get<EditRequest>(*it).from.client == client) return it;
  }
  return pending.end();
}

}  // namespace

bool Mailbox::push(Request request) {
  {
    const std::lock_guard lock(m_mutex);
    if (m_closed || m_pending.size() + m_superseded.size() >= kMaxPending) return false;
    if (isViewOnly(request)) {
      const auto earlier = findReplaceable(m_pending, std::get<EditRequest>(request).from.client);
      if (earlier != m_pending.end()) {
        EditAck ack;
        ack.to = std::get<EditRequest>(*earlier).from;
        ack.superseded = true;
        m_superseded.push_back(ack);
        m_pending.erase(earlier);
      }
    }
    m_pending.push_back(std::move(request));
  }
  m_wake.notify_one();
  return true;
}

std::vector<Request> Mailbox::drain(std::vector<EditAck>& superseded) {
  const std::lock_guard lock(m_mutex);
  superseded.insert(superseded.end(), m_superseded.begin(), m_superseded.end());
  m_superseded.clear();
  return std::exchange(m_pending, {});
}

bool Mailbox::waitFor(double seconds) {
  std::unique_lock lock(m_mutex);
  m_wake.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return m_closed || !m_pending.empty(); });
  return !m_pending.empty();
}

void Mailbox::close() {
  {
    const std::lock_guard lock(m_mutex);
    m_closed = true;
  }
  m_wake.notify_all();
}

bool Mailbox::closed() const {
  const std::lock_guard lock(m_mutex);
  return m_closed;
}

void FrameSlot::publish(std::shared_ptr<const Frame> frame) {
  {
    const std::lock_guard lock(m_mutex);
    m_frame.swap(frame);
  }
  if (m_wake) m_wake();
}

std::shared_ptr<const Frame> FrameSlot::newest() const {
  const std::lock_guard lock(m_mutex);
  return m_frame;
}

void StatusQueue::push(Reply reply) {
  {
    const std::lock_guard lock(m_mutex);
    m_replies.push_back(std::move(reply));
  }
  if (m_wake) m_wake();
}

void StatusQueue::setStatus(Status status) {
  const std::lock_guard lock(m_mutex);
  m_status = std::move(status);
}

std::vector<Reply> StatusQueue::drain() {
  const std::lock_guard lock(m_mutex);
  return std::exchange(m_replies, {});
}

Status StatusQueue::status() const {
  const std::lock_guard lock(m_mutex);
  return m_status;
}

}  // namespace limn
