#include "tests/bench/projection_scene.hpp"

#include <numeric>

#include "renderer/gpu/camera.hpp"
#include "renderer/gpu/work_groups.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"

namespace limn::projection {
namespace {

constexpr uint32_t kClusters = 512, kSeed = 1;
constexpr uint32_t kShadowRays = 16;      // a point: the light that points carry is to be no noise of the figures
constexpr uint32_t kSlotsADispatch = 16;  // of every cluster
constexpr uint32_t kSitesGroup = 64;      // of gather_sites.comp

vk::BufferDesc described(const char* name, size_t bytes = 0) {
  vk::BufferDesc desc;
  desc.owner = "bench";
  desc.name = name;
  desc.size = bytes;
  return desc;
}

template <class T>
Result<vk::Buffer> bufferOf(vk::Device& device, const char* name, const std::vector<T>& values) {
  return vk::createBufferWith(device, described(name), std::span<const T>(values));
}

}  // namespace

Result<std::unique_ptr<LitScene>> LitScene::create(vk::Device& device, const Scene& scene, uint32_t width,
                                                   uint32_t height, uint32_t pointCount) {
  std::unique_ptr<LitScene> made(new LitScene(device, width, height));
  if (auto done = made->sync(scene); !done) return done.error();
  if (auto done = made->lightPoints(scene, pointCount); !done) return done.error();
  if (auto done = made->findSites(); !done) return done.error();
  return made;
}

Result<void> LitScene::sync(const Scene& scene) {
  m_needs = sceneNeeds(scene);
  ChangeSet everything;
  everything.everything = true;
  if (auto synced = m_mirror.sync(scene, everything); !synced) return synced.error();
  std::vector<TriangleBlock> blocks;
  for (size_t i = 0; i < m_mirror.blocks().size(); ++i)
    blocks.push_back({m_mirror.blocks()[i].corners, m_mirror.blocks()[i].firstTriangle, m_mirror.blockNeedsAlpha(i)});
  if (auto done = m_tracer.update(m_device, blocks, {}); !done) return done;
  const std::vector camera{gpu::cameraData(scene.view, m_mirror.renderOrigin(), m_width, m_height)};
  auto buffer = bufferOf(m_device, "camera", camera);
  if (!buffer) return buffer.error();
  m_camera = buffer.take();
  return {};
}

Result<void> LitScene::lightPoints(const Scene& scene, uint32_t pointCount) {
  auto updated = m_points.update(m_device, scene, m_mirror, pointCount, kClusters, kSeed);
  if (!updated) return updated.error();
  if (m_points.count() == 0) return Error{"unsupported", "the scene has no surfaces", scene.name};
  const PointLayout layout{m_points.clusterCount(), m_points.clusterSize()};
  if (auto done = m_light.resize(m_device, layout, hasGlossySources(scene)); !done) return done;
  const PointLightContext context{m_device, m_mirror, m_tracer, m_points.bindings()};
  if (auto done = m_light.prepare(context, m_needs, true); !done) return done;
  auto cleared = gpu::runNow(m_device, [&](vk::CommandRecorder& r) { m_light.recordClear(r); });
  for (uint32_t first = 0; cleared && first < layout.clusterSize; first += kSlotsADispatch) {
    const SlotRange slots{first, std::min(first + kSlotsADispatch, layout.clusterSize)};
    cleared = gpu::runNow(m_device, [&](vk::CommandRecorder& r) {
      m_light.recordRelight(r, context, {slots, kShadowRays, 0, kSeed});
      m_light.recordCompose(r, context, slots);
    });
  }
  return cleared;
}

Result<void> LitScene::findSites() {
  std::vector<uint32_t> order(size_t(m_width) * m_height);
  std::iota(order.begin(), order.end(), 0u);
  auto list = bufferOf(m_device, "list", order);
  auto sites = vk::Buffer::create(m_device, described("sites", order.size() * sizeof(shared::GatherSite)));
  if (!list || !sites) return list ? sites.error() : list.error();
  m_sites = sites.take();
  const auto all = gpu::joined(gpu::joined(m_mirror.bindings(), m_tracer.bindings()),
                               {vk::storage(BINDING_CAMERA, m_camera), vk::storage(BINDING_PIXEL_LIST, *list),
                                vk::storage(BINDING_G_BUFFER, m_sites)});
  auto constants = gpu::needsConstants(m_needs);
  constants.push_back(m_needs.sharp);  // kUseSharp
  auto pass = gpu::Pass::create(m_device, "gather_sites", all, sizeof(shared::GatherSitesPush), constants);
  if (!pass) return pass.error();
  const auto count = uint32_t(order.size());
  auto done = gpu::runNow(m_device, [&](vk::CommandRecorder& r) {
    pass->record(r, all, shared::GatherSitesPush{0, count, kSeed}, (count + kSitesGroup - 1) / kSitesGroup);
  });
  if (!done) return done;
  auto found = vk::readBackArray<shared::GatherSite>(m_device, m_sites, count);
  if (!found) return found.error();
  for (const shared::GatherSite& site : *found) m_visible.push_back(site.triangle != shared::kNoIndex);
  return {};
}

Result<void> LitScene::gather(const char* shader, const std::vector<uint32_t>& pixels, const vk::Binding& output,
                              const GatherVariant& variant, uint32_t projections) const {
  auto list = bufferOf(m_device, "pixels", pixels);
  if (!list) return list.error();
  auto all = gpu::joined(gpu::joined(m_mirror.bindings(), m_points.bindings()), m_light.bindings());
  all = gpu::joined(std::move(all), {vk::storage(BINDING_CAMERA, m_camera), vk::storage(BINDING_PIXEL_LIST, *list),
                                     vk::storage(BINDING_G_BUFFER, m_sites), output});
  shared::PointProjectionPush push{};
  push.entryCount = uint32_t(pixels.size());
  push.seed = kSeed;
  push.projections = projections;
  push.clusterCount = m_points.clusterCount();
  push.clusterSize = push.clusterUsed = m_points.clusterSize();
  push.areaPerPoint = float(m_points.areaPerPoint());
  push.microSize = kMicroSide;
  const auto constants = gatherConstants(m_needs, m_light.hasLobes(), variant);
  auto pass = gpu::Pass::create(m_device, shader, all, sizeof(push), constants);
  if (!pass) return pass.error();
  const gpu::WorkGroups groups = gpu::groupsInRows(push.entryCount);
  return gpu::runNow(m_device, [&](vk::CommandRecorder& r) { pass->record(r, all, push, groups.x, groups.y); });
}

Result<std::vector<glm::vec4>> LitScene::microBuffers(const std::vector<uint32_t>& pixels, const GatherVariant& variant,
                                                      uint32_t projections) const {
  const size_t count = pixels.size() * kMicroSide * kMicroSide;
  auto out = vk::Buffer::create(m_device, described("microBuffers", count * sizeof(glm::vec4)));
  if (!out) return out.error();
  const auto output = vk::storage(BINDING_OUTPUT, *out);
  if (auto done = gather("gather_micro_buffers", pixels, output, variant, projections); !done) return done.error();
  return vk::readBackArray<glm::vec4>(m_device, *out, count);
}

Result<std::vector<glm::vec3>> LitScene::diffuseLight(const std::vector<uint32_t>& pixels, const GatherVariant& variant,
                                                      uint32_t projections) const {
  const size_t count = size_t(m_width) * m_height;
  auto out = vk::Buffer::create(m_device, described("indirect", count * sizeof(shared::IndirectTexel)));
  if (!out) return out.error();
  const auto output = vk::storage(BINDING_INDIRECT, *out);
  if (auto done = gather("gather_pixels", pixels, output, variant, projections); !done) return done.error();
  auto texels = vk::readBackArray<shared::IndirectTexel>(m_device, *out, count);
  if (!texels) return texels.error();
  std::vector<glm::vec3> light;
  for (const uint32_t pixel : pixels) light.push_back((*texels)[pixel].diffuse);
  return light;
}

}  // namespace limn::projection
