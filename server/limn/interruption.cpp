#include "server/limn/interruption.hpp"

#include <atomic>
#include <csignal>

namespace limn {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM};
std::atomic<int> caught{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may not wait");

void setHandler(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;  // no system call of a driver is cut short
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

bool isIgnored(int number) {
  struct sigaction action {};
  sigaction(number, nullptr, &action);
  return action.sa_handler == SIG_IGN;
}

void setAll(void (*handler)(int)) {
  for (const int number : kSignals)
    if (!isIgnored(number)) setHandler(number, handler);
}

void note(int number) {
  caught = number;
  setAll(SIG_DFL);
}

}  // namespace

Interruption::Interruption() {
  caught = 0;
  setAll(note);
}

Interruption::~Interruption() { setAll(SIG_DFL); }

int Interruption::signal() { return caught; }

}  // namespace limn
