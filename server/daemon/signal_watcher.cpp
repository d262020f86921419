#include "server/daemon/signal_watcher.hpp"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>

#include "renderer/base/check.hpp"

namespace limn::server {

SignalWatcher::SignalWatcher(int exitCode) : m_exitCode(exitCode) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  m_signals = signalfd(-1, &signals, SFD_CLOEXEC);
  m_stop = eventfd(0, EFD_CLOEXEC);
  LIMN_CHECK(m_signals >= 0 && m_stop >= 0);
}

void SignalWatcher::stop() {
  const uint64_t one = 1;
  if (m_thread.joinable() && write(m_stop, &one, sizeof one) == sizeof one) m_thread.join();
}

SignalWatcher::~SignalWatcher() {
  stop();
  close(m_signals);
  close(m_stop);
}

void SignalWatcher::start(std::function<void()> first) {
  m_thread = std::thread([this, first = std::move(first)] { run(first); });
}

void SignalWatcher::run(const std::function<void()>& first) const {
  bool told = false;
  while (true) {
    pollfd waiting[] = {{m_signals, POLLIN, 0}, {m_stop, POLLIN, 0}};
    if (poll(waiting, 2, -1) < 0) continue;
    if (waiting[1].revents) return;
    signalfd_siginfo info{};
    if (read(m_signals, &info, sizeof info) != sizeof info) continue;
    if (told) _exit(m_exitCode);
    told = true;
    first();
  }
}

}  // namespace limn::server
