// Milliseconds of what a moved object costs the surface points, and of their clustering beside plain median splits by
// std::nth_element: the same points, repetitions in turn, the best of each.
//   bench_points SCENE [--device NAME|INDEX] [--repetitions N] [--points N] [--clusters 2^N]
#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>

#include "renderer/base/clock.hpp"
#include "renderer/cache/point_clusters.hpp"
#include "renderer/cache/surface_points.hpp"
#include "renderer/scene/gltf_loader.hpp"

namespace limn::bench {
namespace {

template <class T>
T orExit(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "bench_points: %s\n", result.error().text().c_str());
    std::exit(1);
  }
  return result.take();
}

struct Options {
  std::string scene;
  vk::DeviceOptions device;
  uint32_t repetitions = 10, points = 1u << 18, clusters = 512;
};

struct Item {
  glm::vec3 position;
  uint32_t index;
};

/// Halves along the longest axis, level by level, on one core; no order inside clusters.
void splitPlainly(std::span<Item> group, uint32_t clusters) {
  if (clusters == 1) return;
  glm::vec3 low(3.0e38f), high(-3.0e38f);
  for (const Item& item : group) low = glm::min(low, item.position), high = glm::max(high, item.position);
  const glm::vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const size_t half = group.size() / 2;
  const auto before = [axis](const Item& a, const Item& b) {
    return a.position[axis] != b.position[axis] ? a.position[axis] < b.position[axis] : a.index < b.index;
  };
  std::nth_element(group.begin(), group.begin() + std::ptrdiff_t(half), group.end(), before);
  splitPlainly(group.first(half), clusters / 2);
  splitPlainly(group.subspan(half), clusters / 2);
}

template <class Work>
double milliseconds(const Work& work) {
  const double begin = nowSeconds();
  work();
  return (nowSeconds() - begin) * 1e3;
}

void benchClusters(const std::vector<shared::SurfacePoint>& points, const Options& options) {
  std::vector<glm::vec3> positions;
  for (const shared::SurfacePoint& p : points) positions.push_back(p.posR);
  double best = std::numeric_limits<double>::infinity(), plain = best;
  for (uint32_t i = 0; i < options.repetitions; ++i) {
    best = std::min(best, milliseconds([&] { (void)clusterPoints(positions, options.clusters); }));
    std::vector<Item> items(positions.size());
    plain = std::min(plain, milliseconds([&] {
      for (uint32_t k = 0; k < items.size(); ++k) items[k] = {positions[k], k};
      splitPlainly(items, options.clusters);
    }));
  }
  std::printf("%zu points in %u clusters: %.1f ms, ordered inside; plain splits alone, one core: %.1f ms\n",
              points.size(), options.clusters, best, plain);
}

int bench(const Options& options) {
  const auto device = orExit(vk::Device::open(options.device));
  Scene scene = orExit(loadGltf(options.scene, {})).scene;
  gpu::DeviceScene mirror(*device);
  ChangeSet changes;
  changes.everything = true;
  orExit(mirror.sync(scene, changes));
  SurfacePoints points;
  const auto update = [&] {
    return orExit(points.update(*device, scene, mirror, options.points, options.clusters, 1));
  };
  std::printf("all blocks sampled: %.0f ms, relative radius %.3f\n", update().sampleMs, points.relativeRadius());

  const uint32_t node = mirror.blocks().back().node;
  changes = {};
  changes.nodes = {node};
  SurfacePoints::Update best;
  best.sampleMs = best.moveMs = best.clusterMs = best.uploadMs = std::numeric_limits<double>::infinity();
  for (uint32_t i = 0; i < options.repetitions; ++i) {
    scene.nodes[node].parentFromLocal.translation.x += 1e-3;
    orExit(mirror.sync(scene, changes));
    const SurfacePoints::Update done = update();
    best.sampleMs = std::min(best.sampleMs, done.sampleMs);
    best.moveMs = std::min(best.moveMs, done.moveMs);
    best.clusterMs = std::min(best.clusterMs, done.clusterMs);
    best.uploadMs = std::min(best.uploadMs, done.uploadMs);
  }
  std::printf("one object moved: look %.1f ms, move %.1f ms, cluster %.1f ms, upload %.1f ms\n", best.sampleMs,
              best.moveMs, best.clusterMs, best.uploadMs);
  benchClusters(points.points(), options);
  return 0;
}

int run(int argc, char** argv) {
  Options options;
  const std::map<std::string, uint32_t*> numbers{{"--repetitions", &options.repetitions},
                                                 {"--points", &options.points},
                                                 {"--clusters", &options.clusters}};
  if (argc > 1) options.scene = argv[1];
  for (int i = 2; i < argc; i += 2) {
    const auto number = numbers.find(argv[i]);
    if (i + 1 < argc && number != numbers.end()) *number->second = uint32_t(std::max(1, std::atoi(argv[i + 1])));
    else if (i + 1 < argc && std::string(argv[i]) == "--device") options.device.select = argv[i + 1];
    else options.scene.clear();
  }
  if (!options.scene.empty() && std::has_single_bit(options.clusters)) return bench(options);
  std::fprintf(stderr, "bench_points SCENE [--device NAME|INDEX] [--repetitions N] [--points N] [--clusters 2^N]\n");
  return 64;
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) { return limn::bench::run(argc, argv); }
