#pragma once
#include <map>
#include <memory>
#include <tuple>

#include "renderer/gather/point_projection.hpp"
#include "renderer/gpu/device_scene.hpp"
#include "renderer/gpu/work_groups.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/scene_shared.h"
#include "tests/gpu/gather_points.hpp"
#include "tests/gpu/kernel.hpp"
#include "tests/support/scene_builder.hpp"

namespace limn::test {

/// Gathers at sites on made-up points. Sites lie on horizontal squares that face up, seen from straight above.
class Gatherer {
 public:
  Gatherer(const std::vector<LitPoint>& points, uint32_t clusters, double area, float scale = 1.0f)
      : Gatherer(points, clusters, area, scale, {}, {}) {}

  /// `material` is that of the sites; without one they are diffuse. `lobes` are of the points, or none.
  Gatherer(const std::vector<LitPoint>& points, uint32_t clusters, double area, float scale, const Material* material,
           const std::vector<shared::PointLobes>& lobes)
      : m_mirror(device()), m_glossy(material != nullptr), m_lobes(!lobes.empty()) {
    SceneBuilder b;
    const float s = scale;
    b.quad(material ? b.material(*material) : b.diffuse(glm::vec3(0.5f)), {-s, 0, s}, {s, 0, s}, {s, 0, -s}, {-s, 0, -s});
    ChangeSet everything;
    everything.everything = true;
    must(m_mirror.sync(b.scene, everything));
    const std::vector<LitPoint> ordered = clusterMajor(points, clusters);
    m_points = texels(pointWords(ordered), VK_FORMAT_R32G32B32A32_UINT);
    m_radiance = texels(radianceWords(ordered, m_lobes ? 1.0f : 0.0f), VK_FORMAT_R32G32B32A32_SFLOAT);
    m_lobeBuffer = inputOf(m_lobes ? lobes : std::vector<shared::PointLobes>(1));
    m_light = inputOf(std::vector<shared::PointLight>(ordered.size()));
    shared::CameraData camera{};
    camera.eyeR = {0.0f, 3.0f * s, 0.0f};
    camera.forward = {0.0f, -1.0f, 0.0f};
    m_camera = inputOf(std::vector{camera});
    push = {0, 1, 1, 0, 3072, clusters, uint32_t(ordered.size() / clusters), uint32_t(ordered.size() / clusters),
            float(area / double(ordered.size())), 32};
    sites.assign(1, site({0.0f, 0.0f, 0.0f}));
  }

  shared::GatherSite site(glm::vec3 posR) const {
    return {posR, gpu::octEncode({0.0f, 1.0f, 0.0f}), m_mirror.blocks()[0].firstTriangle, {0.25f, 0.25f}, 0};
  }

  /// Light at every site after `rounds`.
  std::vector<shared::IndirectTexel> gather(uint32_t rounds = 1, const GatherVariant& variant = {}) {
    const auto count = uint32_t(sites.size());
    const vk::Buffer indirect = inputOf(std::vector<shared::IndirectTexel>(count));
    run("gather_pixels", vk::storage(BINDING_INDIRECT, indirect), order(count), rounds, variant);
    return must(vk::readBackArray<shared::IndirectTexel>(device(), indirect, count));
  }
  /// Micro-buffers of all sites, row by row; w is 1 where something is seen.
  std::vector<glm::vec4> microBuffers(const GatherVariant& variant = {}) {
    const size_t count = sites.size() * push.microSize * push.microSize;
    const vk::Buffer out = must(vk::Buffer::create(device(), kernelBuffer("micro", count * sizeof(glm::vec4))));
    run("gather_micro_buffers", vk::storage(BINDING_OUTPUT, out), order(uint32_t(sites.size())), 1, variant);
    return must(vk::readBackArray<glm::vec4>(device(), out, count));
  }
  /// Light of all points after gathers at the sides `entries`.
  std::vector<shared::PointLight> gatherAtPoints(const std::vector<uint32_t>& entries) {
    run("gather_points", vk::storage(BINDING_POINT_LIGHT, m_light), entries, 1, {});
    return must(vk::readBackArray<shared::PointLight>(device(), m_light, push.clusterCount * push.clusterSize));
  }

  shared::PointProjectionPush push{};
  std::vector<shared::GatherSite> sites;

 private:
  static vk::Device& device() { return SharedDevice::get(); }
  template <class T>
  static vk::Buffer texels(const std::vector<T>& values, VkFormat format) {
    vk::BufferDesc desc = kernelBuffer("points");
    desc.usage = vk::BufferUsage::storage | vk::BufferUsage::texel;
    desc.texelFormat = format;
    return must(vk::createBufferWith(device(), desc, std::span<const T>(values)));
  }
  static std::vector<uint32_t> order(uint32_t count) {
    std::vector<uint32_t> entries(count);
    for (uint32_t i = 0; i < count; ++i) entries[i] = i;
    return entries;
  }

  void run(const char* shader, const vk::Binding& output, const std::vector<uint32_t>& entries, uint32_t rounds,
           const GatherVariant& variant) {
    const vk::Buffer list = inputOf(entries), siteBuffer = inputOf(sites);
    auto all = gpu::joined(m_mirror.bindings(), {vk::texel(BINDING_POINTS, m_points),
                                                 vk::storage(BINDING_CAMERA, m_camera),
                                                 vk::texel(BINDING_POINT_RADIANCE, m_radiance),
                                                 vk::storage(BINDING_POINT_LOBES, m_lobeBuffer),
                                                 vk::storage(BINDING_PIXEL_LIST, list),
                                                 vk::storage(BINDING_G_BUFFER, siteBuffer), output});
    const gpu::Pass& pass = passOf(shader, all, variant);
    push.entryCount = uint32_t(entries.size());
    const gpu::WorkGroups groups = gpu::groupsInRows(push.entryCount);
    must(gpu::runNow(device(), [&](vk::CommandRecorder& r) {
      for (uint32_t i = 0; i < rounds; ++i) {
        shared::PointProjectionPush p = push;
        p.round += i;
        pass.record(r, all, p, groups.x, groups.y);
        r.barrier();
      }
    }));
  }

  const gpu::Pass& passOf(const std::string& shader, const std::vector<vk::Binding>& like,
                          const GatherVariant& variant) {
    SceneNeeds needs;
    needs.glossy = m_glossy;
    const auto constants = gatherConstants(needs, m_lobes, variant);
    static std::map<std::pair<std::string, std::vector<uint32_t>>, gpu::Pass> passes;
    if (passes.empty()) SharedDevice::atEnd([] { passes.clear(); });
    gpu::Pass& pass = passes[{shader, constants}];
    if (!pass) pass = must(gpu::Pass::create(device(), shader, like, sizeof(shared::PointProjectionPush), constants));
    return pass;
  }

  gpu::DeviceScene m_mirror;
  vk::Buffer m_points, m_radiance, m_lobeBuffer, m_light, m_camera;
  bool m_glossy, m_lobes;
};

constexpr GatherVariant kBruteForce{GatherVariant::everyPoint, 0, 128};

}  // namespace limn::test
