#include <bit>

#include "renderer/base/hash.hpp"
#include "renderer/techniques/point_projection_impl.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"

namespace limn {
namespace {

/// Slots of every cluster that the first picture after a change of light is made of.
constexpr uint32_t kPreviewSlots = 32, kPreviewPaths = 1;
/// Paths of a point whose light is refined, of one whose light is not.
constexpr uint32_t kRefinedPaths = 4;
/// A later pass gathers at one pixel of so many, of a level at no fewer than these: a few times as long as its samples of direct
/// light take, since interpolated light is what is wrong longest where a scene is intricate.
constexpr uint32_t kPixelsPerGather = 64, kLeastLevelGathers = 256;
/// Coherence that tells different objects apart: thresholds that begin below stay there, so that edges are gathered at
/// every level.
constexpr float kObjectEdge = 0.9f;
/// Radiance differences count against this many times the mean. The metric is written for display values, whose mean is about a
/// fifth, and for gathers without noise; with a smaller factor noise is gathered, at twice the cost and no less error. [IPP §3.3]
constexpr float kDisplayRange = 16.0f;

}  // namespace

// A picture that is shown early, from gathers with few projections and no rays, and after a change of light from a first part of
// the points and before all light is there. It is replaced: no bit of it stays, so that pass 0 is the same without it.
void PointProjectionTechnique::planPreview() {
  m_preview = m_dropLookedUp = true;
  if (!m_lit) pushPreviewLight();
  pushCoarsePicture();
  if (m_lit) return;
  pushSites(startEnd(), uint32_t(m_pixelOrder.pixels.size()));
  pushFill(PixelOrder::kStrides[0] / 2);
  pushShade(uint32_t(m_pixelOrder.pixels.size()), true);
}

void PointProjectionTechnique::pushPreviewLight() {
  const uint32_t slots = std::min(kPreviewSlots, m_light.layout().clusterSize);
  if (!m_previewLit) pushRelight(m_tasks, {0, slots}, 1, m_previewRate);
  if (!m_previewLit && bouncesAtPoints() > 0 && m_settings.paths > 0) pushPaths(m_tasks, kPreviewPaths, 0, slots);
  m_tasks.push({"preview lit", nullptr, [this](const TechniqueContext&) -> Result<uint32_t> {
                  m_previewLit = true;
                  if (m_lighting.empty()) planLighting();
                  return 0u;
                }, {}});
}

// Pass 0 gathers a coarse grid. After a few that gather nothing, one gathers it again by refined light, and others refine to every
// 4th, 2nd and each pixel, a part of a level each; then what was interpolated is gathered, share by share, and then every pixel
// again. All take a sample of direct light.
void PointProjectionTechnique::planPass(uint32_t pass) {
  const auto pixels = uint32_t(m_pixelOrder.pixels.size());
  // Light that was looked up before counts for less when a level is complete, and each time that the number of samples has
  // doubled: most of them always know what the latest gathers know.
  m_dropLookedUp = pass == 0 || std::has_single_bit(pass);
  if (pass >= kRefinedPass && refines()) m_light.select(PointLightVersion::refined);
  if (!gathers()) return pushShade(pixels, pass == 0);
  if (pass == 0) {
    pushCoarsePicture();
    pushSites(startEnd(), pixels);
    pushLevels();
  } else if (pass == kRefinedPass && refines()) {
    m_dropLookedUp = true;
    pushForget();
    pushStartGrid();
    pushFill(m_settings.startGrid / 2, PixelOrder::kStrides[0]);
    pushLevels();
  } else if (pass >= kRefinedPass && m_levelStride > 0) {
    pushLevelPart();
  } else if (pass >= kRefinedPass) {
    pushLateShare(m_lateTurn++);
    pushFilter();
  }
  pushShade(pixels, pass == 0);
}

// A picture of every 8th pixel, as soon as the start grid is gathered.
void PointProjectionTechnique::pushCoarsePicture() {
  pushSites(0, startEnd());
  pushStartGrid();
  pushFill(m_settings.startGrid / 2, PixelOrder::kStrides[0]);
  pushShade(m_pixelOrder.levelEnd[0], true);
}

// Pixels of the order of which every 8th and the start grid, which may be finer, are the first.
uint32_t PointProjectionTechnique::startEnd() const {
  size_t level = 0;
  while (PixelOrder::kStrides[level] > m_settings.startGrid) ++level;
  return m_pixelOrder.levelEnd[level];
}

void PointProjectionTechnique::pushStartGrid() {
  pushGather("start grid", [this](const TechniqueContext& c) {
    m_round = 0;
    return m_grid.selectGrid(c.device, placement(), m_settings.startGrid);
  });
  m_tasks.push({"coherence scale", nullptr, [this](const TechniqueContext& c) -> Result<uint32_t> {
                  auto mean = m_grid.meanLuminance(c.device, placement(), m_settings.startGrid);
                  if (!mean) return mean.error();
                  m_meanLuminance = float(*mean);
                  return 0u;
                }, {}});
}

// What the gathers so far brought, when better ones follow.
void PointProjectionTechnique::pushForget() {
  m_tasks.push({"forget", nullptr, [this](const TechniqueContext& c) -> Result<uint32_t> {
                  auto done = gpu::runNow(c.device, [&](vk::CommandRecorder& r) { r.fillBuffer(m_indirect, 0, 0, 0); });
                  if (!done) return done.error();
                  return 0u;
                }, {}});
}

// Every 8th pixel, or fewer, where light is not coherent; the others are filled.
void PointProjectionTechnique::pushLevels() {
  for (uint32_t stride = m_settings.startGrid / 2; stride >= PixelOrder::kStrides[0]; stride /= 2) pushLevel(stride);
  pushFill(PixelOrder::kStrides[0] / 2);
  m_levelStride = std::min(m_settings.startGrid / 2, PixelOrder::kStrides[1]);
}

// The last bounce arrives at the pixels; the points need it only where rays through sharp lobes end at them.
uint32_t PointProjectionTechnique::bouncesAtPoints() const {
  return m_needs.sharp ? m_settings.bounces : std::max(m_settings.bounces, 1u) - 1u;
}

// Light of the first points: direct, then what paths find at some of them, spread over the others.
void PointProjectionTechnique::planLighting() {
  const uint32_t size = m_light.layout().clusterSize, first = refines() ? std::min(kBounceSlots, size) : size;
  pushRelight(m_lighting, {0, first}, m_settings.relightSamples, m_relightRate);
  if (m_settings.paths == 0) return planBounces();
  if (bouncesAtPoints() > 0) pushPaths(m_lighting, m_settings.paths, 0, first);
}

// Light of all points, and more paths where there were some. The first light is kept: the first passes after a new view are to be
// the same as they were.
void PointProjectionTechnique::planRefining() {
  const uint32_t size = m_light.layout().clusterSize;
  m_refining.push({"refine", nullptr, [this](const TechniqueContext& c) -> Result<uint32_t> {
                     auto done = gpu::runNow(c.device, [&](vk::CommandRecorder& r) { m_light.recordCopy(r); });
                     if (!done) return done.error();
                     return 0u;
                   }, {}});
  pushRelight(m_refining, {std::min(kBounceSlots, size), size}, m_settings.relightSamples, m_relightRate);
  const uint32_t paths = m_settings.paths;
  if (bouncesAtPoints() > 0) pushPaths(m_refining, (kRefinedPaths - 1) * paths, paths, size);
}

// As in the paper: one bounce after the other, gathered at points as it is at pixels.
void PointProjectionTechnique::planBounces() {
  const uint32_t size = m_light.layout().clusterSize;
  for (uint32_t bounce = 0; bounce < bouncesAtPoints(); ++bounce) {
    // Pixels project all points with all bounces but the last; earlier bounces reach only the points that the next one projects.
    const bool seen = bounce + 2 >= m_settings.bounces;
    pushBounce(seen ? size : std::min(kBounceSlots, size), bounce + 1 < m_settings.bounces);
  }
}

void PointProjectionTechnique::pushRelight(TaskQueue& queue, SlotRange slots, uint32_t samples, WorkRate& rate) {
  queue.push({"relight", &rate, [slots](const TechniqueContext&) -> Result<uint32_t> { return slots.end - slots.first; },
              [this, slots, samples](const TechniqueContext& c, uint32_t first, uint32_t count) {
                return relight(c, {slots.first + first, slots.first + first + count}, samples);
              }});
}

void PointProjectionTechnique::pushPaths(TaskQueue& queue, uint32_t samples, uint32_t samplesBefore, uint32_t endSlot) {
  queue.push({"paths", &m_pathRate, [this](const TechniqueContext&) -> Result<uint32_t> { return m_bounceSlots; },
              [this, samples, samplesBefore](const TechniqueContext& c, uint32_t first, uint32_t count) {
                return paths(c, {first, first + count}, samples, samplesBefore);
              }});
  pushSpread(queue, endSlot, true);
}

void PointProjectionTechnique::pushBounce(uint32_t endSlot, bool compose) {
  m_lighting.push({"bounce", &m_bounceRate, [this](const TechniqueContext&) -> Result<uint32_t> { return m_bounceSideCount; },
                [this](const TechniqueContext& c, uint32_t from, uint32_t count) { return gatherAtPoints(c, from, count); }, 32});
  pushSpread(m_lighting, endSlot, compose);
}

void PointProjectionTechnique::pushSpread(TaskQueue& queue, uint32_t endSlot, bool compose) {
  queue.push({"spread", &m_spreadRate,
              [this, endSlot, compose](const TechniqueContext& c) { return beginSpread(c, endSlot, compose); },
              [this, compose](const TechniqueContext& c, uint32_t from, uint32_t count) {
                return spread(c, {m_bounceSlots + from, m_bounceSlots + from + count}, compose);
              }});
}

void PointProjectionTechnique::pushSites(uint32_t from, uint32_t end) {
  m_tasks.push({"sites", &m_siteRate, [from, end](const TechniqueContext&) -> Result<uint32_t> { return end - from; },
                [this, from](const TechniqueContext& c, uint32_t first, uint32_t count) { return sites(c, from + first, count); }, 256});
}

void PointProjectionTechnique::pushGather(const char* name, Task::Begin select) {
  m_listFirst = 0;
  m_tasks.push({name, m_preview ? &m_previewGatherRate : &m_gatherRate, std::move(select),
                [this](const TechniqueContext& c, uint32_t first, uint32_t count) { return gather(c, m_listFirst + first, count); }, 32});
}

Result<uint32_t> PointProjectionTechnique::selectLevel(const TechniqueContext& context, uint32_t stride) {
  m_round = 0;
  float threshold = m_settings.threshold;
  for (uint32_t s = m_settings.startGrid / 2; s > stride; s /= 2) threshold *= 2.0f;
  if (m_settings.threshold < kObjectEdge) threshold = std::min(threshold, kObjectEdge);
  const CoherenceRule rule{threshold, m_settings.lambda, float(context.scene.radius()), kDisplayRange * m_meanLuminance};
  return m_grid.selectIncoherent(context.device, placement(), stride, rule);
}

void PointProjectionTechnique::pushLevel(uint32_t stride) {
  pushGather("level", [this, stride](const TechniqueContext& c) { return selectLevel(c, stride); });
  pushFill(stride, stride);
}

// The next gathers of the level of m_levelStride; with the last of them it is filled and the next level's turn comes.
void PointProjectionTechnique::pushLevelPart() {
  pushGather("level", [this](const TechniqueContext& c) -> Result<uint32_t> {
    if (m_levelDone == m_levelCount) {
      auto selected = selectLevel(c, m_levelStride);
      if (!selected) return selected.error();
      m_levelCount = *selected;
      m_levelDone = 0;
    }
    m_listFirst = m_levelDone;
    const uint32_t part = std::max(m_width * m_height / kPixelsPerGather, kLeastLevelGathers);
    m_levelDone += std::min(part, m_levelCount - m_levelDone);
    return m_levelDone - m_listFirst;
  });
  m_tasks.push({"interpolate", nullptr, [this](const TechniqueContext& c) -> Result<uint32_t> {
                  if (m_levelDone < m_levelCount) return 0u;
                  m_dropLookedUp = true;
                  const uint32_t stride = m_levelStride;
                  m_levelStride /= 2;
                  if (auto done = fill(c, stride, 1); !done) return done.error();
                  return 0u;
                }, {}});
}

void PointProjectionTechnique::pushLateShare(uint32_t turn) {
  pushGather("remaining", [this, turn](const TechniqueContext& c) {
    m_round = turn / kPixelsPerGather;
    const uint32_t share = (m_grid.scatteredCount() + kPixelsPerGather - 1) / kPixelsPerGather;
    return m_grid.selectScattered(c.device, placement(), turn % kPixelsPerGather * share, share, m_round == 0);
  });
}

void PointProjectionTechnique::pushFill(uint32_t stride, uint32_t last) {
  m_tasks.push({"interpolate", nullptr, [this, stride, last](const TechniqueContext& c) -> Result<uint32_t> {
                  if (auto done = fill(c, stride, last); !done) return done.error();
                  return 0u;
                }, {}});
}

void PointProjectionTechnique::pushFilter() {
  if (m_settings.filterSize < 3) return;
  m_tasks.push({"filter", &m_filterRate,
                [this](const TechniqueContext&) -> Result<uint32_t> {
                  m_dropLookedUp = m_dropLookedUp || !m_useFiltered;
                  m_useFiltered = true;
                  return m_height;
                },
                [this](const TechniqueContext& c, uint32_t first, uint32_t count) {
                  return gpu::runNow(c.device, [&](vk::CommandRecorder& r) {
                    m_reconstruct.recordFilter(r, reconstruction(), m_settings.filterSize, {first, count});
                  });
                }, 4});
}

// Samples of direct light, one after the other.
void PointProjectionTechnique::pushShade(uint32_t end, bool firstOfFilm) {
  for (uint32_t sample = 0; sample < m_passSamples; ++sample)
    m_tasks.push({"shade", &m_shadeRate, [end](const TechniqueContext&) -> Result<uint32_t> { return end; },
                  [this, sample, firstOfFilm](const TechniqueContext& c, uint32_t first, uint32_t count) {
                    return shade(c, first, count, sample, firstOfFilm);
                  }, 256});
}

}  // namespace limn
