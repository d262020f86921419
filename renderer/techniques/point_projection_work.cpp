#include "renderer/techniques/point_projection_impl.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/gather_shared.h"

namespace limn {
namespace {

/// A pixel of a preview projects one point of so many that one of a pass does.
constexpr uint32_t kPreviewProjections = 4;

constexpr uint32_t kWorkgroup = 64;  // of gather_sites.comp and point_projection_shade.comp

/// Points projected at a site of a bounce: what they miss is averaged over many sites.
constexpr uint32_t kBounceProjections = 3072;

uint32_t workgroups(uint32_t entries) { return (entries + kWorkgroup - 1) / kWorkgroup; }

}  // namespace

// One slot of every cluster an item.
Result<void> PointProjectionTechnique::relight(const TechniqueContext& context, SlotRange slots, uint32_t samples) {
  const PointLightContext lighting = lightContext(context);
  auto done = gpu::runNow(context.device, [&](vk::CommandRecorder& r) {
    m_light.recordRelight(r, lighting, {slots, samples, 0, context.seed});
    m_light.recordCompose(r, lighting, slots);
  });
  if (!m_lit) m_litSlots = std::max(m_litSlots, slots.end);
  m_work.slotsLit += slots.end - slots.first;
  return done;
}

// One slot of every cluster an item, both sides.
Result<void> PointProjectionTechnique::paths(const TechniqueContext& context, SlotRange slots, uint32_t samples, uint32_t samplesBefore) {
  const PointLightContext lighting = lightContext(context);
  m_work.pathSides += 2 * uint64_t(slots.end - slots.first) * m_points.clusterCount();
  return gpu::runNow(context.device, [&](vk::CommandRecorder& r) {
    m_light.recordPaths(r, lighting, {slots, samples, samplesBefore, bouncesAtPoints(), context.seed});
  });
}

Result<void> PointProjectionTechnique::sites(const TechniqueContext& context, uint32_t first, uint32_t count) {
  const shared::GatherSitesPush push{first, count, context.seed};
  const auto all = siteBindings(context);
  return gpu::runNow(context.device, [&](vk::CommandRecorder& r) { m_sites->record(r, all, push, workgroups(count)); });
}

shared::PointProjectionPush PointProjectionTechnique::gatherPush(const TechniqueContext& context, uint32_t first, uint32_t count) const {
  return {first, count, context.seed, m_round, m_settings.projections, m_points.clusterCount(), m_points.clusterSize(), slotsUsed(),
          float(m_points.areaPerPoint()), m_settings.microSize, m_settings.correctionRays};
}

Result<void> PointProjectionTechnique::gather(const TechniqueContext& context, uint32_t first, uint32_t count) {
  auto push = gatherPush(context, first, count);
  if (m_preview) push.correctionRays = 0;  // after a change of light most points that rays would find are dark yet
  if (m_preview && m_lit) push.projections = std::max(1u, push.projections / kPreviewProjections);
  const auto all = gatherBindings(context);
  m_work.pixelsGathered += count;
  return gpu::runNow(context.device, [&](vk::CommandRecorder& r) { m_gather.recordAtPixels(r, all, push); });
}

Result<void> PointProjectionTechnique::gatherAtPoints(const TechniqueContext& context, uint32_t first, uint32_t count) {
  auto push = gatherPush(context, first, count);
  push.projections = kBounceProjections;  // whatever pixels project: points stay lit when that is changed
  m_work.bounceSites += count;
  push.round = 0;
  push.clusterUsed = std::min(kBounceSlots, m_litSlots);
  const auto all = bounceBindings(context);
  return gpu::runNow(context.device, [&](vk::CommandRecorder& r) { m_gather.recordAtPoints(r, all, push); });
}

// Slots to spread to. Where bounces arrived at all points, there are none, and the points send on what they have.
Result<uint32_t> PointProjectionTechnique::beginSpread(const TechniqueContext& context, uint32_t endSlot, bool compose) {
  const uint32_t slots = endSlot - std::min(m_bounceSlots, endSlot);
  if (slots > 0 || !compose) return slots;
  const PointLightContext lighting = lightContext(context);
  auto done = gpu::runNow(context.device, [&](vk::CommandRecorder& r) { m_light.recordCompose(r, lighting, {0, endSlot}); });
  if (!done) return done.error();
  return 0u;
}

// Light that arrived at the sites of a bounce is spread over all points, which then send it on.
Result<void> PointProjectionTechnique::spread(const TechniqueContext& context, SlotRange slots, bool compose) {
  const PointLightContext lighting = lightContext(context);
  const auto grid = m_pointGrid.bindings();
  return gpu::runNow(context.device, [&](vk::CommandRecorder& r) {
    m_light.recordSpread(r, lighting, grid, slots);
    // With the first slots come those that they were spread from.
    if (compose) m_light.recordCompose(r, lighting, {slots.first == m_bounceSlots ? 0 : slots.first, slots.end});
  });
}

// Interpolates the grids of `stride`, half of it, and so on until that of `last`.
Result<void> PointProjectionTechnique::fill(const TechniqueContext& context, uint32_t stride, uint32_t last) {
  m_useFiltered = false;
  return gpu::runNow(context.device, [&](vk::CommandRecorder& r) {
    for (uint32_t s = stride; s >= std::max(last, 1u); s /= 2) m_reconstruct.recordInterpolate(r, reconstruction(), s);
  });
}

// `sample` is one of the pass.
Result<void> PointProjectionTechnique::shade(const TechniqueContext& context, uint32_t first, uint32_t count, uint32_t sample,
                                             bool firstOfFilm) {
  const uint32_t index = context.firstSample + m_samplesDone + sample;
  const shared::ShadePush push{first, count, index, context.seed, firstOfFilm, m_dropLookedUp && sample == 0, !gathers(), m_pass};
  const auto all = shadeBindings(context);
  auto done = gpu::runNow(context.device, [&](vk::CommandRecorder& r) { m_shade->record(r, all, push, workgroups(count)); });
  if (m_pass > 0) return done;
  m_shaded = std::max(m_shaded, first + count);
  for (size_t i = 0; i < PixelOrder::kStrides.size(); ++i)
    if (m_shaded >= m_pixelOrder.levelEnd[i]) m_fillStride = std::min(m_fillStride, PixelOrder::kStrides[i]);
  return done;
}

}  // namespace limn
