#include "server/loader_worker.hpp"

#include <algorithm>
#include <new>

#include "renderer/base/thread_name.hpp"

namespace limn::server {

namespace fs = std::filesystem;

Result<fs::path> resolveAsset(const fs::path& root, const std::string& uri) {
  const fs::path relative(uri);
  const auto refuse = [&](const char* why) { return Error{"io", why, uri}; };
  if (uri.empty() || uri.find('\0') != std::string::npos) return refuse("a path is needed");
  if (relative.is_absolute()) return refuse("paths are relative to the asset root");
  if (std::any_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; }))
    return refuse("paths may not leave the asset root");
  std::error_code error;
  const fs::path base = fs::canonical(root, error);
  if (error) return refuse("the asset root cannot be read");
  const fs::path file = fs::canonical(base / relative, error);
  if (error) return refuse("no such file");
  const auto [left, right] = std::mismatch(base.begin(), base.end(), file.begin(), file.end());
  if (left != base.end()) return refuse("paths may not leave the asset root");
  if (!fs::is_regular_file(file, error)) return refuse("not a regular file");
  return file;
}

LoaderWorker::LoaderWorker(fs::path assetRoot, SceneReader reader, Mailbox& mailbox, std::function<void()> wake)
    : m_assetRoot(std::move(assetRoot)), m_reader(std::move(reader)), m_mailbox(mailbox), m_wake(std::move(wake)),
      m_thread([this] { run(); }) {}

LoaderWorker::~LoaderWorker() {
  {
    const std::lock_guard lock(m_mutex);
    m_stop = true;
  }
  m_work.notify_all();
  m_thread.join();
}

bool LoaderWorker::request(Origin from, const std::string& uri, double receivedAt) {
  {
    const std::lock_guard lock(m_mutex);
    if (m_waiting.size() >= kMaxWaiting) return false;
    m_waiting.push_back({from, uri, receivedAt});
  }
  m_work.notify_one();
  return true;
}

std::vector<ErrorReply> LoaderWorker::takeFailed() {
  const std::lock_guard lock(m_mutex);
  return std::exchange(m_failed, {});
}

Result<LoadedScene> LoaderWorker::read(const Job& job) const {
  const Result<fs::path> file = resolveAsset(m_assetRoot, job.uri);
  if (!file) return file.error();
  try {
    return m_reader(*file);
  } catch (const std::bad_alloc&) {
    return Error{"limit", "the scene needs more memory than there is", job.uri};
  }
}

void LoaderWorker::run() {
  nameThread("limn-load");
  std::unique_lock lock(m_mutex);
  while (true) {
    m_work.wait(lock, [this] { return m_stop || !m_waiting.empty(); });
    if (m_stop) return;
    const Job job = std::move(m_waiting.front());
    m_waiting.pop_front();

    lock.unlock();
    Result<LoadedScene> loaded = read(job);
    std::optional<Error> error;
    if (!loaded) error = loaded.error();
    else if (!m_mailbox.push(LoadRequest{job.from, std::make_shared<LoadedScene>(loaded.take()), job.receivedAt}))
      error = Error{"busy", "too many requests wait", job.uri};
    if (error) {
      const std::lock_guard relock(m_mutex);
      m_failed.push_back({job.from, *error});
    }
    if (error) m_wake();
    lock.lock();
  }
}

}  // namespace limn::server
