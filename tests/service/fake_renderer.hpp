#pragma once
#include <atomic>
#include <map>
#include <thread>

#include "renderer/session/mailbox.hpp"

namespace limn::server::testing {

/// Stands where the render thread stands: drains a mailbox, answers, publishes pictures that can be told apart. Every
/// edit restarts it; after `passes` pictures it has converged and sleeps.
class FakeRenderer {
 public:
  struct Options {
    uint32_t width = 64, height = 48;    ///< [pixel]
    uint32_t passes = 4;                 ///< pictures after a restart; the last one is Phase::converged
    double frameSeconds = 0.001;
    uint32_t materials = 2;
    size_t fileBytes = 300000;           ///< of what save is answered with
    bool noisy = false;                  ///< pictures that hardly compress
    bool watched = false;                ///< before the service says so
  };

  FakeRenderer(const Options& options, Mailbox& mailbox, FrameSlot& frames, StatusQueue& replies);
  ~FakeRenderer();

  /// Of the scene that it begins with.
  static View view();
  uint64_t framesPublished() const { return m_published; }
  /// The pixels of a picture, for comparison with what arrived.
  static std::vector<uint8_t> pixels(const Options& options, uint64_t frameId);
  /// Held: the mailbox is not drained, and nothing is drawn.
  void hold(bool held) { m_held = held; }
  /// Busy: the mailbox is not drained, and pictures go on.
  void keepBusy(bool busy) { m_busy = busy; }

 private:
  void run();
  void handle(const Request& request);
  void publish();
  std::shared_ptr<const SceneSummary> describe() const;
  void answerWaits();

  const Options m_options;
  Mailbox& m_mailbox;
  FrameSlot& m_frames;
  StatusQueue& m_replies;
  std::atomic<uint64_t> m_published{0};
  std::atomic<bool> m_held{false}, m_busy{false};

  // Render thread from here on.
  SceneSummary m_scene;
  std::map<uint64_t, uint32_t> m_applied;
  std::vector<WaitRequest> m_waits;
  uint32_t m_steps = 0;
  uint64_t m_frameId = 0, m_edits = 0, m_restarts = 0;
  bool m_watched;
  double m_editAt = 0.0;
  std::thread m_thread;
};

}  // namespace limn::server::testing
