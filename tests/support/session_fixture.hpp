#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "renderer/base/clock.hpp"
#include "renderer/session/session.hpp"
#include "renderer/vk/device.hpp"
#include "renderer/vk/instance.hpp"

namespace limn::test {

/// The value; an error fails the test and ends the program, for nothing after it would mean anything.
template <class T>
T must(Result<T> result) {
  if (!result) {
    ADD_FAILURE() << result.error().code << ": " << result.error().text();
    std::abort();
  }
  return result.take();
}
inline void must(Result<void> result) {
  if (!result) {
    ADD_FAILURE() << result.error().code << ": " << result.error().text();
    std::abort();
  }
}

/// The one device of a test program, under the validation layer, which must have said nothing when the program ends.
class DeviceEnvironment : public testing::Environment {
 public:
  void SetUp() override {
    vk::DeviceOptions options;
    options.validation = true;
    options.cacheDir = LIMN_BUILD_DIR "/test-pipelines";
    s_device = must(vk::Device::open(options));
  }
  void TearDown() override {
    const auto log = s_device->validationLog();
    s_device.reset();
    std::string texts;
    for (const std::string& text : log->texts()) texts += "\n" + text;
    EXPECT_EQ(log->count(), 0u) << texts;
  }
  static vk::Device& device() { return *s_device; }

 private:
  static inline std::unique_ptr<vk::Device> s_device;
};
inline testing::Environment* const kDeviceEnvironment = testing::AddGlobalTestEnvironment(new DeviceEnvironment);

inline vk::Device& device() { return DeviceEnvironment::device(); }

inline SessionConfig smallPicture(uint32_t width = 32, uint32_t height = 32) {
  SessionConfig config;
  config.width = width;
  config.height = height;
  return config;
}

/// A session with its three boxes, driven by the test's own thread.
class TestSession {
 public:
  TestSession(Scene scene, const SessionConfig& config, vk::Device& on = device())
      : m_session(must(Session::create(on, std::move(scene), {}, config, mailbox, frames, replies))) {
    frames.onPublish([this] { published.push_back(frames.newest()); });
  }
  Session* operator->() const { return m_session.get(); }

  /// Puts a batch into the mailbox and returns its seq.
  uint32_t edit(std::vector<Edit> edits, uint64_t client = 1) {
    EditRequest request{{client, ++m_seq}, std::move(edits), nowSeconds()};
    EXPECT_TRUE(mailbox.push(std::move(request)));
    return m_seq;
  }
  template <class T>
  uint32_t ask(T request) {
    request.from = {1, ++m_seq};
    EXPECT_TRUE(mailbox.push(std::move(request)));
    return m_seq;
  }
  void watch(bool watched) { EXPECT_TRUE(mailbox.push(WatchRequest{watched})); }

  /// One turn; false when there was nothing to do.
  bool step() { return must(m_session->step()); }
  void steps(int count) {
    for (int i = 0; i < count; ++i) (void)step();
  }
  /// Turns until the loop has nothing to do, at most `limit`.
  int untilIdle(int limit = 100000) {
    int count = 0;
    while (count < limit && step()) ++count;
    return count;
  }
  /// Turns until every technique has its pipelines; false when that does not come.
  bool untilWarm(int limit = 100000) {
    for (int i = 0; i < limit && !m_session->warm(); ++i) (void)step();
    return m_session->warm();
  }
  /// Turns until a picture is published.
  std::shared_ptr<const Frame> nextFrame(int limit = 100000) {
    const size_t before = published.size();
    for (int i = 0; i < limit && published.size() == before; ++i) (void)step();
    EXPECT_GT(published.size(), before) << "no picture was published in " << limit << " steps";
    return published.empty() ? nullptr : published.back();
  }

  /// What came back since the last call.
  std::vector<Reply> takeReplies() { return replies.drain(); }
  /// The replies of one kind since the last call; others are dropped.
  template <class T>
  std::vector<T> take() {
    std::vector<T> found;
    for (Reply& reply : replies.drain())
      if (auto* wanted = std::get_if<T>(&reply)) found.push_back(std::move(*wanted));
    return found;
  }
  /// Applies what waits and returns the one ack.
  EditAck apply(std::vector<Edit> edits) {
    const uint32_t seq = edit(std::move(edits));
    must(m_session->runSteps(0));
    const std::vector<EditAck> acks = take<EditAck>();
    EXPECT_EQ(acks.size(), 1u);
    if (acks.empty()) return {};
    EXPECT_EQ(acks[0].to.seq, seq);
    return acks[0];
  }

  void run(uint32_t passes) { must(m_session->runSteps(passes)); }
  uint64_t hash() { return must(m_session->filmHash()); }
  Status status() { return must(m_session->status()); }
  FilmImage film() { return must(m_session->readFilm()); }
  const Scene& scene() const { return m_session->scene(); }

  Mailbox mailbox;
  FrameSlot frames;
  StatusQueue replies;
  std::vector<std::shared_ptr<const Frame>> published;

 private:
  std::unique_ptr<Session> m_session;
  uint32_t m_seq = 0;
};

/// Hash of the film of a new session after `passes` passes.
inline uint64_t freshHash(const Scene& scene, const SessionConfig& config, uint32_t passes) {
  TestSession fresh(scene, config);
  fresh.run(passes);
  return fresh.hash();
}

}  // namespace limn::test
