#pragma once
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "renderer/scene/gltf_loader.hpp"
#include "renderer/session/mailbox.hpp"

namespace limn::server {

/// Reads a scene file. Loader thread.
using SceneReader = std::function<Result<LoadedScene>(const std::filesystem::path&)>;

/// Reads scenes on a thread of its own, one at a time, and puts them into the mailbox. What cannot be read goes back.
class LoaderWorker {
 public:
  static constexpr size_t kMaxWaiting = 8;

  /// `assetRoot`: paths may not leave it. `wake` as EncodeWorker's, called after failures.
  LoaderWorker(std::filesystem::path assetRoot, SceneReader reader, Mailbox& mailbox, std::function<void()> wake);
  ~LoaderWorker();
  LoaderWorker(const LoaderWorker&) = delete;
  LoaderWorker& operator=(const LoaderWorker&) = delete;

  /// Loop thread. False when as many wait as may.
  bool request(Origin from, const std::string& uri, double receivedAt);
  /// Loop thread. Loads that failed since the last call.
  std::vector<ErrorReply> takeFailed();

 private:
  struct Job { Origin from; std::string uri; double receivedAt = 0.0; };
  void run();
  Result<LoadedScene> read(const Job& job) const;

  const std::filesystem::path m_assetRoot;
  const SceneReader m_reader;
  Mailbox& m_mailbox;
  std::function<void()> m_wake;
  std::mutex m_mutex;                  // guards all below
  std::condition_variable m_work;
  std::deque<Job> m_waiting;
  std::vector<ErrorReply> m_failed;
  bool m_stop = false;
  std::thread m_thread;
};

/// The file that `uri` names under `root`: a regular file, reached without leaving the root by "..", by an absolute
/// path or by a link. Errors: "io", place: the uri.
Result<std::filesystem::path> resolveAsset(const std::filesystem::path& root, const std::string& uri);

}  // namespace limn::server
