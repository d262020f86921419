#pragma once
#include <memory>
#include <string>
#include <vector>

#include "renderer/base/stage_time.hpp"
#include "renderer/film/film.hpp"
#include "renderer/film/film_statistics.hpp"
#include "renderer/gpu/device_scene.hpp"
#include "renderer/gpu/pipeline_variant.hpp"
#include "renderer/scene/scene_needs.hpp"
#include "renderer/techniques/technique_info.hpp"
#include "renderer/visibility/scene_tracer.hpp"
#include "renderer/vk/device.hpp"

namespace limn {

/// What every technique draws from. All of it outlives the technique and stays put while the scene does.
struct TechniqueContext {
  vk::Device& device;
  const Scene& description;          ///< the plain data that `scene` mirrors
  const gpu::DeviceScene& scene;
  const SceneTracer& tracer;
  const vk::Buffer& camera;          ///< one shared::CameraData
  const Film& film;
  FilmStatistics& statistics;
  uint32_t seed = 0;
  uint32_t firstSample = 0;          ///< index of the first sample taken of a pixel
  uint64_t lightingRevision = 0;     ///< counts changes of anything that light meets or comes from
  uint32_t sampleLimit = 0;          ///< samples of every pixel at which to stop; 0: the technique's own end
  bool allNeeds = false;             ///< everything is at work that any scene may need, for comparison
};

/// How far the picture has come since the restart.
struct Progress {
  uint32_t passes = 0;               ///< whole passes done; the unit of "steps"
  bool passFinished = false;         ///< by this quantum
  uint32_t fillStride = 0;           ///< pixels without samples are filled from the grid of this stride; 0: none is missing
  double gatheredShare = 0.0;        ///< share of pixels with a sample of their own
  uint32_t samplesPerPixel = 0;      ///< of a pixel that was never stopped
  bool converged = false;
};

/// A pass of a technique's work, for the statistics.
struct PassUse {
  std::string name;
  bool ran = false;                  ///< else the scene and the parameters do not call for it
};

/// A way to compute the film. It works in quanta, so that an edit waits for one quantum and never for a pass; what a pass
/// computes depends on scene, seed, parameters and its number alone, never on time. One file names a technique's parts.
/// Render thread.
class Technique {
 public:
  virtual ~Technique() = default;
  virtual const TechniqueInfo& info() const = 0;

  /// Pipelines for what the scene needs, compiled and warm. Called before every restart; pipelines are made the first time and
  /// where `mayCompile` says that a stop is no matter, as when a scene was loaded. Under a vk::PipelineAllowance it may
  /// fail with kSpent, keeps what it has made, and goes on when it is called again. A later call may bring another context.
  virtual Result<void> prepare(const TechniqueContext& context, const SceneNeeds& needs, bool mayCompile) = 0;
  /// Values within the announced range. The caller restarts what ParameterInfo::cost says.
  virtual void setParameter(const std::string& name, double value) = 0;
  /// Forgets the picture; the next quantum begins pass 0. `changed` says what died, dearest first.
  virtual Result<void> restart(const TechniqueContext& context, CostClass changed) = 0;
  /// Does about `seconds` of device work, never more than the rest of the pass. Waits for the device.
  virtual Result<Progress> advance(const TechniqueContext& context, double seconds) = 0;
  /// Predicted time until every pixel of the grid of `stride` has a sample, from the measured rate [s].
  virtual double secondsToGrid(uint32_t stride) const = 0;
  /// Every pass of work that the technique knows. What the scene needs of all techniques alike is told by SceneNeeds.
  virtual std::vector<PassUse> passes() const = 0;
  /// The worst of the pipelines that depend on the scene's needs, as of the last prepare().
  virtual gpu::PipelineVariant pipelines() const = 0;
  /// Where the time since the restart went, by kind of work, prepare() before it included; what an edit kept is not in it.
  virtual std::vector<StageTime> stages() const = 0;
  /// Facts about the parts at work by name, as "pointRelativeRadius"; the technique's header says what they are.
  virtual std::vector<std::pair<std::string, double>> figures() const { return {}; }
  /// A shared::IndirectTexel of every pixel, whose states say which pixels were gathered for themselves; null where all are.
  virtual const vk::Buffer* indirect() const { return nullptr; }
  /// Rays traced and samples discarded since the process began.
  virtual uint64_t raysTraced() const = 0;
  virtual uint64_t discardedSamples() const = 0;
};

/// A new technique with its default parameters; null for an unknown name. Adding one is one line here.
std::unique_ptr<Technique> makeTechnique(std::string_view name);

}  // namespace limn
