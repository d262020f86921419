#include "renderer/techniques/point_projection.hpp"

#include <algorithm>
#include <bit>

#include "renderer/gpu/ray_counters.hpp"
#include "renderer/techniques/point_projection_impl.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/gather_shared.h"

namespace limn {
namespace {

/// Points stay where they are when the picture's seed changes.
constexpr uint32_t kPointSeed = 1;

/// The first pass before which the noise of direct light is looked at: half of a film needs a sample.
constexpr uint32_t kFirstBalanced = 2;
/// relMSE of direct light alone from which on a pass takes but one sample of it, and the most that a pass takes: those take about
/// as long as its gathers. Measured on twelve scenes: the double is no better, and delays what waits for gathers.
constexpr double kEnoughNoise = 1e-3;
constexpr uint32_t kMostPassSamples = 4;

/// Stages of one name are one.
void addTime(std::vector<StageTime>& all, const StageTime& time) {
  const auto same = std::find_if(all.begin(), all.end(), [&](const StageTime& other) { return other.name == time.name; });
  if (same == all.end()) all.push_back(time);
  else same->ms += time.ms;
}

std::vector<uint32_t> constantsOf(const SceneNeeds& needs) {
  std::vector<uint32_t> words = gpu::needsConstants(needs);
  words.push_back(needs.sharp);  // kUseSharp
  return words;
}

Result<vk::Buffer> makeBuffer(vk::Device& device, const char* name, size_t size) {
  vk::BufferDesc desc;
  desc.owner = "point-projection";
  desc.name = name;
  desc.size = size;
  return vk::Buffer::create(device, desc);
}

}  // namespace

PointProjectionTechnique::PointProjectionTechnique()
    : m_sites("gather_sites", sizeof(shared::GatherSitesPush), &constantsOf),
      m_shade("point_projection_shade", sizeof(shared::ShadePush), &constantsOf) {}

void PointProjectionTechnique::setParameter(const std::string& name, double value) {
  const auto whole = uint32_t(value);
  PointProjectionSettings& s = m_settings;
  const PointProjectionSettings before = s;
  if (name == "points") s.points = whole;
  else if (name == "clusters") s.clusters = std::bit_floor(whole);
  else if (name == "projections") s.projections = whole;
  else if (name == "microSize") s.microSize = whole;
  else if (name == "bounces") s.bounces = whole;
  else if (name == "relightSamples") s.relightSamples = whole;
  else if (name == "startGrid") s.startGrid = std::bit_floor(whole);
  else if (name == "threshold") s.threshold = float(value);
  else if (name == "lambda") s.lambda = float(value);
  else if (name == "filterSize") s.filterSize = whole | 1u;
  else if (name == "correctionRays") s.correctionRays = whole;
  else if (name == "bouncePoints") s.bouncePoints = whole;
  else if (name == "paths") s.paths = whole;
  else if (name == "maxSamples") s.maxSamples = whole;
  const bool points = s.points != before.points || s.clusters != before.clusters || s.bouncePoints != before.bouncePoints;
  if (points) m_pointsKnown = false;
  const bool gatheredBounces = s.paths == 0 && s.correctionRays != before.correctionRays;
  if (points || gatheredBounces || s.microSize != before.microSize || s.bounces != before.bounces || s.paths != before.paths ||
      s.relightSamples != before.relightSamples)
    forgetLight();
}

void PointProjectionTechnique::forgetLight() {
  m_lit = m_previewLit = m_refined = false;
  m_litSlots = 0;
  m_lighting.clear();
  m_refining.clear();
}

Result<void> PointProjectionTechnique::makeBuffers(const TechniqueContext& context) {
  const uint32_t width = context.film.width(), height = context.film.height();
  if (m_width == width && m_height == height) return {};
  m_width = m_height = 0;  // while buffers are of two sizes
  m_pixelOrder = makePixelOrder(width, height);
  const size_t pixels = size_t(width) * height;
  const struct {
    vk::Buffer& buffer;
    const char* name;
    size_t bytes;
  } kBuffers[] = {{m_order, "pointProjection.order", pixels * sizeof(uint32_t)},
                  {m_list, "pointProjection.list", pixels * sizeof(uint32_t)},
                  {m_siteBuffer, "pointProjection.sites", pixels * sizeof(shared::GatherSite)},
                  {m_indirect, "pointProjection.indirect", pixels * sizeof(shared::IndirectTexel)},
                  {m_filtered, "pointProjection.filtered", pixels * sizeof(shared::IndirectTexel)},
                  {m_lookedUp, "pointProjection.lookedUp", pixels * sizeof(glm::vec4)}};
  for (const auto& [buffer, name, bytes] : kBuffers) {
    auto made = makeBuffer(context.device, name, bytes);
    if (!made) return made.error();
    buffer = made.take();
  }
  if (!m_counters) {
    auto counters = gpu::makeRayCounters(context.device, "point-projection", "pointProjection.counters");
    if (!counters) return counters.error();
    m_counters = counters.take();
  }
  m_width = width;
  m_height = height;
  return vk::uploadArray(context.device, m_order, std::span<const uint32_t>(m_pixelOrder.pixels));
}

// Points move with what they sit on, and everything that light meets or comes from changes what they carry.
Result<void> PointProjectionTechnique::updatePoints(const TechniqueContext& context) {
  m_pointTimes.clear();
  if (m_pointsKnown && m_lightingRevision == context.lightingRevision) return {};
  auto updated = m_points.update(context.device, context.description, context.scene, m_settings.points, m_settings.clusters, kPointSeed);
  if (!updated) return updated.error();
  m_work.blocksSampled += updated->sampledBlocks;
  m_work.pointUpdates += updated->changed;
  m_pointTimes = {{"sample points", float(updated->sampleMs)},
                  {"move points", float(updated->moveMs)},
                  {"cluster points", float(updated->clusterMs)},
                  {"upload points", float(updated->uploadMs)}};
  forgetLight();
  if (!m_pointsKnown || updated->changed) {
    m_pointsKnown = false;  // until all that is made of them is there
    if (auto done = indexPoints(context); !done) return done;
  }
  m_lightingRevision = context.lightingRevision;
  m_pointsKnown = true;
  return {};
}

// Grids of the points, and the sides where bounces arrive by gathers: both of the first points of every cluster.
Result<void> PointProjectionTechnique::indexPoints(const TechniqueContext& context) {
  const PointLayout layout = layoutOfPoints();
  m_bounceSlots = std::min(std::max(1u, m_settings.bouncePoints / layout.clusterCount), layout.clusterSize);
  std::vector<uint32_t> sides;
  for (uint32_t cluster = 0; cluster < layout.clusterCount; ++cluster)
    for (uint32_t side = 0; side < 2 * m_bounceSlots; ++side) sides.push_back(2 * cluster * layout.clusterSize + side);
  vk::BufferDesc desc;
  desc.owner = "point-projection";
  desc.name = "pointProjection.bounceSides";
  auto list = vk::createBufferWith(context.device, desc, std::span<const uint32_t>(sides));
  if (!list) return list.error();
  m_bounceSides = list.take();
  m_bounceSideCount = uint32_t(sides.size());
  ++m_work.pointIndices;
  if (auto done = m_nearestGrid.update(context.device, m_points, std::min(kBounceSlots, m_points.clusterSize()), kNearestReach); !done) return done;
  return m_pointGrid.update(context.device, m_points, std::min(m_bounceSlots, m_points.clusterSize()));
}

PointLayout PointProjectionTechnique::layoutOfPoints() const {
  return m_points.count() > 0 ? PointLayout{m_points.clusterCount(), m_points.clusterSize()} : PointLayout{1, 1};
}

PointLightContext PointProjectionTechnique::lightContext(const TechniqueContext& context) const {
  return {context.device, context.scene, context.tracer, m_points.bindings(), m_panes};
}

std::vector<vk::Binding> PointProjectionTechnique::sceneBindings(const TechniqueContext& context, const vk::Buffer& list) const {
  return gpu::joined(gpu::joined(context.scene.bindings(), context.tracer.bindings()),
                     {vk::storage(BINDING_CAMERA, context.camera), vk::storage(BINDING_PIXEL_LIST, list)});
}

std::vector<vk::Binding> PointProjectionTechnique::siteBindings(const TechniqueContext& context) const {
  return gpu::joined(sceneBindings(context, m_order), {vk::storage(BINDING_G_BUFFER, m_siteBuffer)});
}

std::vector<vk::Binding> PointProjectionTechnique::pointBindings(const TechniqueContext& context, const vk::Buffer& list) const {
  auto all = gpu::joined(gpu::joined(sceneBindings(context, list), m_points.bindings()), m_light.bindings());
  return gpu::joined(std::move(all), {vk::storage(BINDING_COUNTERS, m_counters)});
}

std::vector<vk::Binding> PointProjectionTechnique::gatherBindings(const TechniqueContext& context) const {
  auto all = gpu::joined(pointBindings(context, m_list), m_nearestGrid.bindings());
  return gpu::joined(std::move(all), {vk::storage(BINDING_G_BUFFER, m_siteBuffer), vk::storage(BINDING_INDIRECT, m_indirect)});
}

std::vector<vk::Binding> PointProjectionTechnique::bounceBindings(const TechniqueContext& context) const {
  return gpu::joined(pointBindings(context, m_bounceSides), m_nearestGrid.bindings());
}

std::vector<vk::Binding> PointProjectionTechnique::shadeBindings(const TechniqueContext& context) const {
  auto all = gpu::joined(sceneBindings(context, m_order), context.film.bindings());
  all = gpu::joined(gpu::joined(std::move(all), m_points.bindings()), m_pointGrid.bindings());
  const vk::Buffer& indirect = m_useFiltered ? m_filtered : m_indirect;
  return gpu::joined(std::move(all), {vk::storage(BINDING_POINT_LIGHT, m_light.light()), vk::storage(BINDING_COUNTERS, m_counters),
                                      vk::storage(BINDING_INDIRECT, indirect), vk::storage(BINDING_G_BUFFER, m_siteBuffer),
                                      vk::storage(BINDING_INDIRECT_SUM, m_lookedUp)});
}

Result<void> PointProjectionTechnique::prepare(const TechniqueContext& context, const SceneNeeds& needs, bool mayCompile) {
  m_needs = needs;
  m_panes = sceneNeeds(context.description).panes;
  if (auto done = makeBuffers(context); !done) return done;
  if (auto done = updatePoints(context); !done) return done;
  const bool sources = context.allNeeds || hasGlossySources(context.description);
  if (auto made = m_light.resize(context.device, layoutOfPoints(), sources, refines()); !made) return made;
  const PointLightContext lighting = lightContext(context);
  if (auto done = m_light.prepare(lighting, needs, mayCompile); !done) return done;
  if (auto done = m_light.prepareSpread(lighting, m_pointGrid.bindings()); !done) return done;
  const bool lobes = m_light.hasLobes();
  if (auto done = m_gather.prepare(context.device, gatherBindings(context), bounceBindings(context), needs, lobes, mayCompile); !done)
    return done;
  if (auto done = m_grid.prepare(context.device, placement(), m_width, m_height); !done) return done;
  if (auto done = m_reconstruct.prepare(context.device, reconstruction(), m_width, m_height); !done) return done;
  if (auto done = m_sites.prepare(context.device, siteBindings(context), needs, mayCompile); !done) return done;
  return m_shade.prepare(context.device, shadeBindings(context), needs, mayCompile);
}

Result<void> PointProjectionTechnique::restart(const TechniqueContext& context, CostClass) {
  m_tasks.clear();
  m_tasks.forgetTimes();
  m_lighting.forgetTimes();
  m_refining.forgetTimes();
  m_pass = m_shaded = m_samplesDone = 0;
  m_passSamples = m_samplesWanted = 1;
  m_levelStride = m_levelCount = m_levelDone = m_lateTurn = 0;
  m_fillStride = PixelOrder::kStrides[0];
  m_converged = m_preview = false;
  m_light.select(PointLightVersion::first);
  const bool dark = !m_lit && m_lighting.empty();
  if (gathers()) planPreview();
  else planPass(0);
  return gpu::runNow(context.device, [&](vk::CommandRecorder& r) {
    context.film.recordClear(r);
    r.fillBuffer(m_indirect, 0, 0, 0);
    if (dark) m_light.recordClear(r);
  });
}

Result<Progress> PointProjectionTechnique::advance(const TechniqueContext& context, double seconds) {
  if (m_samplesDone >= sampleLimit(context)) m_converged = true;
  if (m_converged) return progress();
  if (m_tasks.empty()) return light(context, seconds);
  if (m_pass == kRefinedPass && refines() && !m_refined) return refine(context, seconds);
  if (auto done = m_tasks.advance(context, seconds); !done) return done.error();
  if (!m_tasks.empty() || m_preview) return progress();
  ++m_pass;
  m_samplesDone += m_passSamples;
  if (auto done = balance(context); !done) return done.error();
  planPass(m_pass);
  Progress p = progress();
  p.passFinished = true;
  return p;
}

// How many samples of direct light the next pass takes: while these are what is wrong with the picture, gathers wait. By the film
// alone, so that the same number of passes gives the same bits. Where the number of samples is asked for, each has its pass.
Result<void> PointProjectionTechnique::balance(const TechniqueContext& context) {
  if (context.sampleLimit > 0 || !gathers()) return {};
  if (m_pass >= kFirstBalanced && std::has_single_bit(m_pass)) {
    auto means = context.statistics.means(context.device, context.film);
    if (!means) return means.error();
    auto noise = context.statistics.estimate(context.device, context.film, means->radiance);
    if (!noise) return noise.error();
    m_samplesWanted = uint32_t(std::clamp(noise->relMse / kEnoughNoise, 1.0, double(kMostPassSamples)));
  }
  const uint32_t left = m_settings.maxSamples - std::min(m_samplesDone, m_settings.maxSamples);
  m_passSamples = std::clamp(left, 1u, m_samplesWanted);
  return {};
}

// Between the preview and the first pass.
Result<Progress> PointProjectionTechnique::light(const TechniqueContext& context, double seconds) {
  if (auto done = m_lighting.advance(context, seconds); !done) return done.error();
  if (!m_lighting.empty()) return progress();
  m_lit = true;
  m_preview = false;
  planPass(0);
  return progress();
}

// Before the first pass that gathers by it. It goes on where a new view interrupted it.
Result<Progress> PointProjectionTechnique::refine(const TechniqueContext& context, double seconds) {
  if (m_refining.empty()) planRefining();
  if (auto done = m_refining.advance(context, seconds); !done) return done.error();
  m_refined = m_refining.empty();
  return progress();
}

Progress PointProjectionTechnique::progress() const {
  Progress p;
  p.passes = m_pass;
  p.samplesPerPixel = m_samplesDone;
  p.converged = m_converged;
  p.fillStride = m_pass > 0 ? 0 : m_fillStride;
  p.gatheredShare = m_pass > 0 ? 1.0 : double(m_shaded) / double(m_pixelOrder.pixels.size());
  return p;
}

double PointProjectionTechnique::secondsToGrid(uint32_t stride) const {
  const double first = gathers() ? m_previewGatherRate.secondsFor(uint64_t(m_width / m_settings.startGrid + 1) * (m_height / m_settings.startGrid + 1)) : 0.0;
  for (size_t i = 0; i < PixelOrder::kStrides.size(); ++i)
    if (PixelOrder::kStrides[i] == stride) return first + m_shadeRate.secondsFor(m_pixelOrder.levelEnd[i]);
  return 0.0;
}

uint64_t PointProjectionTechnique::raysTraced() const { return gpu::countedRays(m_counters) + m_light.raysTraced(); }

uint64_t PointProjectionTechnique::discardedSamples() const {
  return gpu::countedDiscards(m_counters) + m_light.discardedSamples();
}

std::vector<PassUse> PointProjectionTechnique::passes() const {
  const bool gathering = gathers();
  return {{"direct light", true},
          {"light tree", m_needs.manyLights},
          {"shadow rays through panes", m_needs.panes},
          {"surface points", m_points.count() > 0},
          {"point relighting", gathering},
          {"gathers", gathering},
          {"gathers at points", gathering && (m_settings.bounces > 1 || m_needs.sharp)},
          {"joint bilateral upsampling", gathering},
          {"joint bilateral filter", gathering && m_settings.filterSize >= 3},
          {"glossy gathers", gathering && m_needs.glossy},
          {"glossy lobes of points", gathering && m_light.hasLobes()},
          {"rays through sharp lobes", m_needs.sharp}};
}

gpu::PipelineVariant PointProjectionTechnique::pipelines() const {
  return std::max({m_light.pipelines(), m_gather.pipelines(), m_sites.variant(), m_shade.variant()});
}

std::vector<StageTime> PointProjectionTechnique::stages() const {
  std::vector<StageTime> all = m_pointTimes;
  for (const TaskQueue* queue : {&m_tasks, &m_lighting, &m_refining})
    for (const StageTime& time : queue->times()) addTime(all, time);
  return all;
}

std::vector<std::pair<std::string, double>> PointProjectionTechnique::figures() const {
  return {{"points", double(m_points.count())},
          {"pointClusters", double(m_points.clusterCount())},
          {"pointRelativeRadius", m_points.relativeRadius()}};
}

std::unique_ptr<Technique> makePointProjection() { return std::make_unique<PointProjectionTechnique>(); }

}  // namespace limn
