#include "renderer/base/log.hpp"

#include <atomic>
#include <cstdio>
#include <mutex>

#include "renderer/base/clock.hpp"

namespace limn {
namespace {

std::atomic<LogLevel> g_level{LogLevel::info};
std::mutex g_outputMutex;  // guards stderr, so that lines stay whole
const double g_start = nowSeconds();

const char* word(LogLevel level) {
  switch (level) {
    case LogLevel::debug: return "debug";
    case LogLevel::info: return "info";
    case LogLevel::warning: return "warning";
    case LogLevel::error: return "error";
  }
  return "?";
}

}  // namespace

void setLogLevel(LogLevel level) { g_level = level; }

void log(LogLevel level, std::string_view text) {
  if (level < g_level.load()) return;
  const std::lock_guard lock(g_outputMutex);
  std::fprintf(stderr, "[%10.3f] %-7s %.*s\n", nowSeconds() - g_start, word(level), int(text.size()), text.data());
}

}  // namespace limn
