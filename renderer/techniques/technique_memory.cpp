#include "renderer/techniques/technique_memory.hpp"

#include <algorithm>
#include <bit>

#include "renderer/base/check.hpp"
#include "renderer/cache/point_light.hpp"
#include "renderer/techniques/audit.hpp"
#include "renderer/techniques/parameter_default.hpp"
#include "renderer/techniques/path_tracing.hpp"
#include "renderer/techniques/point_projection_impl.hpp"
#include "shaders/shared/film_shared.h"
#include "shaders/shared/gather_shared.h"
#include "shaders/shared/placement_shared.h"
#include "shaders/shared/point_grid_shared.h"
#include "shaders/shared/point_shared.h"

namespace limn {
namespace {

constexpr uint64_t kWord = sizeof(uint32_t);
constexpr uint64_t kCounterBytes = shared::kCounterWords * kWord;
constexpr uint32_t kTile = 16;              // [pixel] side of what the error is summed over
constexpr uint64_t kFilmPlanes = 5;

double valueOf(const TechniqueInfo& info, const std::string& name, const PictureSettings& settings) {
  double value = defaultOf(info, name);
  for (const auto& [given, number] : settings.parameters)
    if (given == name) value = number;
  return value;
}

// A film of the pixels it keeps samples of, which they are, and what is made of them.
void addAudit(vk::MemoryUse& device, uint32_t width, uint32_t height) {
  const uint64_t entries = auditEntries(width, height);
  device.add("film", kFilmPlanes * entries * sizeof(glm::vec4));
  device.add("audit", entries * (sizeof(shared::AuditRecord) + kWord) + kCounterBytes);
}

// The order of all pixels, and the list of the active ones.
void addPathTracing(vk::MemoryUse& device, uint64_t pixels) {
  device.add("path-tracing", 2 * pixels * kWord + kCounterBytes);
}

/// Points of a scene with the settings' numbers, in clusters; one of one where no surface has an area.
PointLayout pointLayout(std::span<const BlockSize> blocks, const PictureSettings& settings) {
  const bool any = std::any_of(blocks.begin(), blocks.end(), [](const BlockSize& b) { return b.solidTriangles > 0; });
  if (!any) return {1, 1};
  const TechniqueInfo& info = pointProjectionInfo();
  const uint32_t clusters = std::bit_floor(uint32_t(valueOf(info, "clusters", settings)));
  return {clusters, (uint32_t(valueOf(info, "points", settings)) + clusters - 1) / clusters};
}

// Over the first slots of every cluster.
uint64_t pointGridBytes(const PointLayout& layout, uint32_t slots) {
  const uint64_t inGrid = uint64_t(layout.clusterCount) * slots;
  return (shared::kPointGridInfoWords + std::bit_ceil(std::max<uint64_t>(inGrid, 8)) + 1 + inGrid) * kWord;
}

void addPoints(vk::MemoryUse& device, const PointLayout& layout, uint32_t bouncePoints, bool lobes, bool refines) {
  const uint64_t points = layout.count();
  const uint32_t bounceSlots = std::min(std::max(1u, bouncePoints / layout.clusterCount), layout.clusterSize);
  const uint64_t inGrid = uint64_t(layout.clusterCount) * bounceSlots;
  device.add("surface-points", points * (sizeof(shared::SurfacePoint) + sizeof(shared::PointSite)) +
                                   pointGridBytes(layout, bounceSlots) +
                                   pointGridBytes(layout, std::min(kBounceSlots, layout.clusterSize)));
  const uint64_t light = points * (sizeof(shared::PointLight) + 2 * sizeof(glm::vec4)) + (lobes ? points : 1) * sizeof(shared::PointLobes);
  device.add("point-light", (refines ? 2 : 1) * light + kCounterBytes);
  device.add("point-projection", 2 * inGrid * kWord);  // both sides of those that gather bounces
}

void addPointProjection(vk::MemoryUse& device, const Scene& scene, std::span<const BlockSize> blocks,
                        const PictureSettings& settings) {
  const uint64_t pixels = uint64_t(settings.width) * settings.height;
  // Order and list of the pixels, what they see, gathered light as it is and filtered, and light that was looked up.
  const uint64_t ofPixel =
      2 * kWord + sizeof(shared::GatherSite) + 2 * sizeof(shared::IndirectTexel) + sizeof(glm::vec4);
  device.add("point-projection", pixels * ofPixel + kCounterBytes);
  const auto bouncePoints = uint32_t(valueOf(pointProjectionInfo(), "bouncePoints", settings));
  const bool refines = valueOf(pointProjectionInfo(), "paths", settings) > 0.0 && valueOf(pointProjectionInfo(), "bounces", settings) > 0.0;
  addPoints(device, pointLayout(blocks, settings), bouncePoints, settings.allNeeds || hasGlossySources(scene), refines);
  const uint64_t side = std::bit_ceil(std::max<uint64_t>({settings.width, settings.height, 2}));
  const uint64_t groups = (side * side + shared::kPlacementGroup - 1) / shared::kPlacementGroup;
  device.add("placement", (2 * groups + 2) * kWord);
  addAudit(device, settings.width, settings.height);
}

}  // namespace

void addFilmMemory(vk::MemoryUse& device, uint32_t width, uint32_t height) {
  const uint64_t pixels = uint64_t(width) * height;
  const uint64_t tiles = uint64_t((width + kTile - 1) / kTile) * ((height + kTile - 1) / kTile);
  const uint64_t statistics = tiles * (sizeof(shared::TileError) + kWord) + kWord + shared::kErrorBins * kWord;
  const uint64_t display = pixels * kWord + sizeof(shared::IndirectTexel);
  device.add("film", kFilmPlanes * pixels * sizeof(glm::vec4) + statistics + display);
}

void addTechniqueMemory(vk::MemoryUse& device, const Scene& scene, std::span<const BlockSize> blocks,
                        const PictureSettings& settings) {
  if (settings.technique == pathTracingInfo().name)
    return addPathTracing(device, uint64_t(settings.width) * settings.height);
  LIMN_CHECK(settings.technique == pointProjectionInfo().name);
  addPointProjection(device, scene, blocks, settings);
}

}  // namespace limn
