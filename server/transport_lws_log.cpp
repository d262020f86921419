#include "renderer/base/clock.hpp"
#include "renderer/base/log.hpp"
#include "server/transport_lws.hpp"

#include <mutex>

namespace limn::server {
namespace {

/// A hostile peer can make lws write lines as fast as it connects.
struct LogState {
  std::mutex mutex;  // guards all below; lws logs from the loop, two transports of a test from two
  TokenBucket lines{2.0, 10.0};
  uint64_t suppressed = 0;
  std::string lastError;
};

LogState& state() {
  static LogState instance;
  return instance;
}

void emit(int level, const char* line) {
  std::string text(line);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  LogState& log = state();
  {
    const std::lock_guard lock(log.mutex);
    if (level == LLL_ERR) log.lastError = text;
    const double now = nowSeconds();
    if (log.lines.empty(now)) {
      ++log.suppressed;
      return;
    }
    log.lines.take(1.0, now);
  }
  limn::log(level == LLL_ERR ? LogLevel::warning : LogLevel::info, "libwebsockets: " + text);
}

}  // namespace

void installLwsLog() { lws_set_log_level(LLL_ERR | LLL_WARN, &emit); }

uint64_t takeSuppressedLwsLines() {
  const std::lock_guard lock(state().mutex);
  return std::exchange(state().suppressed, 0);
}

std::string lastLwsError() {
  const std::lock_guard lock(state().mutex);
  return state().lastError;
}

}  // namespace limn::server
