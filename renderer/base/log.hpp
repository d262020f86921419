#pragma once
#include <string_view>

namespace limn {

enum class LogLevel { debug, info, warning, error };

/// Lines below this level are dropped. Any thread. Default: info.
void setLogLevel(LogLevel level);

/// Writes one line to stderr: seconds since start, level, text. Any thread; lines never interleave.
void log(LogLevel level, std::string_view text);

inline void logInfo(std::string_view text) { log(LogLevel::info, text); }
inline void logWarning(std::string_view text) { log(LogLevel::warning, text); }
inline void logError(std::string_view text) { log(LogLevel::error, text); }

}  // namespace limn
