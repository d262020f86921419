#include "server/loader_worker.hpp"

#include <algorithm>
#include <new>

#include "renderer/base/thread_name.hpp"

namespace limn::server {

namespace fs = std::filesystem;

Result<fs::path> resolveAsset(const fs::path& root, const std::string& uri) {
  const fs::path relative(uri);
  const auto refuse = [&](const char* code, const char* why) { return Error{code, why, uri}; };
  if (uri.empty() || uri.find('\0') != std::string::npos) return refuse("path", "a path is needed");
  if (relative.is_absolute()) return refuse("path", "paths are relative to the asset root");
  if (std::any_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; }))
    return refuse("path", "paths may not leave the asset root");
  std::error_code error;
  const fs::path base = fs::canonical(root, error);
  if (error) return refuse("io", "the asset root cannot be read");
  const fs::path file = fs::canonical(base / relative, error);
  if (error) return refuse("io", "no such file");
  const auto [left, right] = std::mismatch(base.begin(), base.end(), file.begin(), file.end());
  if (left != base.end()) return refuse("path", "paths may not leave the asset root");
  if (!fs::is_regular_file(file, error)) return refuse("path", "not a regular file");
  return file;
}

Origin originOf(const LoaderJob& job) {
  if (const auto* edit = std::get_if<EditJob>(&job)) return edit->request.from;
  return std::get<SceneJob>(job).from;
}

LoaderWorker::LoaderWorker(fs::path assetRoot, AssetReaders readers, Mailbox& mailbox, std::function<void()> wake)
    : m_assetRoot(std::move(assetRoot)), m_readers(std::move(readers)), m_mailbox(mailbox), m_wake(std::move(wake)),
      m_thread([this] { run(); }) {}

LoaderWorker::~LoaderWorker() {
  {
    const std::lock_guard lock(m_mutex);
    m_stop = true;
  }
  m_work.notify_all();
  m_thread.join();
}

bool LoaderWorker::request(LoaderJob job) {
  {
    const std::lock_guard lock(m_mutex);
    if (m_waiting.size() >= kMaxWaiting) return false;
    m_waiting.push_back(std::move(job));
  }
  m_work.notify_one();
  return true;
}

std::vector<ErrorReply> LoaderWorker::takeFailed() {
  const std::lock_guard lock(m_mutex);
  return std::exchange(m_failed, {});
}

Result<Request> LoaderWorker::read(SceneJob& job) const {
  const Result<fs::path> file = resolveAsset(m_assetRoot, job.uri);
  if (!file) return file.error();
  Result<LoadedScene> loaded = m_readers.scene(*file);
  if (!loaded) return loaded.error();
  return Request(LoadRequest{job.from, std::make_shared<LoadedScene>(loaded.take()), job.receivedAt});
}

Result<Request> LoaderWorker::read(EditJob& job) const {
  for (const ImageUse& use : job.images) {
    const auto refuse = [&](const Error& error) {
      const std::string place = "/edits/" + std::to_string(use.edit) + "/image";
      return Error{error.code, "\"" + use.uri + "\": " + error.message, place};
    };
    const Result<fs::path> file = resolveAsset(m_assetRoot, use.uri);
    if (!file) return refuse(file.error());
    Result<Image> image = m_readers.image(*file);
    if (!image) return refuse(image.error());
    std::get<SetEnvironment>(job.request.edits[use.edit]).image = std::make_shared<const Image>(image.take());
  }
  return Request(std::move(job.request));
}

void LoaderWorker::run() {
  nameThread("limn-load");
  std::unique_lock lock(m_mutex);
  while (true) {
    m_work.wait(lock, [this] { return m_stop || !m_waiting.empty(); });
    if (m_stop) return;
    LoaderJob job = std::move(m_waiting.front());
    m_waiting.pop_front();

    lock.unlock();
    const Origin from = originOf(job);
    const std::optional<Error> error = perform(job);
    if (error) {
      const std::lock_guard relock(m_mutex);
      m_failed.push_back({from, *error});
    }
    if (error) m_wake();
    lock.lock();
  }
}

std::optional<Error> LoaderWorker::perform(LoaderJob& job) const {
  try {
    Result<Request> request = std::visit([this](auto& j) { return read(j); }, job);
    if (!request) return request.error();
    if (!m_mailbox.push(request.take())) return Error{"busy", "too many requests wait", ""};
    return std::nullopt;
  } catch (const std::bad_alloc&) {
    return Error{"limit", "the file needs more memory than there is", ""};
  }
}

}  // namespace limn::server
