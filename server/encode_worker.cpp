#include "server/encode_worker.hpp"

#include "protocol/frame.hpp"
#include "renderer/base/clock.hpp"
#include "renderer/base/log.hpp"
#include "renderer/base/thread_name.hpp"

namespace limn::server {
namespace {

/// Null, and a line in the log, when it cannot be done.
std::shared_ptr<const EncodedFrame> encode(const std::shared_ptr<const Frame>& frame, const EncodingKey& key) {
  const double begin = nowSeconds();
  Result<Bytes> bytes = encodeImage(*frame, key);
  if (!bytes) {
    logError("a picture was not encoded: " + bytes.error().text());
    return nullptr;
  }
  auto encoded = std::make_shared<EncodedFrame>();
  encoded->frame = frame;
  encoded->key = key;
  encoded->bytes = std::make_shared<const Bytes>(bytes.take());
  encoded->crc32c = protocol::crc32c(*encoded->bytes);
  encoded->encodeMs = float((nowSeconds() - begin) * 1e3);
  return encoded;
}

}  // namespace

EncodeWorker::EncodeWorker(std::function<void()> wake) : m_wake(std::move(wake)), m_thread([this] { run(); }) {}

EncodeWorker::~EncodeWorker() {
  {
    const std::lock_guard lock(m_mutex);
    m_stop = true;
  }
  m_work.notify_all();
  m_thread.join();
}

void EncodeWorker::want(std::shared_ptr<const Frame> frame, std::set<EncodingKey> keys) {
  {
    const std::lock_guard lock(m_mutex);
    if (m_current && m_current == frame) keys.erase(m_currentKey);
    m_wanted = std::move(frame);
    m_keys = std::move(keys);
  }
  m_work.notify_one();
}

std::vector<std::shared_ptr<const EncodedFrame>> EncodeWorker::takeDone() {
  const std::lock_guard lock(m_mutex);
  return std::exchange(m_done, {});
}

uint64_t EncodeWorker::failures() const {
  const std::lock_guard lock(m_mutex);
  return m_failures;
}

void EncodeWorker::run() {
  nameThread("limn-encode");
  std::unique_lock lock(m_mutex);
  while (true) {
    m_work.wait(lock, [this] { return m_stop || !m_keys.empty(); });
    if (m_stop) return;
    m_current = m_wanted;
    m_currentKey = m_keys.extract(m_keys.begin()).value();
    const auto frame = m_current;
    const EncodingKey key = m_currentKey;

    lock.unlock();
    auto encoded = encode(frame, key);
    lock.lock();

    m_current = nullptr;
    if (encoded) m_done.push_back(std::move(encoded));
    else ++m_failures;
    lock.unlock();
    m_wake();
    lock.lock();
  }
}

}  // namespace limn::server
