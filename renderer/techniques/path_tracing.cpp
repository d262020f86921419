#include "renderer/techniques/path_tracing.hpp"

#include <cmath>

#include "renderer/base/clock.hpp"
#include "renderer/base/mix.hpp"
#include "renderer/gpu/ray_counters.hpp"
#include "renderer/gpu/tailored_pass.hpp"
#include "renderer/techniques/pixel_order.hpp"
#include "renderer/techniques/work_rate.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/film_shared.h"

namespace limn {
namespace {

constexpr uint32_t kWorkgroup = 64, kDealt = 8;  // of path_tracing.comp
constexpr double kInitialPathsPerSecond = 2e5;  // of a slow two-core machine; the first quanta correct it

/// Samples a pixel takes in a pass: one while a first picture is wanted, then enough to keep vectors busy across path ends.
/// No more: Mesa 22.3's software device silently ends every loop of an invocation after 65,535 turns of all of them together
/// (measured), and four paths through a large scene may take a fifth of that.
uint32_t samplesOfPass(uint32_t pass) { return pass < 2 ? 1 : pass < 3 ? 2 : 4; }

/// Sample `push.firstSample` alone, as the first of a sequence that no other sample shares. Its parity, which tells the half
/// of the film, stays.
shared::PathTracingPush independentSample(shared::PathTracingPush push) {
  push.seed = mix32(push.seed ^ mix32(push.firstSample + 1));
  push.firstSample &= 1;
  push.sampleCount = 1;
  return push;
}

class PathTracing final : public Technique {
 public:
  const TechniqueInfo& info() const override { return pathTracingInfo(); }
  Result<void> prepare(const TechniqueContext& context, const SceneNeeds& needs, bool mayCompile) override;
  void setParameter(const std::string& name, double value) override;
  Result<void> restart(const TechniqueContext& context, CostClass changed) override;
  Result<Progress> advance(const TechniqueContext& context, double seconds) override;
  double secondsToGrid(uint32_t stride) const override;
  std::vector<PassUse> passes() const override;
  gpu::PipelineVariant pipelines() const override { return m_trace.variant(); }
  std::vector<StageTime> stages() const override {
    return {{"select", float(m_selectSeconds * 1e3)}, {"trace", float(m_traceSeconds * 1e3)}};
  }
  uint64_t raysTraced() const override { return m_raysTraced; }
  uint64_t discardedSamples() const override { return m_discarded; }

 private:
  std::vector<vk::Binding> bindings(const TechniqueContext& context, const vk::Buffer& list) const;
  Result<void> makeLists(const TechniqueContext& context);
  Result<void> beginPass(const TechniqueContext& context);
  Result<void> dispatch(const TechniqueContext& context, uint32_t count);
  void record(vk::CommandRecorder& recorder, const std::vector<vk::Binding>& bindings, shared::PathTracingPush push) const;
  uint32_t sampleLimit(const TechniqueContext& context) const { return context.sampleLimit ? context.sampleLimit : m_maxSamples; }
  Progress progress() const;

  uint32_t m_maxBounces = 32, m_rouletteStart = 3, m_minSamples = 16, m_maxSamples = 4096;
  bool m_adaptive = true, m_sobol = true;
  float m_noiseThreshold = 0.01f;

  gpu::TailoredPass m_trace{"path_tracing", sizeof(shared::PathTracingPush)};
  vk::Buffer m_order, m_active, m_counters;
  PixelOrder m_pixelOrder;
  uint32_t m_listWidth = 0, m_listHeight = 0;  ///< [pixel] the lists were made for
  SceneNeeds m_needs;
  WorkRate m_rate{kInitialPathsPerSecond};

  uint32_t m_pass = 0, m_cursor = 0, m_passPixels = 0, m_passSamples = 0, m_samplesDone = 0;
  bool m_passOpen = false, m_converged = false;
  uint64_t m_raysTraced = 0, m_discarded = 0;
  double m_selectSeconds = 0.0, m_traceSeconds = 0.0;  ///< since the restart
};

Result<void> PathTracing::prepare(const TechniqueContext& context, const SceneNeeds& needs, bool mayCompile) {
  m_needs = needs;
  if (m_listWidth != context.film.width() || m_listHeight != context.film.height())
    if (auto made = makeLists(context); !made) return made;
  return m_trace.prepare(context.device, bindings(context, m_order), needs, mayCompile);
}

std::vector<PassUse> PathTracing::passes() const {
  return {{"path tracing", true},
          {"next-event estimation", m_needs.punctualLights || m_needs.emissiveTriangles || m_needs.environment},
          {"light tree", m_needs.manyLights},
          {"shadow rays through panes", m_needs.panes},
          {"environment importance table", m_needs.environmentImage},
          {"adaptive sampling", m_adaptive}};
}

void PathTracing::setParameter(const std::string& name, double value) {
  if (name == "maxBounces") m_maxBounces = uint32_t(value);
  else if (name == "rouletteStart") m_rouletteStart = uint32_t(value);
  else if (name == "adaptive") m_adaptive = value != 0.0;
  else if (name == "noiseThreshold") m_noiseThreshold = float(value);
  else if (name == "minSamples") m_minSamples = uint32_t(value);
  else if (name == "maxSamples") m_maxSamples = uint32_t(value);
  else if (name == "sobol") m_sobol = value != 0.0;
  m_converged = false;
}

Result<void> PathTracing::makeLists(const TechniqueContext& context) {
  m_pixelOrder = makePixelOrder(context.film.width(), context.film.height());
  m_listWidth = m_listHeight = 0;  // while lists are of two sizes
  vk::BufferDesc desc;
  desc.owner = "path-tracing";
  desc.name = "pathTracing.order";
  auto order = vk::createBufferWith(context.device, desc, std::span<const uint32_t>(m_pixelOrder.pixels));
  if (!order) return order.error();
  m_order = order.take();
  desc.name = "pathTracing.active";
  desc.size = m_pixelOrder.pixels.size() * sizeof(uint32_t);
  auto active = vk::Buffer::create(context.device, desc);
  if (!active) return active.error();
  m_active = active.take();
  if (!m_counters) {
    auto counters = gpu::makeRayCounters(context.device, "path-tracing", "pathTracing.counters");
    if (!counters) return counters.error();
    m_counters = counters.take();
  }
  m_listWidth = context.film.width();
  m_listHeight = context.film.height();
  return {};
}

std::vector<vk::Binding> PathTracing::bindings(const TechniqueContext& context, const vk::Buffer& list) const {
  auto all = gpu::joined(context.scene.bindings(), context.film.bindings());
  all = gpu::joined(std::move(all), context.tracer.bindings());
  return gpu::joined(std::move(all), {vk::storage(BINDING_CAMERA, context.camera), vk::storage(BINDING_PIXEL_LIST, list),
                                      vk::storage(BINDING_COUNTERS, m_counters)});
}

Result<void> PathTracing::restart(const TechniqueContext& context, CostClass) {
  m_pass = m_cursor = m_samplesDone = 0;
  m_passOpen = m_converged = false;
  m_selectSeconds = m_traceSeconds = 0.0;
  return gpu::runNow(context.device, [&](vk::CommandRecorder& r) { context.film.recordClear(r); });
}

Result<void> PathTracing::beginPass(const TechniqueContext& context) {
  m_cursor = 0;
  m_passOpen = true;
  m_passPixels = context.film.pixelCount();
  m_passSamples = std::min(samplesOfPass(m_pass), sampleLimit(context) - m_samplesDone);
  if (!m_adaptive || m_samplesDone < m_minSamples) return {};
  const double begin = nowSeconds();
  auto means = context.statistics.means(context.device, context.film);
  if (!means) return means.error();
  auto active = context.statistics.selectPixels(context.device, context.film, m_active, m_minSamples, m_noiseThreshold,
                                                means->radiance);
  if (!active) return active.error();
  m_passPixels = *active;
  m_selectSeconds += nowSeconds() - begin;
  return {};
}

Result<void> PathTracing::dispatch(const TechniqueContext& context, uint32_t count) {
  const bool adaptive = m_adaptive && m_samplesDone >= m_minSamples;
  const shared::PathTracingPush push{m_cursor,     count,        context.firstSample + m_samplesDone, m_passSamples,
                                     context.seed, m_maxBounces, m_rouletteStart, 0};
  const auto all = bindings(context, adaptive ? m_active : m_order);
  const double begin = nowSeconds();
  auto done = gpu::runNow(context.device, [&](vk::CommandRecorder& r) { record(r, all, push); });
  if (!done) return done;
  const double seconds = nowSeconds() - begin;
  m_rate.measured(uint64_t(count) * m_passSamples, seconds);
  m_traceSeconds += seconds;
  m_raysTraced = gpu::countedRays(m_counters);
  m_discarded = gpu::countedDiscards(m_counters);
  return {};
}

void PathTracing::record(vk::CommandRecorder& recorder, const std::vector<vk::Binding>& bindings,
                         shared::PathTracingPush push) const {
  if (m_sobol) return recordPathTracing(recorder, *m_trace, bindings, push, m_needs);
  for (const uint32_t end = push.firstSample + push.sampleCount; push.firstSample < end; ++push.firstSample)
    recordPathTracing(recorder, *m_trace, bindings, independentSample(push), m_needs);
}

Result<Progress> PathTracing::advance(const TechniqueContext& context, double seconds) {
  if (m_samplesDone >= sampleLimit(context)) m_converged = true;
  if (m_converged) return progress();
  if (!m_passOpen) {
    if (auto begun = beginPass(context); !begun) return begun.error();
    if (m_passPixels == 0) {
      m_converged = true;
      m_passOpen = false;
      return progress();
    }
  }
  uint64_t count = std::min<uint64_t>(m_rate.itemsIn(seconds) / m_passSamples + kWorkgroup, m_passPixels - m_cursor);
  if (m_pass == 0)  // never across a level: a coarse picture is shown as soon as it is whole
    for (const uint32_t end : m_pixelOrder.levelEnd)
      if (m_cursor < end) {
        count = std::min<uint64_t>(count, end - m_cursor);
        break;
      }
  if (auto done = dispatch(context, uint32_t(count)); !done) return done.error();
  m_cursor += uint32_t(count);
  if (m_cursor < m_passPixels) return progress();
  m_samplesDone += m_passSamples;
  ++m_pass;
  m_passOpen = false;
  Progress p = progress();
  p.passFinished = true;
  return p;
}

Progress PathTracing::progress() const {
  Progress p;
  p.passes = m_pass;
  p.samplesPerPixel = m_samplesDone;
  p.converged = m_converged;
  p.gatheredShare = m_pass > 0 ? 1.0 : m_passPixels ? double(m_cursor) / m_passPixels : 0.0;
  if (m_pass > 0) return p;
  p.fillStride = PixelOrder::kStrides[0];
  for (size_t i = 0; i < PixelOrder::kStrides.size(); ++i)
    if (m_cursor >= m_pixelOrder.levelEnd[i]) p.fillStride = PixelOrder::kStrides[i];
  return p;
}

double PathTracing::secondsToGrid(uint32_t stride) const {
  for (size_t i = 0; i < PixelOrder::kStrides.size(); ++i)
    if (PixelOrder::kStrides[i] == stride) return m_rate.secondsFor(m_pixelOrder.levelEnd[i]);
  return 0.0;
}

}  // namespace

const TechniqueInfo& pathTracingInfo() {
  static const TechniqueInfo kInfo{
      "path-tracing", "Path tracing", "Unbiased; converges to the truth, slowly where light arrives by rare paths.", false,
      {{"maxBounces", "Indirect bounces; 0 is direct light only", "bounces", ParameterType::integer, 0, 1024, 32, CostClass::regather},
       {"rouletteStart", "Bounces before Russian roulette may end a path", "bounces", ParameterType::integer, 1, 32, 3, CostClass::regather},
       {"adaptive", "Stop pixels that are done", "", ParameterType::boolean, 0, 1, 1, CostClass::regather},
       {"noiseThreshold", "Relative standard error at which a pixel is done", "1", ParameterType::real, 0.0005, 1, 0.01, CostClass::regather},
       {"minSamples", "Samples before a pixel may stop", "samples", ParameterType::integer, 4, 4096, 16, CostClass::regather},
       {"maxSamples", "Samples at which every pixel stops", "samples", ParameterType::integer, 1, 1048576, 4096, CostClass::regather},
       {"sobol", "Scrambled Sobol points; without them every sample is independent, to compare with", "", ParameterType::boolean, 0, 1, 1, CostClass::regather}}};
  return kInfo;
}

void recordPathTracing(vk::CommandRecorder& recorder, const gpu::Pass& pass, const std::vector<vk::Binding>& bindings,
                       shared::PathTracingPush push, const SceneNeeds& needs) {
  const uint32_t turns = (push.entryCount + kWorkgroup * kDealt - 1) / (kWorkgroup * kDealt);
  const uint32_t end = push.firstSample + push.sampleCount, most = needs.panes ? 2 : push.sampleCount;
  for (; push.firstSample < end; push.firstSample += push.sampleCount) {
    push.sampleCount = std::min(most, end - push.firstSample);
    pass.record(recorder, bindings, push, turns * kDealt);
    recorder.barrier();
  }
}

std::unique_ptr<Technique> makePathTracing() { return std::make_unique<PathTracing>(); }

}  // namespace limn
