#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <vector>

#include "renderer/session/messages.hpp"

namespace limn {

/// Requests on their way to the render thread. A view-only edit replaces an earlier undrained view-only edit of the same
/// client (which is then acknowledged as superseded); every other request is kept, in order.
class Mailbox {
 public:
  /// Any thread. False when the box is closed or `kMaxPending` requests wait: the caller tells the client "busy".
  bool push(Request request);
  /// Render thread. Everything that waits, in order; superseded view edits come out as EditAck replies.
  std::vector<Request> drain(std::vector<EditAck>& superseded);
  /// Render thread. Sleeps until something waits, the box is closed, or the time is over; true when something waits.
  bool waitFor(double seconds);
  /// Any thread. Wakes the render thread for good.
  void close();
  bool closed() const;

  static constexpr size_t kMaxPending = 4096;

 private:
  mutable std::mutex m_mutex;          // guards all below
  std::condition_variable m_wake;
  std::vector<Request> m_pending;
  std::vector<EditAck> m_superseded;
  bool m_closed = false;
};

/// The newest finished picture. Publishing replaces; nobody waits for a reader.
class FrameSlot {
 public:
  /// Render thread.
  void publish(std::shared_ptr<const Frame> frame);
  /// Any thread. Null before the first.
  std::shared_ptr<const Frame> newest() const;
  /// Called after each publication, on the render thread; must only wake somebody. Set before the loop starts.
  void onPublish(std::function<void()> wake) { m_wake = std::move(wake); }

 private:
  mutable std::mutex m_mutex;          // guards m_frame
  std::shared_ptr<const Frame> m_frame;
  std::function<void()> m_wake;
};

/// Replies and the newest status on their way from the render thread to the event loop.
class StatusQueue {
 public:
  void push(Reply reply);                          ///< render thread
  void setStatus(Status status);                   ///< render thread; replaces
  std::vector<Reply> drain();                      ///< event loop
  Status status() const;                           ///< any thread
  void onPush(std::function<void()> wake) { m_wake = std::move(wake); }  ///< as FrameSlot::onPublish

 private:
  mutable std::mutex m_mutex;          // guards m_replies, m_status
  std::vector<Reply> m_replies;
  Status m_status;
  std::function<void()> m_wake;
};

}  // namespace limn
