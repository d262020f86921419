#pragma once
#include <functional>
#include <thread>

namespace limn::server {

/// Turns SIGTERM and SIGINT into a call on a thread of its own. The second one ends the process at once.
class SignalWatcher {
 public:
  /// Blocks the signals for the calling thread and all that it starts from now on: made first in main(). Exits with
  /// `exitCode` on the second signal.
  explicit SignalWatcher(int exitCode);
  ~SignalWatcher();
  SignalWatcher(const SignalWatcher&) = delete;
  SignalWatcher& operator=(const SignalWatcher&) = delete;

  /// `first` runs on the watcher's thread; a signal that came before is told at once.
  void start(std::function<void()> first);
  /// Waits for the thread; `first` is not called any more.
  void stop();

 private:
  void run(const std::function<void()>& first) const;

  int m_exitCode;
  int m_signals = -1;   ///< signalfd
  int m_stop = -1;      ///< eventfd
  std::thread m_thread;
};

}  // namespace limn::server
