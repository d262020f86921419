#include "server/daemon/render_thread.hpp"

#include <cstdio>

#include "renderer/base/clock.hpp"
#include "renderer/base/log.hpp"
#include "renderer/base/thread_name.hpp"
#include "renderer/scene/gltf_loader.hpp"
#include "renderer/session/session.hpp"
#include "renderer/vk/device.hpp"

namespace limn::server {
namespace {

Result<std::unique_ptr<vk::Device>> openDevice(const DaemonOptions& options) {
  vk::DeviceOptions wanted;
  wanted.select = options.device;
  wanted.cacheDir = options.stateDir.string();
  return vk::Device::open(wanted);
}

Result<std::unique_ptr<Session>> makeSession(vk::Device& device, const DaemonOptions& options, const RenderCalls& calls,
                                             Mailbox& mailbox, FrameSlot& frames, StatusQueue& replies) {
  const double begin = nowSeconds();
  Result<LoadedScene> loaded = loadGltf(options.scene, {options.assetRoot, {}});
  if (!loaded) return loaded.error();
  calls.read(loaded->report);
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.2f s", nowSeconds() - begin);
  logInfo(options.scene.filename().string() + ": " + std::to_string(loaded->report.triangles) + " triangles, read in " +
          seconds);
  for (const LoadReport::Item& item : loaded->report.unsupported)
    logWarning("not supported: " + item.feature + ": " + item.note);
  for (const std::string& note : loaded->report.notes) logInfo(note);

  SessionConfig config;
  config.width = options.width;
  config.height = options.height;
  config.technique = options.technique;
  return Session::create(device, std::move(loaded->scene), std::move(loaded->report), config, mailbox, frames, replies);
}

}  // namespace

RenderThread::RenderThread(const DaemonOptions& options, Mailbox& mailbox, FrameSlot& frames, StatusQueue& replies)
    : m_mailbox(mailbox), m_thread([this, options, &frames, &replies] { run(options, frames, replies); }) {}

RenderThread::~RenderThread() {
  if (m_thread.joinable()) (void)finish();
}

void RenderThread::start(std::filesystem::path scene, RenderCalls calls) {
  m_started = true;
  m_startPromise.set_value({std::move(scene), std::move(calls)});
}

Result<void> RenderThread::finish() {
  m_mailbox.close();
  if (!m_started) start({}, {});
  m_thread.join();
  return m_outcome;
}

Result<void> RenderThread::serve(Session& session, StatusQueue& replies, const RenderCalls& calls) {
  // The first client's hello names the device: the status must be there before anybody is let in.
  Result<Status> status = session.status();
  if (!status) return status.error();
  replies.setStatus(status.take());
  calls.ready(session.scene().view);
  return session.run();
}

void RenderThread::run(DaemonOptions options, FrameSlot& frames, StatusQueue& replies) {
  nameThread("limn-render");
  Result<std::unique_ptr<vk::Device>> device = openDevice(options);
  m_openedPromise.set_value(device ? Result<void>() : Result<void>(device.error()));
  const Start start = m_start.get();
  options.scene = start.scene;
  if (device && !m_mailbox.closed()) {
    Result<std::unique_ptr<Session>> session = makeSession(**device, options, start.calls, m_mailbox, frames, replies);
    const std::optional<std::filesystem::path> other = session ? std::nullopt : start.calls.refused(session.error());
    if (other) {
      options.scene = *other;
      session = makeSession(**device, options, start.calls, m_mailbox, frames, replies);
    }
    m_outcome = session ? serve(**session, replies, start.calls) : Result<void>(session.error());
  }
  if (!m_outcome) replies.push(ErrorReply{{}, m_outcome.error()});
  start.calls.ended();
}

}  // namespace limn::server
