#include "server/daemon/daemon.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>

#include "renderer/base/log.hpp"
#include "renderer/scene/environment_image.hpp"
#include "renderer/techniques/technique_info.hpp"
#include "server/daemon/daemon_options.hpp"
#include "server/daemon/journal_start.hpp"
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
  for (const std::filesystem::path& directory : {options.stateDir, options.journalDir}) {
    if (directory.empty()) continue;
    std::filesystem::create_directories(directory, error);
    if (error) return Error{"io", "the directory cannot be made", directory.string()};
  }
  return {};
}

/// The journal of the scene; null where none is wanted.
Result<std::shared_ptr<Journal>> openJournal(const DaemonOptions& options) {
  if (options.journalDir.empty()) return std::shared_ptr<Journal>();
  const Result<std::filesystem::path> file = journalFileFor(options.journalDir, options.scene);
  if (!file) return file.error();
  Result<std::unique_ptr<Journal>> opened = Journal::open(*file);
  if (!opened) return opened.error();
  return std::shared_ptr<Journal>(opened.take());
}

Result<void> serve(const DaemonOptions& options, SignalWatcher& signals) {
  Result<std::shared_ptr<Journal>> opened = openJournal(options);
  if (!opened) return opened.error();
  const std::shared_ptr<Journal> journal = opened.take();
  Mailbox mailbox;
  mailbox.push(WatchRequest{false});  // nobody looks until the service says so: no work is done before
  FrameSlot frames;
  StatusQueue replies;
  RenderThread renderer(options, mailbox, frames, replies);
  if (Result<void> ready = renderer.opened(); !ready) return ready;

  ServiceConfig config = serviceConfig(options);
  config.journal = journal;
  const Result<std::unique_ptr<Service>> served = Service::open(config, mailbox, frames, replies);
  if (!served) return served.error();
  Service& service = **served;
  JournalStart kept(options, journal);
  const Result<std::filesystem::path> scene = kept.scene();
  if (!scene) return scene.error();
  signals.start([&] {
    logInfo("asked to end: clients are told");
    service.drain();
  });
  std::atomic<bool> begun = false;
  RenderCalls calls;
  calls.refused = [&](const Error& error) { return kept.insteadOf(error); };
  calls.read = [&](const LoadReport& report) { kept.read(report); };
  calls.ready = [&](const View& view) {
    begun = true;
    service.begin(view, kept.messages());
    service.setReady(true);
    std::printf("listening on %s\n", address(options, service.port()).c_str());
    std::fflush(stdout);
  };
  calls.ended = [&] {
    service.setReady(false);
    service.drain();
  };
  renderer.start(*scene, std::move(calls));
  service.run();
  // Render thread and watcher reach into the service: they end first. A second signal ends the process whatever it waits for.
  Result<void> outcome = renderer.finish();
  service.finishWork();
  kept.ended(outcome, begun);
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
