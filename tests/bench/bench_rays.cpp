// Million rays a second of Limn on its device beside Embree's rtcIntersect1 and rtcOccluded1 on two threads: the same
// scene, the same rays from the same buffers, repetitions in turn, the best of each.
//   bench_rays [--device NAME|INDEX] [--repetitions N]    N at least, and two seconds a row at least
#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <thread>

#include "renderer/base/clock.hpp"
#include "renderer/gpu/pass.hpp"
#include "renderer/visibility/bvh.hpp"
#include "renderer/vk/transfer.hpp"
#include "tests/bench/ray_workload.hpp"

namespace limn::bench {
namespace {

constexpr uint32_t kImageSize = 512;
constexpr int kEmbreeThreads = 2;
constexpr double kSecondsPerRow = 2;  // at least, so that short runs too find a quiet moment of the machine

template <class T>
T orExit(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "bench_rays: %s\n", result.error().text().c_str());
    std::exit(1);
  }
  return result.take();
}
void orExit(Result<void> result) {
  if (!result) orExit(Result<int>(result.error()));
}

/// Time of `work` [s].
double timed(const std::function<void()>& work) {
  const double start = nowSeconds();
  work();
  return nowSeconds() - start;
}

class EmbreeScene {
 public:
  explicit EmbreeScene(const std::vector<glm::vec3>& corners)
      : m_device(rtcNewDevice("threads=2")), m_scene(rtcNewScene(m_device)) {
    RTCGeometry mesh = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), corners.size()));
    std::copy_n(&corners[0].x, 3 * corners.size(), vertices);
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), corners.size() / 3));
    for (uint32_t i = 0; i < corners.size(); ++i) indices[i] = i;
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(m_scene, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(m_scene);
  }
  ~EmbreeScene() {
    rtcReleaseScene(m_scene);
    rtcReleaseDevice(m_device);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  void trace(const std::vector<Ray>& rays, bool any, std::vector<RayHit>& hits) const {
    constexpr size_t kBatch = 512;
    std::atomic<size_t> next{0};
    auto work = [&] {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      for (size_t first; (first = next.fetch_add(kBatch)) < rays.size();) {
        for (size_t i = first; i < std::min(first + kBatch, rays.size()); ++i) {
          hits[i] = any ? occluded(rays[i], context) : closest(rays[i], context);
        }
      }
    };
    std::vector<std::thread> threads;
    for (int i = 0; i < kEmbreeThreads; ++i) threads.emplace_back(work);
    for (std::thread& thread : threads) thread.join();
  }

 private:
  static RTCRay toEmbree(const Ray& r) {
    return {r.originR.x, r.originR.y, r.originR.z, 0, r.dirR.x, r.dirR.y, r.dirR.z, 0, r.tMax, ~0u, 0, 0};
  }
  RayHit closest(const Ray& ray, RTCIntersectContext& context) const {
    RTCRayHit query{toEmbree(ray), {}};
    query.hit.geomID = query.hit.primID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(m_scene, &context, &query);
    return {query.ray.tfar, query.hit.primID, {query.hit.u, query.hit.v}};
  }
  RayHit occluded(const Ray& ray, RTCIntersectContext& context) const {
    RTCRay query = toEmbree(ray);
    rtcOccluded1(m_scene, &context, &query);
    return {ray.tMax, query.tfar < 0 ? 0u : shared::kNoTriangle, {0, 0}};
  }

  RTCDevice m_device;
  RTCScene m_scene;
};

/// One kind of rays, ready on the device.
class DeviceRays {
 public:
  DeviceRays(vk::Device& device, const std::vector<Ray>& rays) : m_device(device), m_count(uint32_t(rays.size())) {
    vk::BufferDesc desc{rays.size() * sizeof(Ray), vk::BufferUsage::texel, vk::MemoryKind::deviceLocal, "rays", "bench",
                        VK_FORMAT_R32G32B32A32_SFLOAT};
    m_rays = orExit(vk::createBufferWith(device, desc, std::span(rays)));
    desc = {rays.size() * sizeof(RayHit), vk::BufferUsage::storage, vk::MemoryKind::deviceLocal, "hits", "bench"};
    m_hits = orExit(vk::Buffer::create(device, desc));
  }
  void trace(const SceneBvh& bvh, bool any) {
    const std::vector<vk::Binding> bindings{vk::texel(0, bvh.nodes()), vk::texel(1, bvh.triangles()),
                                            vk::texel(2, m_rays), vk::storage(3, m_hits)};
    if (!m_pass) m_pass = orExit(gpu::Pass::create(m_device, any ? "trace_any" : "trace_closest", bindings, 4));
    orExit(gpu::runNow(m_device, [&](vk::CommandRecorder& recorder) {
      m_pass.record(recorder, bindings, m_count, (m_count + 63) / 64);
    }));
  }
  std::vector<RayHit> hits() { return orExit(vk::readBackArray<RayHit>(m_device, m_hits, m_count)); }

 private:
  vk::Device& m_device;
  uint32_t m_count;
  vk::Buffer m_rays, m_hits;
  gpu::Pass m_pass;
};

double disagreement(const std::vector<RayHit>& a, const std::vector<RayHit>& b) {
  size_t different = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const bool missA = a[i].triangle == shared::kNoTriangle, missB = b[i].triangle == shared::kNoTriangle;
    different += missA != missB || (!missA && std::abs(a[i].t - b[i].t) > 1e-4f * b[i].t + 1e-5f);
  }
  return double(different) / double(a.size());
}

/// Prints a row for each kind of ray; the lowest ratio of the three.
double benchScene(vk::Device& device, uint32_t triangles, int repetitions) {
  const std::vector<glm::vec3> corners = makeScene(triangles);
  SceneBvh bvh;
  const TriangleBlock block{corners, 0, false};
  orExit(bvh.update(device, std::span(&block, 1), {}));
  const EmbreeScene embree(corners);

  std::map<RayKind, std::vector<Ray>> rays{{RayKind::camera, cameraRays(kImageSize)}};
  std::vector<RayHit> cameraHits(rays[RayKind::camera].size());
  embree.trace(rays[RayKind::camera], false, cameraHits);
  rays[RayKind::shadow] = shadowRays(corners, rays[RayKind::camera], cameraHits);
  rays[RayKind::bounce] = bounceRays(corners, rays[RayKind::camera], cameraHits);

  double lowest = 1e9;
  for (const RayKind kind : kRayKinds) {
    const std::vector<Ray>& list = rays[kind];
    std::vector<RayHit> embreeHits(list.size());
    DeviceRays onDevice(device, list);
    onDevice.trace(bvh, asksAny(kind));
    double limnSeconds = 1e9, embreeSeconds = 1e9;
    const double start = nowSeconds();
    for (int i = 0; i < repetitions || nowSeconds() - start < kSecondsPerRow; ++i) {
      limnSeconds = std::min(limnSeconds, timed([&] { onDevice.trace(bvh, asksAny(kind)); }));
      embreeSeconds = std::min(embreeSeconds, timed([&] { embree.trace(list, asksAny(kind), embreeHits); }));
    }
    const double million = double(list.size()) * 1e-6, ratio = embreeSeconds / limnSeconds;
    std::printf("%9zu  %6s  %8.2f  %8.2f  %6.3f  %9.4f %%\n", corners.size() / 3, name(kind), million / limnSeconds,
                million / embreeSeconds, ratio, 100 * disagreement(onDevice.hits(), embreeHits));
    lowest = std::min(lowest, ratio);
  }
  std::printf("%9s  built in %.0f ms, %u nodes, %.1f MB on the device\n", "", bvh.stats().buildMs, bvh.stats().nodes,
              double(bvh.stats().bytes) * 1e-6);
  return lowest;
}

int run(int argc, char** argv) {
  vk::DeviceOptions options;
  int repetitions = 10;
  for (int i = 1; i < argc; ++i) {
    const std::string_view flag = argv[i];
    if (flag == "--device" && i + 1 < argc) options.select = argv[++i];
    else if (flag == "--repetitions" && i + 1 < argc) repetitions = std::max(1, std::atoi(argv[++i]));
    else {
      std::fprintf(stderr, "usage: bench_rays [--device NAME|INDEX] [--repetitions N]\n");
      return 64;
    }
  }
  const auto device = orExit(vk::Device::open(options));
  std::printf("%s against Embree on %d threads, million rays a second, best of %d or more\n",
              device->info().name.c_str(), kEmbreeThreads, repetitions);
  std::printf("%9s  %6s  %8s  %8s  %6s  %11s\n", "triangles", "rays", "Limn", "Embree", "ratio", "disagree");
  const double small = benchScene(*device, 5'000, repetitions);
  const double medium = benchScene(*device, 100'000, repetitions);
  const double large = benchScene(*device, 1'000'000, repetitions);
  std::printf("ratio_5k=%.3f ratio_100k=%.3f ratio_1m=%.3f\n", small, medium, large);
  return 0;
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) { return limn::bench::run(argc, argv); }
