#pragma once
#include <map>
#include <optional>

#include "renderer/film/film_statistics.hpp"
#include "renderer/film/resolver.hpp"
#include "renderer/gpu/device_scene.hpp"
#include "renderer/gpu/pass.hpp"
#include "renderer/session/restart_plan.hpp"
#include "renderer/session/session.hpp"
#include "renderer/session/warm_up_scene.hpp"
#include "renderer/techniques/audit.hpp"
#include "renderer/techniques/technique.hpp"
#include "renderer/visibility/scene_tracer.hpp"

namespace limn {

/// Parameter values by announced name, complete for the present technique.
using ParameterValues = std::map<std::string, double>;
ParameterValues defaultParameters(const TechniqueInfo& technique);

/// Size, technique and parameters: what an edit changes that the device may have no memory for.
struct FilmSetup {
  uint32_t width = 0, height = 0;      ///< [pixel]
  std::string technique;
  ParameterValues parameters;
  bool operator==(const FilmSetup&) const = default;
};

/// What Session is made of. One file a concern: session.cpp the loop, session_edits.cpp what an edit does, session_state.cpp the
/// derived data, session_publish.cpp pictures and status, session_audit.cpp the error that is told, session_queries.cpp answers,
/// session_warm_up.cpp pipelines of the techniques that are not in use.
struct Session::Impl {
  Impl(vk::Device& d, Mailbox& in, FrameSlot& slot, StatusQueue& out) : device(d), mailbox(in), frames(slot), replies(out), mirror(d) {}

  // session_state.cpp
  Result<void> init(Scene newScene, LoadReport newReport, const SessionConfig& newConfig);
  Technique& keptTechnique(const std::string& name);
  void chooseTechnique(const std::string& name);
  void setParameters(const ParameterValues& values);
  FilmSetup setup() const { return {config.width, config.height, technique->info().name, parameters}; }
  Result<void> takeSetup(const FilmSetup& wanted, CostClass cost);
  Result<void> restoreSetup(const FilmSetup& before);
  Result<void> showScene();
  Result<void> resize(uint32_t width, uint32_t height);
  Result<void> syncScene(const ChangeSet& changes);
  Result<void> updateTracer(const gpu::SyncReport& report);
  Result<void> writeCamera();
  Result<void> restartFilm(CostClass cost);
  Result<bool> tailorAtRest();
  void measureHostMemory();
  TechniqueContext context();
  std::vector<vk::Binding> pickBindings() const;

  // session_edits.cpp
  Result<void> drainMailbox();
  Result<void> handle(EditRequest& request);
  Result<void> handle(LoadRequest& request);
  Result<void> handle(const LeaveRequest& request);
  /// What the device says to a new setup: refused with "limit" or "out-of-memory", it has the old one again.
  struct SetupOutcome {
    CostClass parameterCost = CostClass::none;
    bool sizeChanged = false;
    std::optional<FilmSetup> before;   ///< where another one was taken
    std::optional<Error> refusal;
  };
  /// In the scene, while the derived data are not redone yet and may turn out to have no room on the device.
  struct PendingEdit {
    EditRequest request;
    AppliedEdits applied;
    SetupOutcome setup;
    std::string technique;             ///< that was in use when it came
  };
  Result<SetupOutcome> applySetup(const EditRequest& request);
  Result<void> checkBatch(std::span<const Edit> batch) const;
  Result<void> checkEdit(std::span<const Edit> batch, size_t index) const;
  void accept(const PendingEdit& edit);
  void refuse(const EditRequest& request, const Error& why);
  void acknowledge(const Origin& from, double receivedAt);
  Result<void> redoPending();
  Result<void> redo(const ChangeSet& changes);
  Result<void> takeBackEdits(std::span<const PendingEdit> edits);

  // session_publish.cpp
  Result<void> publishIfDue();
  bool frameIsDue(double now) const;
  bool gridComplete() const;
  Result<void> publish();
  Result<std::shared_ptr<const Frame>> makeFrame();
  void refreshStatus();
  void listWork();
  Phase phase() const;

  // session_audit.cpp
  Result<void> restartAudit(bool mayCompile);
  double auditShare() const;
  bool everyPixelIsShown() const;
  bool auditIsDue(double seconds) const;
  Result<void> auditFor(double seconds);
  Result<void> auditPass();
  Result<void> estimateError();

  // session_queries.cpp
  Result<void> handle(const PickRequest& request);
  Result<void> handle(const SaveRequest& request);
  Result<void> handle(const DescribeRequest& request);
  Result<void> handle(const WaitRequest& request);
  Result<void> handle(const WatchRequest& request);
  Result<void> answerWaits();
  Result<FilmImage> readFilm();
  std::shared_ptr<const SceneSummary> summary();
  uint64_t sceneHash();
  void forgetSummary(std::span<const Edit> edits);

  // session_warm_up.cpp
  void planWarmUp();
  bool warmUpIsDue() const;
  Result<void> warmUpOnePipeline();

  // session.cpp
  bool idle() const { return progress.converged || (!watched && waits.empty()); }
  Result<void> work(double seconds);

  vk::Device& device;
  Mailbox& mailbox;
  FrameSlot& frames;
  StatusQueue& replies;
  SessionConfig config;

  Scene scene;
  LoadReport report;
  ResolveSettings resolve;
  SceneNeeds needs;
  uint32_t sceneRevision = 0, viewRevision = 0;
  uint64_t lightingRevision = 0;  ///< of the derived data
  std::shared_ptr<const SceneSummary> knownSummary;  ///< since something was last edited
  std::optional<uint64_t> knownSceneHash;            ///< the same, of what Scene::hash() is about
  std::optional<Bounds> knownBounds;                 ///< since a node was last edited

  gpu::DeviceScene mirror;
  SceneTracer tracer;
  vk::Buffer camera, pickResult;
  gpu::Pass pickPass;
  std::optional<Film> film;
  std::optional<Resolver> resolver;
  std::optional<FilmStatistics> statistics;
  std::map<std::string, std::unique_ptr<Technique>> techniques;  ///< those made so far, by name, with their pipelines
  Technique* technique = nullptr;       ///< the one in use
  ParameterValues parameters;
  std::vector<std::string> coldTechniques;  ///< names; not in use, and not prepared for this scene
  std::unique_ptr<WarmUpScene> warmUpScene;
  double warmUpSeconds = 0.0;           ///< spent on coldTechniques since planWarmUp()

  std::vector<PendingEdit> pending;     ///< in the order they came
  Progress progress;
  FilmError error;
  FilmStatistics::Means means;
  Audit audit;                          ///< of biased techniques; prepared when the first is
  double auditOwed = 0.0;               ///< [s] of its share of the time, not had yet
  double auditedSeconds = 0.0;          ///< device time since the restart
  double restartedAt = 0.0, editReceivedAt = 0.0, publishedAt = 0.0;
  uint64_t raysAtRestart = 0, discardedAtRestart = 0;
  double sampledSeconds = 0.0;          ///< device time since the restart
  double sampledAtFrame = 0.0;          ///< of which the last picture knew
  uint32_t publishedPasses = 0;         ///< of the last picture of this state
  bool frameOfState = false;            ///< a picture of the present state was published
  bool sceneShown = false;              ///< a picture was published since the scene was loaded
  bool showAgain = false;               ///< the display settings changed
  bool newSamples = false;              ///< since the last publication
  uint32_t firstStride = 8;             ///< grid at which the first picture after a restart is shown
  bool watched = true;
  uint64_t frameId = 0;
  std::map<uint64_t, uint32_t> appliedSeq;  ///< newest applied seq of every client
  std::vector<WaitRequest> waits;
  std::optional<uint64_t> knownHash;    ///< of the film, since a wait was answered with it
  Status status;
  std::vector<StageTime> stages;
};

}  // namespace limn
