#include "server/daemon/daemon_options.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "server/access.hpp"

namespace limn::server {
namespace {

namespace fs = std::filesystem;

constexpr size_t kLeastToken = 8, kMostToken = 512;   // [character]
constexpr uintmax_t kMostConfigBytes = 1 << 20;

Result<std::string> readSmallFile(const fs::path& path, const std::string& flag) {
  std::error_code error;
  if (fs::file_size(path, error) > kMostConfigBytes || error)
    return Error{"io", "--" + flag + ": the file cannot be read or is too large", path.string()};
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return Error{"io", "--" + flag + ": the file cannot be read", path.string()};
  return text.str();
}

bool isPlain(std::string_view text, std::string_view marks) {
  return std::all_of(text.begin(), text.end(), [marks](unsigned char c) {
    return std::isalnum(c) || marks.find(char(c)) != marks.npos;
  });
}

/// Letters, digits and a few marks: what a cookie, a header and a link carry alike.
Result<std::string> readToken(const fs::path& path) {
  Result<std::string> text = readSmallFile(path, "token-file");
  if (!text) return text.error();
  std::string token = text->substr(0, text->find_first_of("\r\n"));
  if (!isPlain(token, "-._~") || token.size() < kLeastToken || token.size() > kMostToken)
    return Error{"io", "a token is 8 to 512 letters, digits or -._~ on the first line", path.string()};
  return token;
}

/// One value of a configuration file as the command line would write it.
Result<std::string> wordOf(const nlohmann::json& value, const std::string& name) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  return usageError("--config: \"" + name + "\" must be a text or a number");
}

/// Appends what the file says about flags that were not given.
Result<std::vector<std::string>> withConfig(std::vector<std::string> words, const Arguments& given) {
  const fs::path path = given.text("config");
  Result<std::string> text = readSmallFile(path, "config");
  if (!text) return text.error();
  const nlohmann::json config = nlohmann::json::parse(*text, nullptr, false);
  if (!config.is_object()) return usageError("--config: " + path.string() + " is not a JSON object");
  for (const auto& [name, value] : config.items()) {
    if (name == "config") return usageError("--config: a configuration cannot name another");
    if (given.has(name)) continue;
    const nlohmann::json list = value.is_array() ? value : nlohmann::json::array({value});
    for (const nlohmann::json& item : list) {
      Result<std::string> word = wordOf(item, name);
      if (!word) return word.error();
      words.push_back("--" + name + "=" + *word);
    }
  }
  return words;
}

Result<void> readListen(const std::string& text, DaemonOptions& options) {
  const size_t colon = text.rfind(':');
  uint64_t port = 0;
  if (colon == text.npos || !parseInteger(text.substr(colon + 1), port) || port > 65535)
    return usageError("--listen is HOST:PORT, not '" + text + "'");
  options.listenHost = text.substr(0, colon);
  if (options.listenHost.starts_with('[') && options.listenHost.ends_with(']'))
    options.listenHost = options.listenHost.substr(1, options.listenHost.size() - 2);
  if (options.listenHost != "localhost" && !isIpLiteral(options.listenHost))
    return usageError("--listen takes an IP address or localhost, not '" + options.listenHost + "'");
  options.port = uint16_t(port);
  return {};
}

Result<void> readBasePath(std::string path, DaemonOptions& options) {
  while (path.ends_with('/')) path.pop_back();
  const bool plain = isPlain(path, "/-._~") && path.find("..") == path.npos && path.find("//") == path.npos;
  if (!path.empty() && (path[0] != '/' || !plain))
    return usageError("--base-path is a path like /viewer, not '" + path + "'");
  options.basePath = std::move(path);
  return {};
}

Result<void> readNumbers(const Arguments& arguments, DaemonOptions& options) {
  constexpr uint64_t kMostClients = 100;
  constexpr double kLongestIdle = 1e7;
  const Result<uint64_t> clients = arguments.integer("max-clients", options.maxClients, 1, kMostClients);
  if (!clients) return clients.error();
  options.maxClients = uint32_t(*clients);
  const Result<double> idle = arguments.real("idle-exit", 0.0, 0.001, kLongestIdle);
  if (!idle) return idle.error();
  options.idleExitSeconds = *idle;
  if (!arguments.has("size")) return {};
  const Result<PixelSize> size = parsePixelSize(arguments.text("size"));
  if (!size) return size.error();
  constexpr uint32_t kLeastSide = 16, kMostSide = 4096;
  if (std::min(size->width, size->height) < kLeastSide || std::max(size->width, size->height) > kMostSide)
    return usageError("--size is from 16x16 to 4096x4096");
  options.width = size->width;
  options.height = size->height;
  return {};
}

}  // namespace

CommandSpec daemonSpec() {
  return {"limnd",
          "Renders a scene, takes edits over a WebSocket and streams converging pictures to browsers.",
          {},
          {{"scene", "FILE", "the .gltf or .glb to begin with", false, "", true},
           {"listen", "HOST:PORT", "where to listen; 127.0.0.1:8080 when not given, port 0 takes a free one"},
           {"token-file", "F", "holds the token that clients must know; needed to listen beyond this machine"},
           {"allow-origin", "O", "a web origin whose pages may connect, besides our own", true},
           {"asset-root", "DIR", "where clients may load scenes from; the scene's directory when not given"},
           {"device", "NAME|INDEX", "the Vulkan device; `limn devices` lists them"},
           {"config", "FILE", "JSON object with these names; flags go first"},
           {"technique", "T", "the technique to begin with"},
           {"size", "WxH", "the picture's size in pixels; 512x512 when not given"},
           {"max-clients", "N", "connections at a time; 16 when not given"},
           {"idle-exit", "SECONDS", "end when nobody was connected for so long"},
           {"state-dir", "DIR", "where compiled pipelines are kept between runs"},
           {"journal", "DIR", "where accepted edits are kept, by scene; a daemon that starts takes them up again"},
           {"base-path", "P", "the path under which a proxy publishes the daemon"}}};
}

Result<DaemonOptions> readDaemonOptions(const std::vector<std::string>& words) {
  // The scene may stand in the configuration: it is asked for after that was read.
  CommandSpec lenient = daemonSpec();
  for (Flag& flag : lenient.flags) flag.required = false;
  Result<Arguments> first = Arguments::parse(lenient, words);
  if (!first) return first.error();
  std::vector<std::string> all = words;
  if (first->has("config")) {
    Result<std::vector<std::string>> merged = withConfig(words, *first);
    if (!merged) return merged.error();
    all = merged.take();
  }
  const Result<Arguments> arguments = Arguments::parse(daemonSpec(), all);
  if (!arguments) return arguments.error();

  DaemonOptions options;
  options.scene = arguments->text("scene");
  options.allowedOrigins = arguments->all("allow-origin");
  options.assetRoot =
      arguments->text("asset-root", options.scene.has_parent_path() ? options.scene.parent_path().string() : ".");
  options.device = arguments->text("device");
  options.technique = arguments->text("technique");
  options.stateDir = arguments->text("state-dir");
  options.journalDir = arguments->text("journal");
  if (Result<void> r = readListen(arguments->text("listen", "127.0.0.1:8080"), options); !r) return r.error();
  if (Result<void> r = readBasePath(arguments->text("base-path"), options); !r) return r.error();
  if (Result<void> r = readNumbers(*arguments, options); !r) return r.error();
  if (arguments->has("token-file")) {
    Result<std::string> token = readToken(arguments->text("token-file"));
    if (!token) return token.error();
    options.token = token.take();
  }
  if (options.token.empty() && !isLoopbackName(options.listenHost))
    return Error{"token", "listening beyond this machine needs --token-file", options.listenHost};
  return options;
}

}  // namespace limn::server
