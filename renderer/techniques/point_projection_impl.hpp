#pragma once
#include "renderer/cache/point_grid.hpp"
#include "renderer/cache/point_light.hpp"
#include "renderer/cache/surface_points.hpp"
#include "renderer/gather/point_projection.hpp"
#include "renderer/gpu/tailored_pass.hpp"
#include "renderer/placement/adaptive_grid.hpp"
#include "renderer/reconstruct/joint_bilateral.hpp"
#include "renderer/techniques/pixel_order.hpp"
#include "renderer/techniques/point_projection.hpp"
#include "renderer/techniques/task_queue.hpp"

namespace limn {

/// What was done since the technique was made; tells what an edit costs.
struct PointProjectionWork {
  uint64_t blocksSampled = 0;  ///< got new points
  uint64_t pointUpdates = 0;   ///< of the points as a whole, moved ones included
  uint64_t pointIndices = 0;   ///< grids of points and lists of their sides
  uint64_t slotsLit = 0;       ///< of every cluster, by rays
  uint64_t bounceSites = 0;    ///< gathered at points
  uint64_t pathSides = 0;      ///< of points, followed paths from
  uint64_t pixelsGathered = 0;
};

/// Points of every cluster that the first passes project, and all gathers at points: the first ones.
constexpr uint32_t kBounceSlots = 128;
/// The first pass that gathers by refined light. Those between pass 0 and it only take a sample of direct light: its noise is
/// most of what is wrong by then.
constexpr uint32_t kRefinedPass = 4;

/// Values of the announced parameters.
struct PointProjectionSettings {
  uint32_t points = 0, clusters = 0, projections = 0, microSize = 0, bounces = 0, relightSamples = 0, startGrid = 0,
           filterSize = 0, maxSamples = 0, correctionRays = 0, bouncePoints = 0, paths = 0;
  float threshold = 0.0f, lambda = 0.0f;
};

/// The technique's parts and the order of their work. One file a concern: point_projection.cpp what a technique answers,
/// point_projection_plan.cpp the passes, point_projection_work.cpp one piece of each kind of work.
class PointProjectionTechnique final : public Technique {
 public:
  PointProjectionTechnique();
  const TechniqueInfo& info() const override { return pointProjectionInfo(); }
  Result<void> prepare(const TechniqueContext& context, const SceneNeeds& needs, bool mayCompile) override;
  void setParameter(const std::string& name, double value) override;
  Result<void> restart(const TechniqueContext& context, CostClass changed) override;
  Result<Progress> advance(const TechniqueContext& context, double seconds) override;
  double secondsToGrid(uint32_t stride) const override;
  std::vector<PassUse> passes() const override;
  gpu::PipelineVariant pipelines() const override;
  std::vector<StageTime> stages() const override;
  std::vector<std::pair<std::string, double>> figures() const override;
  uint64_t raysTraced() const override;
  uint64_t discardedSamples() const override;
  const vk::Buffer* indirect() const override { return &m_indirect; }
  const PointProjectionWork& work() const { return m_work; }

 private:
  // point_projection.cpp
  void forgetLight();
  Result<Progress> light(const TechniqueContext& context, double seconds);
  Result<Progress> refine(const TechniqueContext& context, double seconds);
  Result<void> balance(const TechniqueContext& context);
  Result<void> makeBuffers(const TechniqueContext& context);
  Result<void> updatePoints(const TechniqueContext& context);
  Result<void> indexPoints(const TechniqueContext& context);
  PointLayout layoutOfPoints() const;
  PointLightContext lightContext(const TechniqueContext& context) const;
  std::vector<vk::Binding> sceneBindings(const TechniqueContext& context, const vk::Buffer& list) const;
  std::vector<vk::Binding> pointBindings(const TechniqueContext& context, const vk::Buffer& list) const;
  std::vector<vk::Binding> siteBindings(const TechniqueContext& context) const;
  std::vector<vk::Binding> gatherBindings(const TechniqueContext& context) const;
  std::vector<vk::Binding> bounceBindings(const TechniqueContext& context) const;
  std::vector<vk::Binding> shadeBindings(const TechniqueContext& context) const;
  PlacementBuffers placement() const { return {m_siteBuffer, m_indirect, m_list}; }
  ReconstructBuffers reconstruction() const { return {m_siteBuffer, m_indirect, m_filtered}; }
  uint32_t sampleLimit(const TechniqueContext& c) const { return c.sampleLimit ? c.sampleLimit : m_settings.maxSamples; }
  bool gathers() const { return m_settings.bounces > 0 && m_points.count() > 0; }
  /// The paper's own method lights all points as well as it can before it gathers.
  bool refines() const { return gathers() && m_settings.paths > 0; }
  uint32_t slotsUsed() const { return m_pass >= kRefinedPass ? m_light.layout().clusterSize : m_litSlots; }
  Progress progress() const;

  // point_projection_plan.cpp
  void planPreview();
  void pushPreviewLight();
  void planPass(uint32_t pass);
  void planLighting();
  void planRefining();
  void pushCoarsePicture();
  uint32_t startEnd() const;
  void pushStartGrid();
  void pushForget();
  void pushLevels();
  void planBounces();
  uint32_t bouncesAtPoints() const;
  void pushRelight(TaskQueue& queue, SlotRange slots, uint32_t samples, WorkRate& rate);
  void pushPaths(TaskQueue& queue, uint32_t samples, uint32_t samplesBefore, uint32_t endSlot);
  void pushSpread(TaskQueue& queue, uint32_t endSlot, bool compose);
  void pushBounce(uint32_t endSlot, bool compose);
  void pushSites(uint32_t from, uint32_t end);
  void pushGather(const char* name, Task::Begin select);
  Result<uint32_t> selectLevel(const TechniqueContext& context, uint32_t stride);
  void pushLevel(uint32_t stride);
  void pushLevelPart();
  void pushLateShare(uint32_t turn);
  void pushFill(uint32_t stride, uint32_t last = 1);
  void pushFilter();
  void pushShade(uint32_t end, bool firstOfFilm);

  // point_projection_work.cpp
  Result<void> relight(const TechniqueContext& context, SlotRange slots, uint32_t samples);
  Result<void> paths(const TechniqueContext& context, SlotRange slots, uint32_t samples, uint32_t samplesBefore);
  Result<uint32_t> beginSpread(const TechniqueContext& context, uint32_t endSlot, bool compose);
  Result<void> spread(const TechniqueContext& context, SlotRange slots, bool compose);
  Result<void> sites(const TechniqueContext& context, uint32_t first, uint32_t count);
  shared::PointProjectionPush gatherPush(const TechniqueContext& context, uint32_t first, uint32_t count) const;
  Result<void> gather(const TechniqueContext& context, uint32_t first, uint32_t count);
  Result<void> gatherAtPoints(const TechniqueContext& context, uint32_t first, uint32_t count);
  Result<void> fill(const TechniqueContext& context, uint32_t stride, uint32_t last);
  Result<void> shade(const TechniqueContext& context, uint32_t first, uint32_t count, uint32_t sample, bool firstOfFilm);

  PointProjectionSettings m_settings;
  SceneNeeds m_needs;
  bool m_panes = false;  ///< in the scene itself, whatever is forced to be at work: it decides how sums are rounded

  SurfacePoints m_points;
  PointGrid m_pointGrid;    ///< of the points at which bounces are gathered
  PointGrid m_nearestGrid;  ///< of all points
  PointLightCache m_light;
  PointProjection m_gather;
  AdaptiveGrid m_grid;
  JointBilateral m_reconstruct;
  gpu::TailoredPass m_sites, m_shade;

  PixelOrder m_pixelOrder;
  vk::Buffer m_order, m_list, m_siteBuffer, m_indirect, m_filtered, m_lookedUp, m_bounceSides, m_counters;
  uint32_t m_width = 0, m_height = 0;  ///< [pixel] the buffers were made for
  uint32_t m_bounceSlots = 0;          ///< of every cluster, gathered at for bounces
  uint32_t m_bounceSideCount = 0;      ///< of m_bounceSides
  bool m_useFiltered = false;          ///< m_filtered holds what m_indirect does, filtered

  TaskQueue m_tasks;     ///< of the present pass
  TaskQueue m_lighting;  ///< first light of points; goes on where a new view interrupts it
  TaskQueue m_refining;  ///< light of all points from more samples; the same
  WorkRate m_previewRate{1e4}, m_relightRate{3e3}, m_pathRate{1e2}, m_bounceRate{1e4}, m_spreadRate{1e3}, m_siteRate{1e6},
      m_previewGatherRate{2e4}, m_gatherRate{8e3}, m_shadeRate{5e5}, m_filterRate{2e3};
  uint64_t m_lightingRevision = 0;
  bool m_pointsKnown = false;  ///< m_points are those of the settings
  bool m_lit = false;          ///< the first points carry their first light
  bool m_refined = false;      ///< all points carry refined light
  bool m_previewLit = false;   ///< a first part of them carries some of it
  uint32_t m_litSlots = 0;     ///< of every cluster, lit so far, the first ones
  uint32_t m_round = 0;        ///< of the present gathers
  uint32_t m_levelStride = 0;  ///< [pixel] of the level being gathered; 0: all are
  uint32_t m_levelCount = 0, m_levelDone = 0;  ///< pixels of that level, selected and gathered
  uint32_t m_listFirst = 0;    ///< entry of m_list that the present gathers begin at
  uint32_t m_lateTurn = 0;     ///< shares gathered after the levels
  bool m_dropLookedUp = false; ///< most of it, by the samples of this pass
  float m_meanLuminance = 0.0f;  ///< gathered on the start grid [W·sr⁻¹·m⁻²]
  uint32_t m_pass = 0;
  uint32_t m_samplesDone = 0;    ///< of direct light, by passes before this one
  uint32_t m_passSamples = 1;    ///< by this one
  uint32_t m_samplesWanted = 1;  ///< by every one, while the limit leaves as many
  bool m_preview = false;      ///< a first picture from few points is under way
  uint32_t m_shaded = 0;       ///< pixels of the first picture, in the order of m_pixelOrder
  uint32_t m_fillStride = 8;
  bool m_converged = false;
  PointProjectionWork m_work;
  std::vector<StageTime> m_pointTimes;  ///< of the points as they were made for this picture; empty: they were kept
};

}  // namespace limn
