#pragma once
#include <functional>
#include <future>
#include <optional>
#include <thread>

#include "renderer/base/result.hpp"
#include "renderer/session/mailbox.hpp"
#include "server/daemon/daemon_options.hpp"

namespace limn { class Session; }

namespace limn::server {

/// Whom the render thread tells what, on the render thread.
struct RenderCalls {
  /// The scene cannot be begun with: another to begin with, if there is one.
  std::function<std::optional<std::filesystem::path>(const Error&)> refused = [](const Error&) { return std::nullopt; };
  std::function<void(const LoadReport&)> read = [](const LoadReport&) {};   ///< the scene's file
  std::function<void(const View&)> ready = [](const View&) {};   ///< the first edit could be applied; the scene's view
  std::function<void()> ended = [] {};
};

/// The thread that owns device, scene and session. It meets the others in the three boxes only.
class RenderThread {
 public:
  /// Opens the device at once, before the caller starts threads that read the environment.
  RenderThread(const DaemonOptions& options, Mailbox& mailbox, FrameSlot& frames, StatusQueue& replies);
  ~RenderThread();
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  /// Waits for the device. Errors: those of vk::Device::open.
  Result<void> opened() { return m_opened.get(); }
  /// Loads a scene and renders until the mailbox is closed. The boxes' wake functions are set by now.
  void start(std::filesystem::path scene, RenderCalls calls);
  /// Closes the mailbox, waits for the thread, and says why it ended.
  Result<void> finish();

 private:
  struct Start {
    std::filesystem::path scene;
    RenderCalls calls;
  };
  static Result<void> serve(Session& session, StatusQueue& replies, const RenderCalls& calls);
  void run(DaemonOptions options, FrameSlot& frames, StatusQueue& replies);

  Mailbox& m_mailbox;
  std::promise<Result<void>> m_openedPromise;
  std::future<Result<void>> m_opened = m_openedPromise.get_future();
  std::promise<Start> m_startPromise;
  std::future<Start> m_start = m_startPromise.get_future();
  bool m_started = false;
  Result<void> m_outcome;   ///< written by the thread, read after it was joined
  std::thread m_thread;
};

}  // namespace limn::server
