#pragma once
#include <memory>
#include <string>

#include "renderer/base/result.hpp"
#include "renderer/film/film_image.hpp"
#include "renderer/session/mailbox.hpp"

namespace limn::vk { class Device; }

namespace limn {

class Technique;

struct SessionConfig {
  uint32_t width = 512, height = 512;  ///< [pixel]
  std::string technique;               ///< empty: the first of the registry
  std::vector<std::pair<std::string, double>> parameters;
  uint32_t seed = 0;
  uint32_t firstSample = 0;            ///< index of the first sample taken of a pixel: a part of a render split by samples
  uint32_t sampleCount = 0;            ///< samples of every pixel at which it is converged; 0: the technique's own end
  bool allNeeds = false;               ///< everything is at work that any scene may need: what leaving out is measured against
  uint32_t auditPathsPerPass = 0;      ///< a biased technique's audit after each pass, in place of its share of the time: estimates that can be repeated
  double quantumSeconds = 0.015;       ///< device time between two looks at the mailbox
  double frameSeconds = 0.1;           ///< at rest, the time between two published frames at first; grows as it converges
  double firstFrameSeconds = 0.05;     ///< after an edit, the time in which the first coarse frame should be gathered
};

/// The progressive loop over one scene: drain mailbox, restart plan, one quantum of work, publish if due.
/// Made, used and destroyed on one thread, the render thread; it meets others in the three boxes only.
class Session {
 public:
  static Result<std::unique_ptr<Session>> create(vk::Device& device, Scene scene, LoadReport report, const SessionConfig& config,
                                                 Mailbox& mailbox, FrameSlot& frames, StatusQueue& replies);
  ~Session();

  /// One turn of the loop. Returns false when there was nothing to do: converged or unwatched, all warm, and no mail.
  /// Device errors end the session: Error code "device-lost" or "device".
  Result<bool> step();

  /// Applies what waits in the mailbox, then runs whole passes until `steps` have been made since the restart or the picture
  /// has converged. Publishes nothing. For `limn render` and tests.
  Result<void> runSteps(uint32_t steps);
  /// As runSteps(), but quanta until `seconds` are over, the last cut to what is left; a pass may stay unfinished. How much is
  /// done then depends on the machine. For `limn bench`.
  Result<void> runSeconds(double seconds);
  /// Render thread: steps until the mailbox is closed, sleeping when idle.
  Result<void> run();

  /// As of the last pass or publication, with the error estimated anew.
  Result<Status> status();
  Result<uint64_t> filmHash();         ///< of means, second moments and counts of every pixel
  /// The film with its named layers (film/exr.hpp writes it).
  Result<FilmImage> readFilm();
  /// The picture as it would be published now.
  Result<std::shared_ptr<const Frame>> resolveFrame();
  const Scene& scene() const;
  const Technique& technique() const;
  /// Whether every technique has its pipelines for this scene. step() makes them, one a turn, once a picture was
  /// published; then no edit has any made.
  bool warm() const;

 private:
  struct Impl;
  explicit Session(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> m_impl;
};

}  // namespace limn
