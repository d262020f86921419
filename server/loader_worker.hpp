#pragma once
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <variant>
#include <vector>

#include "renderer/scene/gltf_loader.hpp"
#include "renderer/session/mailbox.hpp"

namespace limn::server {

/// How files are read. Loader thread.
struct AssetReaders {
  std::function<Result<LoadedScene>(const std::filesystem::path&)> scene;
  std::function<Result<Image>(const std::filesystem::path&)> image;  ///< for the environment
};

/// A scene to read.
struct SceneJob {
  Origin from;
  std::string uri;
  double receivedAt = 0.0;             ///< nowSeconds() when the message came in
};
/// The environment image that an edit of a request names.
struct ImageUse {
  size_t edit = 0;
  std::string uri;
};
/// Edits that wait for their images.
struct EditJob {
  EditRequest request;
  std::vector<ImageUse> images;
};
using LoaderJob = std::variant<SceneJob, EditJob>;
Origin originOf(const LoaderJob& job);

/// Reads files on a thread of its own, one job at a time, and puts what came of it into the mailbox. What cannot be
/// read goes back.
class LoaderWorker {
 public:
  static constexpr size_t kMaxWaiting = 8;

  /// `assetRoot`: paths may not leave it. `wake` as EncodeWorker's, called after failures.
  LoaderWorker(std::filesystem::path assetRoot, AssetReaders readers, Mailbox& mailbox, std::function<void()> wake);
  ~LoaderWorker();
  LoaderWorker(const LoaderWorker&) = delete;
  LoaderWorker& operator=(const LoaderWorker&) = delete;

  /// Loop thread. False when as many wait as may.
  bool request(LoaderJob job);
  /// Loop thread. Jobs that failed since the last call.
  std::vector<ErrorReply> takeFailed();

 private:
  void run();
  std::optional<Error> perform(LoaderJob& job) const;
  Result<Request> read(SceneJob& job) const;
  Result<Request> read(EditJob& job) const;

  const std::filesystem::path m_assetRoot;
  const AssetReaders m_readers;
  Mailbox& m_mailbox;
  std::function<void()> m_wake;
  std::mutex m_mutex;                  // guards all below
  std::condition_variable m_work;
  std::deque<LoaderJob> m_waiting;
  std::vector<ErrorReply> m_failed;
  bool m_stop = false;
  std::thread m_thread;
};

/// The file that `uri` names under `root`: a regular file, reached without leaving the root by "..", by an absolute
/// path or by a link. Errors: "path", and "io" where nothing is; place: the uri.
Result<std::filesystem::path> resolveAsset(const std::filesystem::path& root, const std::string& uri);

}  // namespace limn::server
