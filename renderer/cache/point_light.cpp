#include "renderer/cache/point_light.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/gpu/ray_counters.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/point_shared.h"
#include "shaders/shared/relight_shared.h"

namespace limn {
namespace {

constexpr uint32_t kWorkgroup = 64;    // of the shaders
constexpr size_t kLobesConstant = 16;  // constant_id of kUseLobes in the shaders
constexpr uint32_t kSampledLobes = 1;  // lobes left to lights that own none

uint32_t workgroups(uint32_t invocations) { return (invocations + kWorkgroup - 1) / kWorkgroup; }

bool isGlossySource(const Material& m) {
  if (m.unlit) return false;
  if (m.metallic > 0.0f) return true;  // textures and base colours decide point by point
  const float r = (m.ior - 1.0f) / (m.ior + 1.0f);
  const float tint = std::max({m.specularColor.r, m.specularColor.g, m.specularColor.b});
  return std::min(r * r * tint, 1.0f) * m.specular >= shared::kLobeReflectance;
}

/// Of so many that a dispatch may take where a shadow ray is one ray.
uint32_t samplesAtOnce(uint32_t most, bool panes) { return panes ? std::max(most / 4, 1u) : most; }

bool isPunctual(const shared::LightData& light) { return light.type <= shared::kLightDirectional; }

/// Lights that own a lobe each: the punctual ones, which head the table. Where others are left, one lobe is theirs.
uint32_t lobeLights(const std::vector<shared::LightData>& lights) {
  const auto punctual = uint32_t(std::find_if_not(lights.begin(), lights.end(), isPunctual) - lights.begin());
  if (punctual == lights.size() && punctual <= shared::kLobesPerPoint) return punctual;
  return std::min(punctual, shared::kLobesPerPoint - kSampledLobes);
}

std::vector<uint32_t> constants(const SceneNeeds& needs) {
  std::vector<uint32_t> words = gpu::needsConstants(needs);
  LIMN_CHECK_LE(words.size(), kLobesConstant);
  words.resize(kLobesConstant);
  words.push_back(needs.glossy);
  return words;
}

Result<vk::Buffer> makeBuffer(vk::Device& device, const char* name, size_t size, bool texels = false) {
  vk::BufferDesc desc;
  desc.owner = "point-light";
  desc.name = name;
  desc.size = size;
  if (texels) {
    desc.usage = vk::BufferUsage::storage | vk::BufferUsage::texel;
    desc.texelFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  }
  return vk::Buffer::create(device, desc);
}

}  // namespace

bool hasGlossySources(const Scene& scene) {
  const auto isSource = [&](const Primitive& p) {
    return !p.indices.empty() && isGlossySource(p.material == kNone ? Material{} : scene.materials[size_t(p.material)]);
  };
  return std::any_of(scene.nodes.begin(), scene.nodes.end(), [&](const Node& node) {
    if (node.mesh == kNone) return false;
    const std::vector<Primitive>& primitives = scene.meshes[size_t(node.mesh)].primitives;
    return std::any_of(primitives.begin(), primitives.end(), isSource);
  });
}

PointLightCache::PointLightCache()
    : m_relight("relight_points", sizeof(shared::RelightPush), &constants),
      m_paths("trace_points", sizeof(shared::TracePointsPush), &constants),
      m_compose("compose_points", sizeof(shared::ComposePush), &constants) {}

Result<PointLightCache::Buffers> PointLightCache::makeBuffers(vk::Device& device, size_t points, size_t lobes) {
  auto light = makeBuffer(device, "points.light", points * sizeof(shared::PointLight));
  if (!light) return light.error();
  auto radiance = makeBuffer(device, "points.radiance", points * 2 * sizeof(glm::vec4), true);
  if (!radiance) return radiance.error();
  auto kept = makeBuffer(device, "points.lobes", lobes * sizeof(shared::PointLobes));
  if (!kept) return kept.error();
  return Buffers{light.take(), radiance.take(), kept.take()};
}

Result<void> PointLightCache::resize(vk::Device& device, PointLayout layout, bool lobes, bool refined) {
  if (!m_counters) {
    auto counters = gpu::makeRayCounters(device, "point-light", "points.counters");
    if (!counters) return counters.error();
    m_counters = counters.take();
  }
  if (light() && layout == m_layout && lobes == m_lobesKept && refined == m_refinedKept) return {};
  const size_t count = std::max<size_t>(layout.count(), 1);
  std::array<Buffers, 2> buffers;
  for (size_t version = 0; version < (refined ? 2 : 1); ++version) {
    auto made = makeBuffers(device, count, lobes ? count : 1);
    if (!made) return made.error();
    buffers[version] = made.take();
  }
  m_buffers = std::move(buffers);
  m_layout = layout;
  m_lobesKept = lobes;
  m_refinedKept = refined;
  select(PointLightVersion::first);
  return {};
}

void PointLightCache::select(PointLightVersion version) {
  LIMN_CHECK(version == PointLightVersion::first || m_refinedKept);
  m_selected = version;
}

void PointLightCache::recordCopy(vk::CommandRecorder& recorder) const {
  LIMN_CHECK(m_refinedKept);
  for (const auto buffer : {&Buffers::light, &Buffers::radiance, &Buffers::lobes}) {
    const vk::Buffer& first = m_buffers[0].*buffer;
    recorder.copyBuffer(first, 0, m_buffers[1].*buffer, 0, first.size());
  }
  recorder.barrier();
}

std::vector<vk::Binding> PointLightCache::relightBindings(const PointLightContext& context) const {
  auto all = gpu::joined(gpu::joined(context.scene.bindings(), context.points), context.tracer.bindings());
  return gpu::joined(std::move(all),
                     {vk::storage(BINDING_POINT_LIGHT, light()), vk::storage(BINDING_POINT_LOBES, lobes()),
                      vk::storage(BINDING_COUNTERS, m_counters)});
}

std::vector<vk::Binding> PointLightCache::composeBindings(const PointLightContext& context) const {
  auto all = gpu::joined(context.scene.bindings(), context.points);
  return gpu::joined(std::move(all),
                     {vk::storage(BINDING_POINT_LIGHT, light()), vk::storage(BINDING_POINT_LOBES, lobes()),
                      vk::storage(BINDING_POINT_RADIANCE_OUT, radiance())});
}

Result<void> PointLightCache::prepare(const PointLightContext& context, const SceneNeeds& needs, bool mayCompile) {
  LIMN_CHECK(bool(light()));
  if (auto done = m_relight.prepare(context.device, relightBindings(context), needs, mayCompile); !done) return done;
  if (auto done = m_paths.prepare(context.device, relightBindings(context), needs, mayCompile); !done) return done;
  return m_compose.prepare(context.device, composeBindings(context), needs, mayCompile);
}

std::vector<vk::Binding> PointLightCache::spreadBindings(const PointLightContext& context,
                                                         const std::vector<vk::Binding>& grid) const {
  return gpu::joined(gpu::joined(context.points, grid), {vk::storage(BINDING_POINT_LIGHT, light())});
}

Result<void> PointLightCache::prepareSpread(const PointLightContext& context, const std::vector<vk::Binding>& grid) {
  if (m_spread) return {};
  const auto all = spreadBindings(context, grid);
  auto pass = gpu::Pass::create(context.device, "spread_points", all, sizeof(shared::SpreadPush));
  if (!pass) return pass.error();
  m_spread = pass.take();
  return gpu::runNow(context.device, [&](vk::CommandRecorder& r) { m_spread.warmUp(r, all); });
}

void PointLightCache::recordClear(vk::CommandRecorder& recorder) const {
  for (const vk::Buffer* buffer : {&light(), &radiance(), &lobes()}) recorder.fillBuffer(*buffer, 0, 0, 0);
  recorder.barrier();
}

uint32_t PointLightCache::slotsOf(SlotRange slots) const {
  LIMN_CHECK(slots.first <= slots.end && slots.end <= m_layout.clusterSize);
  return slots.end - slots.first;
}

void PointLightCache::recordRelight(vk::CommandRecorder& recorder, const PointLightContext& context,
                                    const RelightWork& work) const {
  const uint32_t slotCount = slotsOf(work.slots);
  const uint32_t owners = m_lobesKept ? lobeLights(context.scene.lights()) : 0;
  const auto all = relightBindings(context);
  for (uint32_t done = 0; done < work.samples && slotCount > 0;) {
    const uint32_t samples = std::min(work.samples - done, samplesAtOnce(shared::kRelightSamplesMost, context.panes));
    const shared::RelightPush push{work.slots.first,
                                   slotCount,
                                   m_layout.clusterCount,
                                   m_layout.clusterSize,
                                   samples,
                                   work.samplesBefore + done,
                                   work.seed,
                                   m_lobesKept && done == 0,  // what is left over is too little to fill them again
                                   owners};
    m_relight->record(recorder, all, push, workgroups(slotCount * m_layout.clusterCount));
    recorder.barrier();
    done += samples;
  }
}

void PointLightCache::recordPaths(vk::CommandRecorder& recorder, const PointLightContext& context, const PathWork& work) const {
  const uint32_t slotCount = slotsOf(work.slots);
  const auto all = relightBindings(context);
  for (uint32_t done = 0; done < work.samples && slotCount > 0;) {
    const uint32_t samples = std::min(work.samples - done, samplesAtOnce(shared::kPathsMost, context.panes));
    const shared::TracePointsPush push{work.slots.first, slotCount, m_layout.clusterCount, m_layout.clusterSize,
                                       samples, work.samplesBefore + done, work.seed, work.bounces};
    m_paths->record(recorder, all, push, workgroups(2 * slotCount * m_layout.clusterCount));
    recorder.barrier();
    done += samples;
  }
}

void PointLightCache::recordCompose(vk::CommandRecorder& recorder, const PointLightContext& context,
                                    SlotRange slots) const {
  const uint32_t slotCount = slotsOf(slots);
  if (slotCount == 0) return;
  const shared::ComposePush push{slots.first, slotCount, m_layout.clusterCount, m_layout.clusterSize, m_lobesKept};
  m_compose->record(recorder, composeBindings(context), push, workgroups(slotCount * m_layout.clusterCount));
  recorder.barrier();
}

void PointLightCache::recordSpread(vk::CommandRecorder& recorder, const PointLightContext& context,
                                   const std::vector<vk::Binding>& grid, SlotRange slots) const {
  const uint32_t slotCount = slotsOf(slots);
  if (slotCount == 0) return;
  LIMN_CHECK(bool(m_spread));  // prepareSpread() comes first
  const shared::SpreadPush push{slots.first, slotCount, m_layout.clusterCount, m_layout.clusterSize};
  m_spread.record(recorder, spreadBindings(context, grid), push, workgroups(slotCount * m_layout.clusterCount));
  recorder.barrier();
}

std::vector<vk::Binding> PointLightCache::bindings() const {
  return {vk::storage(BINDING_POINT_LIGHT, light()), vk::texel(BINDING_POINT_RADIANCE, radiance()),
          vk::storage(BINDING_POINT_LOBES, lobes())};
}

uint64_t PointLightCache::raysTraced() const { return m_counters ? gpu::countedRays(m_counters) : 0; }

uint64_t PointLightCache::discardedSamples() const { return m_counters ? gpu::countedDiscards(m_counters) : 0; }

}  // namespace limn
