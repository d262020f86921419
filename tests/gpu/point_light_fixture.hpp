#pragma once
#include <cmath>
#include <memory>
#include <vector>

#include "renderer/cache/point_light.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/point_shared.h"
#include "shaders/shared/relight_shared.h"
#include "tests/gpu/kernel.hpp"
#include "tests/support/closed_form.hpp"
#include "tests/support/scene_builder.hpp"

namespace limn::test {

/// Points on a square mesh of two triangles (a, b, c), (a, c, d), in rows over the whole of it.
struct SquarePoints {
  static constexpr uint32_t kRow = 16;
  static constexpr PointLayout kLayout{8, kRow* kRow / 8};

  glm::dvec3 a, b, d;
  SquarePoints(glm::dvec3 cornerA, glm::dvec3 cornerB, glm::dvec3 cornerD) : a(cornerA), b(cornerB), d(cornerD) {}

  static uint32_t count() { return kRow * kRow; }
  glm::dvec3 position(uint32_t point) const { return a + (b - a) * x(point) + (d - a) * y(point); }
  glm::dvec3 normal() const { return glm::normalize(glm::cross(b - a, d - a)); }

  std::vector<shared::PointSite> sites(uint32_t firstTriangle) const {
    std::vector<shared::PointSite> all;
    for (uint32_t i = 0; i < count(); ++i) {
      const float fx = float(x(i)), fy = float(y(i));
      if (fx > fy)
        all.push_back({firstTriangle, {fx - fy, fy}});
      else
        all.push_back({firstTriangle + 1, {fx, fy - fx}});
    }
    return all;
  }

 private:
  static double x(uint32_t point) { return (point % kRow + 0.5) / kRow; }
  static double y(uint32_t point) { return (point / kRow + 0.5) / kRow; }
};

/// The floor of most tests: 2 m wide at y = 0, its front up.
inline SquarePoints floorPoints() { return {{-1, 0, 1}, {1, 0, 1}, {-1, 0, -1}}; }
inline uint32_t addFloor(SceneBuilder& builder, uint32_t material) {
  return builder.quad(material, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
}

/// A scene on the device with points on its first node, which is a square of two triangles, and a cache that lights
/// them.
class LitPoints {
 public:
  explicit LitPoints(const SceneBuilder& builder, bool compile = false) : m_mirror(device()) {
    ChangeSet everything;
    everything.everything = true;
    must(m_mirror.sync(builder.scene, everything));
    std::vector<TriangleBlock> blocks;
    for (size_t i = 0; i < m_mirror.blocks().size(); ++i)
      blocks.push_back({m_mirror.blocks()[i].corners, m_mirror.blocks()[i].firstTriangle, m_mirror.blockNeedsAlpha(i)});
    must(m_tracer.update(device(), blocks, {}));
    m_sites = inputOf(floorPoints().sites(m_mirror.blocks()[0].firstTriangle));
    must(cache().resize(device(), SquarePoints::kLayout, hasGlossySources(builder.scene)));
    must(cache().prepare(context(), sceneNeeds(builder.scene), compile));
    must(gpu::runNow(device(), [&](vk::CommandRecorder& r) { cache().recordClear(r); }));
    m_raysBefore = cache().raysTraced();
    m_discardedBefore = cache().discardedSamples();
  }

  LitPoints& relight(RelightWork work) {
    must(gpu::runNow(device(), [&](vk::CommandRecorder& r) { cache().recordRelight(r, context(), work); }));
    return *this;
  }
  LitPoints& relight(uint32_t samples, uint32_t samplesBefore = 0, uint32_t seed = 1) {
    return relight({kAll, samples, samplesBefore, seed});
  }
  LitPoints& paths(PathWork work) {
    must(gpu::runNow(device(), [&](vk::CommandRecorder& r) { cache().recordPaths(r, context(), work); }));
    return *this;
  }
  LitPoints& compose() {
    must(gpu::runNow(device(), [&](vk::CommandRecorder& r) { cache().recordCompose(r, context(), kAll); }));
    return *this;
  }
  void write(const std::vector<shared::PointLight>& light) {
    must(gpu::runNow(device(), [&, source = inputOf(light)](vk::CommandRecorder& r) {
      r.copyBuffer(source, 0, cache().light(), 0, source.size());
    }));
  }

  std::vector<shared::PointLight> light() const { return read<shared::PointLight>(cache().light(), 1); }
  std::vector<glm::vec4> radiance() const { return read<glm::vec4>(cache().radiance(), 2); }
  std::vector<shared::PointLobes> lobes() const { return read<shared::PointLobes>(cache().lobes(), 1); }
  uint64_t rays() const { return cache().raysTraced() - m_raysBefore; }
  uint64_t discarded() const { return cache().discardedSamples() - m_discardedBefore; }

  static constexpr SlotRange kAll{0, SquarePoints::kLayout.clusterSize};

  /// One for the whole program, so that pipelines are made once.
  static PointLightCache& cache() {
    if (!s_cache) {
      s_cache = std::make_unique<PointLightCache>();
      SharedDevice::atEnd([] { s_cache.reset(); });
    }
    return *s_cache;
  }

 private:
  static vk::Device& device() { return SharedDevice::get(); }
  PointLightContext context() const { return {device(), m_mirror, m_tracer, {vk::storage(BINDING_POINT_SITES, m_sites)}}; }
  template <class T>
  static std::vector<T> read(const vk::Buffer& buffer, size_t aPoint) {
    return must(vk::readBackArray<T>(device(), buffer, SquarePoints::count() * aPoint));
  }

  gpu::DeviceScene m_mirror;
  SceneTracer m_tracer;
  vk::Buffer m_sites;
  uint64_t m_raysBefore = 0, m_discardedBefore = 0;
  static inline std::unique_ptr<PointLightCache> s_cache;
};

/// Irradiance / pi that a light of `intensity` [W/sr] at `source` sends onto the front of a point, unshadowed.
inline double pointLightOn(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& source,
                           double intensity) {
  const glm::dvec3 way = source - point;
  const double d2 = glm::dot(way, way);
  return intensity * std::max(0.0, glm::dot(normal, way)) / (d2 * std::sqrt(d2)) / kPi;
}

}  // namespace limn::test
