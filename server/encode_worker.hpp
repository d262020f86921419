#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "server/encoders.hpp"

namespace limn::server {

/// Encodes pictures on a thread of its own, one at a time. Only encodings of the newest picture wait.
class EncodeWorker {
 public:
  /// `wake` is called on the worker's thread when something was finished; it must only wake somebody.
  explicit EncodeWorker(std::function<void()> wake);
  ~EncodeWorker();
  EncodeWorker(const EncodeWorker&) = delete;
  EncodeWorker& operator=(const EncodeWorker&) = delete;

  /// Loop thread. Encodings of `frame` that somebody can take now; replaces whatever waited. One that is being made is
  /// not begun again.
  void want(std::shared_ptr<const Frame> frame, std::set<EncodingKey> keys);
  /// Loop thread. What was finished since the last call, in order.
  std::vector<std::shared_ptr<const EncodedFrame>> takeDone();
  uint64_t failures() const;

 private:
  void run();

  std::function<void()> m_wake;
  mutable std::mutex m_mutex;          // guards all below
  std::condition_variable m_work;
  std::shared_ptr<const Frame> m_wanted;
  std::set<EncodingKey> m_keys;        // of m_wanted, not begun
  std::shared_ptr<const Frame> m_current;
  EncodingKey m_currentKey;
  std::vector<std::shared_ptr<const EncodedFrame>> m_done;
  uint64_t m_failures = 0;
  bool m_stop = false;
  std::thread m_thread;
};

}  // namespace limn::server
