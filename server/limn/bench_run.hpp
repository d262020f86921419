#pragma once
#include <string>
#include <vector>

#include "renderer/film/compare.hpp"
#include "renderer/session/session.hpp"
#include "server/limn/bench_options.hpp"

namespace limn::bench {

/// A session of its own, with boxes that nobody else looks into.
class BenchSession {
 public:
  static Result<std::unique_ptr<BenchSession>> create(vk::Device& device, const LoadedScene& loaded,
                                                      const SessionConfig& config);
  Session& operator*() { return *m_session; }
  Session* operator->() { return m_session.get(); }

 private:
  Mailbox m_mailbox;
  FrameSlot m_frames;
  StatusQueue m_replies;
  std::unique_ptr<Session> m_session;
};

/// What a session's film shows, and from how many samples of each pixel.
struct SampledPicture {
  RadianceImage picture;
  std::vector<float> samples;          ///< one number a pixel
};
/// Errors: those of the session; "bad-image" where a layer is absent.
Result<SampledPicture> readPicture(Session& session);

/// The picture of a run at one budget, and what the film said of it.
struct Checkpoint {
  double seconds = 0.0;                ///< of rendering, as it really was
  uint32_t steps = 0;                  ///< whole passes
  double samples = 0.0;                ///< of a pixel: the harmonic mean, for errors go with 1/samples
  double gatheredShare = 0.0;          ///< of pixels with a sample of their own, 0..1
  double estimate = 0.0, low = 0.0, high = 0.0;  ///< the film's own relMSE and its 95 % interval
  bool converged = false;
  uint64_t filmHash = 0;
  RadianceImage picture;               ///< missing pixels are filled from the coarse grid, as when it is shown

  // Known once there is a reference:
  double relMse = 0.0, relMseAll = 0.0;
  uint64_t nonFinite = 0;
};

/// One technique on one scene with one seed.
struct Run {
  std::string technique;
  uint32_t seed = 0;
  double buildSeconds = 0.0, warmUpSeconds = 0.0;
  std::vector<Checkpoint> checkpoints; ///< one a budget
  Status status;                       ///< at the end
};

/// Runs from the first step to the last budget. Only work is timed: the scene is loaded, pipelines are warm, and taking
/// a checkpoint stops the clock.
Result<Run> measureRun(vk::Device& device, const LoadedScene& loaded, const SessionConfig& config,
                       const std::vector<Budget>& budgets);

/// Gives pixels without samples the value of the pixel with samples at the corner of the smallest cell, of stride 2, 4
/// or 8, that has one; those stay black where there is none.
void fillMissing(RadianceImage& picture, const std::vector<float>& samples);

}  // namespace limn::bench
