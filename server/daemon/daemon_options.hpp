#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/arguments.hpp"

namespace limn::server {

/// What limnd was started with. DESIGN.md section 8.
struct DaemonOptions {
  std::filesystem::path scene;
  std::string listenHost = "127.0.0.1";   ///< IPv6 without brackets
  uint16_t port = 8080;                   ///< 0: the system picks one
  std::string token;                      ///< of --token-file; empty: none is asked for
  std::vector<std::string> allowedOrigins;
  std::filesystem::path assetRoot;        ///< the scene's directory when not given
  std::string device;
  std::string technique;                  ///< empty: the first of the registry
  uint32_t width = 512, height = 512;     ///< [pixel]
  uint32_t maxClients = 16;
  double idleExitSeconds = 0.0;           ///< 0: never
  std::filesystem::path stateDir;         ///< pipeline cache; empty: nothing is kept
  std::filesystem::path journalDir;       ///< accepted edits; empty: they end with the process
  std::string basePath;
};

/// The flags of limnd, for --help and the parser.
CommandSpec daemonSpec();

/// Flags, then what `--config` holds for those that were not given: a JSON object with the same names, texts and
/// numbers, and lists for repeated flags; every flag has a value, so there is neither true nor false. Reads the token
/// file. Errors: "usage" and, for files, "io".
Result<DaemonOptions> readDaemonOptions(const std::vector<std::string>& words);

}  // namespace limn::server
