// Microseconds a site of gathers by point projection, beside a plain loop of as many fetches and atomics: the same
// points, repetitions in turn, the best of each.
//   bench_gather [--device NAME|INDEX] [--repetitions N] [--projections N] [--points N] [--micro N] [--workgroup N]
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <string>

#include "renderer/base/clock.hpp"
#include "renderer/gather/point_projection.hpp"
#include "renderer/gpu/device_scene.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/scene_shared.h"
#include "tests/gpu/gather_points.hpp"

namespace limn::bench {
namespace {

constexpr uint32_t kClusters = 512, kSites = 1024;

template <class T>
T orExit(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "bench_gather: %s\n", result.error().text().c_str());
    std::exit(1);
  }
  return result.take();
}
void orExit(Result<void> result) {
  if (!result) orExit(Result<int>(result.error()));
}

template <class T>
vk::Buffer bufferOf(vk::Device& device, const std::vector<T>& values, VkFormat format = VK_FORMAT_UNDEFINED) {
  vk::BufferDesc desc;
  desc.name = desc.owner = "bench";
  if (format != VK_FORMAT_UNDEFINED) {
    desc.usage = vk::BufferUsage::storage | vk::BufferUsage::texel;
    desc.texelFormat = format;
  }
  return orExit(vk::createBufferWith(device, desc, std::span<const T>(values)));
}

/// A box of 2 m with a sphere in it.
std::vector<test::LitPoint> room(uint32_t count) {
  const auto row = uint32_t(std::sqrt(double(count) * 0.85 / 6.0));
  auto points = test::boxPoints(1.0f, row, {{4, 1, 1}, {1, 4, 1}, {1, 1, 1}, {2, 2, 2}, {1, 1, 4}, {1, 0, 1}});
  auto sphere = test::spherePoints({0.2f, -0.4f, 0.1f}, 0.5f, count - uint32_t(points.size()), glm::vec3(0.5f));
  for (test::LitPoint& p : sphere) p.normal = -p.normal;
  test::append(points, sphere);
  return points;
}

/// One triangle that faces up, for the sites' normals.
Scene floorScene() {
  Scene scene;
  Mesh mesh;
  Primitive p;
  p.positions = {{-1, 0, 1}, {1, 0, 1}, {0, 0, -1}};
  p.normals.assign(3, {0, 1, 0});
  p.indices = {0, 1, 2};
  mesh.primitives.push_back(p);
  scene.meshes.push_back(mesh);
  Node node;
  node.mesh = 0;
  scene.nodes.push_back(node);
  return scene;
}

std::vector<shared::GatherSite> sitesOnFloor() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-0.95f, 0.95f);
  std::vector<shared::GatherSite> sites;
  for (uint32_t i = 0; i < kSites; ++i)
    sites.push_back({{unit(random), -1.0f, unit(random)}, gpu::octEncode({0, 1, 0}), 0, {0.3f, 0.3f}, 0});
  return sites;
}

struct Options {
  vk::DeviceOptions device;
  uint32_t repetitions = 10, projections = 3072, points = 1u << 18, micro = 32, workgroup = 64;
};

int bench(const Options& options) {
  const auto device = orExit(vk::Device::open(options.device));
  gpu::DeviceScene mirror(*device);
  ChangeSet everything;
  everything.everything = true;
  orExit(mirror.sync(floorScene(), everything));
  const auto points = test::clusterMajor(room(options.points), kClusters);
  const auto pointBuffer = bufferOf(*device, test::pointWords(points), VK_FORMAT_R32G32B32A32_UINT);
  const auto radiance = bufferOf(*device, test::radianceWords(points), VK_FORMAT_R32G32B32A32_SFLOAT);
  const auto lobes = bufferOf(*device, std::vector<shared::PointLobes>(1));
  const auto sites = bufferOf(*device, sitesOnFloor());
  const auto indirect = bufferOf(*device, std::vector<shared::IndirectTexel>(kSites));
  shared::CameraData view{};
  view.eyeR = {0, 0.9f, 0};
  const auto camera = bufferOf(*device, std::vector{view});
  std::vector<uint32_t> order(kSites);
  for (uint32_t i = 0; i < kSites; ++i) order[i] = i;
  const auto list = bufferOf(*device, order);
  const auto all = gpu::joined(
      mirror.bindings(), {vk::texel(BINDING_POINTS, pointBuffer), vk::texel(BINDING_POINT_RADIANCE, radiance),
                          vk::storage(BINDING_POINT_LOBES, lobes), vk::storage(BINDING_G_BUFFER, sites),
                          vk::storage(BINDING_INDIRECT, indirect), vk::storage(BINDING_CAMERA, camera),
                          vk::storage(BINDING_PIXEL_LIST, list)});
  const uint32_t slots = uint32_t(points.size()) / kClusters;
  const shared::PointProjectionPush push{0, kSites, 1, 0, options.projections, kClusters, slots, slots,
                                         27.1f / float(points.size()), options.micro};
  SceneNeeds diffuse, glossy;
  glossy.glossy = true;
  GatherVariant variant;
  variant.workgroup = options.workgroup;
  std::vector<std::pair<const char*, gpu::Pass>> passes;
  const auto add = [&](const char* name, const char* shader, const SceneNeeds& needs) {
    const auto constants = gatherConstants(needs, false, variant);
    passes.emplace_back(name, orExit(gpu::Pass::create(*device, shader, all, sizeof(push), constants)));
  };
  add("plain fetch + atomic", "gather_baseline", diffuse);
  add("diffuse", "gather_pixels", diffuse);
  add("diffuse + rough glossy", "gather_pixels", glossy);
  std::vector<double> best(passes.size(), 1e9);
  for (uint32_t turn = 0; turn <= options.repetitions; ++turn)
    for (size_t i = 0; i < passes.size(); ++i) {
      const double begin = nowSeconds();
      orExit(gpu::runNow(*device, [&](vk::CommandRecorder& r) { passes[i].second.record(r, all, push, kSites); }));
      if (turn > 0) best[i] = std::min(best[i], nowSeconds() - begin);
    }
  std::printf("%s, %u projections of %zu points in %u clusters, %ux%u texels, workgroups of %u\n",
              device->info().name.c_str(), options.projections, points.size(), kClusters, options.micro, options.micro,
              options.workgroup);
  for (size_t i = 0; i < passes.size(); ++i)
    std::printf("%-24s %8.1f us a site  %6.2f of the plain loop\n", passes[i].first, best[i] / kSites * 1e6,
                best[i] / best[0]);
  return 0;
}

int run(int argc, char** argv) {
  Options options;
  const std::map<std::string, uint32_t*> numbers{{"--repetitions", &options.repetitions},
                                                 {"--projections", &options.projections},
                                                 {"--points", &options.points},
                                                 {"--micro", &options.micro},
                                                 {"--workgroup", &options.workgroup}};
  for (int i = 1; i < argc; i += 2) {
    const auto number = numbers.find(argv[i]);
    if (i + 1 < argc && number != numbers.end()) *number->second = uint32_t(std::max(1, std::atoi(argv[i + 1])));
    else if (i + 1 < argc && std::string(argv[i]) == "--device") options.device.select = argv[i + 1];
    else {
      std::fprintf(stderr, "bench_gather: unknown argument %s\n", argv[i]);
      return 64;
    }
  }
  return bench(options);
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) { return limn::bench::run(argc, argv); }
