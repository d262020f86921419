#include "server/daemon/daemon.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "renderer/base/log.hpp"
#include "renderer/scene/environment_image.hpp"
#include "renderer/techniques/technique_info.hpp"
#include "server/daemon/daemon_options.hpp"
#include "server/daemon/render_thread.hpp"
#include "server/daemon/signal_watcher.hpp"
#include "server/service.hpp"

namespace limn::server {
namespace {

std::string address(const DaemonOptions& options, uint16_t port) {
  const bool six = options.listenHost.find(':') != std::string::npos;
  return "http://" + (six ? "[" + options.listenHost + "]" : options.listenHost) + ":" + std::to_string(port) +
         options.basePath + "/";
}

ServiceConfig serviceConfig(const DaemonOptions& options) {
  ServiceConfig config;
  config.transport.address = options.listenHost;
  config.transport.port = options.port;
  config.transport.maxClients = options.maxClients;
  config.transport.access = {options.basePath, options.listenHost, options.allowedOrigins, options.token};
  config.serverName = std::string("limnd ") + LIMN_VERSION;
  config.techniques = techniqueInfos();
  config.layers = {"beauty", "direct", "indirect", "albedo", "normal", "depth", "samples", "error"};
  config.stages = {"sample", "resolve"};
  config.assetRoot = options.assetRoot;
  config.readers.scene = [root = options.assetRoot](const std::filesystem::path& file) {
    return loadGltf(file, {root, {}});
  };
  config.readers.image = [root = options.assetRoot](const std::filesystem::path& file) {
    std::vector<std::string> notes;
    Result<Image> image = loadEnvironmentImage(file, {root, {}}, notes);
    for (const std::string& note : notes) logWarning(file.filename().string() + ": " + note);
    return image;
  };
  config.site = builtInSite();
  config.idleExitSeconds = options.idleExitSeconds;
  return config;
}

/// What can be told before a device is opened.
Result<void> checkOptions(const DaemonOptions& options) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(options.scene, error))
    return Error{"io", "the scene cannot be read", options.scene.string()};
  if (!std::filesystem::is_directory(options.assetRoot, error))
    return Error{"io", "the asset root is not a directory", options.assetRoot.string()};
  if (!options.technique.empty() && !findTechnique(options.technique))
    return usageError("no technique is named '" + options.technique + "'");
  if (options.stateDir.empty()) return {};
  std::filesystem::create_directories(options.stateDir, error);
  if (error) return Error{"io", "the state directory cannot be made", options.stateDir.string()};
  return {};
}

Result<void> serve(const DaemonOptions& options, SignalWatcher& signals) {
  Mailbox mailbox;
  mailbox.push(WatchRequest{false});  // nobody looks until the service says so: no work is done before
  FrameSlot frames;
  StatusQueue replies;
  RenderThread renderer(options, mailbox, frames, replies);
  if (Result<void> opened = renderer.opened(); !opened) return opened;

  Result<std::unique_ptr<Service>> opened = Service::open(serviceConfig(options), mailbox, frames, replies);
  if (!opened) return opened.error();
  Service& service = **opened;
  signals.start([&] {
    logInfo("asked to end: clients are told");
    service.drain();
  });
  const auto ready = [&] {
    service.setReady(true);
    std::printf("listening on %s\n", address(options, service.port()).c_str());
    std::fflush(stdout);
  };
  const auto ended = [&] {
    service.setReady(false);
    service.drain();
  };
  renderer.start(ready, ended);
  service.run();
  // Render thread and watcher reach into the service: they end first.
  Result<void> outcome = renderer.finish();
  signals.stop();
  return outcome;
}

}  // namespace

int runDaemon(const std::vector<std::string>& words) {
  if (std::find(words.begin(), words.end(), "--help") != words.end()) {
    std::fputs(helpText(daemonSpec()).c_str(), stdout);
    return kExitOk;
  }
  const Result<DaemonOptions> options = readDaemonOptions(words);
  if (!options) return reportFailure("limnd", options.error());
  if (const Result<void> usable = checkOptions(*options); !usable) return reportFailure("limnd", usable.error());
  SignalWatcher signals(kExitFailed);
  const Result<void> outcome = serve(*options, signals);
  return outcome ? int(kExitOk) : reportFailure("limnd", outcome.error());
}

}  // namespace limn::server
