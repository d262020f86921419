#include "server/limn/bench_growth.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderer/base/clock.hpp"
#include "renderer/vk/device.hpp"

namespace limn::bench {
namespace {

constexpr float kSide = 10.0f, kHeight = 4.0f;  // [m] of the room's floor and of the lights above it
constexpr float kTotalIntensity = 60.0f;        // [W/sr] of all lights together
constexpr uint32_t kFirstSteps = 4;             // those of a technique that differ from the rest
constexpr double kLeastSeconds = 0.5;
constexpr const char* kPoints = "points";       // an axis, and the parameter of techniques that have them

/// What one axis varies; the other sizes stay at these.
struct GrowthSize {
  uint32_t triangles = 10'000, lights = 4, side = 128;
  std::optional<uint32_t> points = {};          // a technique's own number unless it is given
};

Primitive rippledFloor(uint32_t triangles) {
  const uint32_t cells = std::max(1u, uint32_t(std::lround(std::sqrt(triangles / 2.0))));
  Primitive floor;
  floor.material = 0;
  for (uint32_t y = 0; y <= cells; ++y)
    for (uint32_t x = 0; x <= cells; ++x) {
      const float px = kSide * (float(x) / float(cells) - 0.5f), pz = kSide * (float(y) / float(cells) - 0.5f);
      floor.positions.push_back({px, 0.3f * std::sin(2.0f * px) * std::sin(2.0f * pz), pz});
      const float dx = 0.6f * std::cos(2.0f * px) * std::sin(2.0f * pz);
      const float dz = 0.6f * std::sin(2.0f * px) * std::cos(2.0f * pz);
      floor.normals.push_back(glm::normalize(glm::vec3(-dx, 1.0f, -dz)));
    }
  for (uint32_t y = 0; y < cells; ++y)
    for (uint32_t x = 0; x < cells; ++x) {
      const uint32_t a = y * (cells + 1) + x, b = a + cells + 1;
      floor.indices.insert(floor.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
    }
  return floor;
}

void addLights(Scene& scene, uint32_t lights) {
  const uint32_t rows = uint32_t(std::ceil(std::sqrt(double(lights))));
  for (uint32_t i = 0; i < lights; ++i) {
    Light light;
    light.intensity = kTotalIntensity / float(lights);
    scene.lights.push_back(light);
    Node node;
    node.light = int32_t(i);
    node.parentFromLocal.translation = {kSide * ((i % rows + 0.5) / rows - 0.5), kHeight,
                                        kSide * ((i / rows + 0.5) / rows - 0.5)};
    scene.roots.push_back(uint32_t(scene.nodes.size()));
    scene.nodes.push_back(node);
  }
}

Result<Growth::Point> measurePoint(vk::Device& device, const BenchOptions& options, const std::string& technique,
                                   const GrowthSize& size) {
  SessionConfig config;
  config.width = config.height = size.side;
  config.technique = technique;
  config.parameters = parametersOf(*findTechnique(technique), options.settings);
  putOffTheEnd(config.parameters, *findTechnique(technique));
  if (size.points) config.parameters.emplace_back(kPoints, *size.points);
  Result<std::unique_ptr<BenchSession>> made =
      BenchSession::create(device, growthScene(size.triangles, size.lights), config);
  if (!made) return made.error();
  Session& session = ***made;
  Growth::Point point;
  const double first = nowSeconds();
  if (Result<void> done = session.runSteps(kFirstSteps); !done) return done.error();
  point.firstSeconds = nowSeconds() - first;
  uint32_t steps = 0;
  double seconds = 0.0;
  for (const double begin = nowSeconds(); steps < 2 || seconds < kLeastSeconds; seconds = nowSeconds() - begin)
    if (Result<void> done = session.runSteps(kFirstSteps + ++steps); !done) return done.error();
  const Result<Status> status = session.status();
  if (!status) return status.error();
  point.stepSeconds = seconds / steps;
  for (const auto& [owner, bytes] : status->memory) point.megabytes += double(bytes) * 1e-6;
  for (const StageTime& stage : status->stages)
    if (stage.name == "build") point.buildSeconds = stage.ms * 1e-3;
  return point;
}

void fit(Growth& growth) {
  std::vector<Sample> time, first, memory, build;
  for (const Growth::Point& point : growth.points) {
    time.push_back({point.size, point.stepSeconds});
    first.push_back({point.size, point.firstSeconds});
    memory.push_back({point.size, point.megabytes});
    build.push_back({point.size, point.buildSeconds});
  }
  growth.time = fitPower(time);
  growth.first = fitPower(first);
  growth.memory = fitPower(memory);
  growth.build = fitPower(build);
}

struct Axis {
  std::string name;
  std::vector<double> sizes;
  GrowthSize (*at)(double size);
};

const std::vector<Axis>& axes() {
  static const std::vector<Axis> kAxes{
      {"triangles", {1e4, 3e4, 1e5, 3e5, 1e6, 3e6}, [](double n) { return GrowthSize{uint32_t(n), 4, 128}; }},
      {"lights", {1, 10, 100, 1e3, 1e4}, [](double n) { return GrowthSize{10'000, uint32_t(n), 128}; }},
      {kPoints,
       {16384, 65536, 262144, 1048576},
       [](double n) { return GrowthSize{10'000, 4, 128, uint32_t(n)}; }},
      {"pixels",
       {64.0 * 64, 128.0 * 128, 256.0 * 256, 512.0 * 512},
       [](double n) { return GrowthSize{10'000, 4, uint32_t(std::lround(std::sqrt(n)))}; }}};
  return kAxes;
}

bool hasPoints(const TechniqueInfo& technique) {
  const auto isPoints = [](const ParameterInfo& p) { return p.name == kPoints; };
  return std::any_of(technique.parameters.begin(), technique.parameters.end(), isPoints);
}

}  // namespace

LoadedScene growthScene(uint32_t triangles, uint32_t lights) {
  LoadedScene loaded;
  Scene& scene = loaded.scene;
  Material stone;
  stone.baseColor = {0.6f, 0.6f, 0.6f, 1.0f};
  stone.metallic = 0.0f;
  stone.specular = 0.0f;
  scene.materials.push_back(stone);
  scene.meshes.push_back({"Floor", {rippledFloor(triangles)}});
  Node floor;
  floor.mesh = 0;
  scene.roots.push_back(0);
  scene.nodes.push_back(floor);
  addLights(scene, lights);
  scene.view.eye = {0.0, 6.0, 9.0};
  scene.view.target = {0.0, 0.0, 0.0};
  loaded.report.triangles = loaded.report.instancedTriangles = scene.meshes[0].primitives[0].indices.size() / 3;
  return loaded;
}

Result<std::vector<Growth>> measureGrowth(vk::Device& device, const BenchOptions& options) {
  std::vector<Growth> all;
  for (const std::string& technique : options.techniques)
    for (const Axis& axis : axes()) {
      if (axis.name == kPoints && !hasPoints(*findTechnique(technique))) continue;
      Growth growth{technique, axis.name, {}, {}, {}, {}, {}};
      for (const double size : axis.sizes) {
        Result<Growth::Point> point = measurePoint(device, options, technique, axis.at(size));
        if (!point) return point.error();
        point->size = size;
        growth.points.push_back(*point);
      }
      fit(growth);
      all.push_back(std::move(growth));
    }
  return all;
}

}  // namespace limn::bench
