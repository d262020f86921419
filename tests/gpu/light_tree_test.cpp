// The light tree: what its branches hold, that lights are chosen as often as is said, and that none is left out.
#include "renderer/gpu/light_tree.hpp"

#include <cmath>
#include <numeric>
#include <random>

#include "renderer/gpu/device_scene.hpp"
#include "renderer/scene/scene_needs.hpp"
#include "tests/gpu/kernel.hpp"
#include "tests/gpu/light_tree.spv.hpp"
#include "tests/gpu/shaders/light_tree.h"
#include "tests/support/closed_form.hpp"
#include "tests/support/statistics.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kDraws = 1u << 18;
constexpr double kLevel = 0.01 / 40;  // shared by all fits of this file
using gpu::LightBounds;

struct Randoms {
  std::mt19937 engine{7};
  float operator()(float low, float high) { return low + (high - low) * float(engine() >> 8) / 16777216.0f; }
  glm::vec3 place() { return {(*this)(-4, 4), (*this)(0.2f, 4), (*this)(-4, 4)}; }
  glm::vec3 direction() {
    glm::vec3 v;
    do v = {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)};
    while (glm::length(v) > 1.0f || glm::length(v) < 0.1f);
    return glm::normalize(v);
  }
};

void addTriangle(SceneBuilder& b, uint32_t material, Randoms& random) {
  Primitive p;
  p.material = int32_t(material);
  const glm::vec3 at = random.place();
  p.positions = {at, at + 0.3f * random.direction(), at + 0.3f * random.direction()};
  p.normals.assign(3, {0, 1, 0});
  p.indices = {0, 1, 2};
  b.mesh(p);
}

/// A floor under `points`, `spots` and `triangles` of random strength, and a sun of that irradiance in a fifth as bright a sky.
SceneBuilder hall(int points, int spots, int triangles, float sun) {
  SceneBuilder b;
  Randoms random;
  floorOf(b, b.diffuse(glm::vec3(0.5f)), 6);
  for (int i = 0; i < points; ++i) b.pointLight(random.place(), glm::vec3(1.0f), std::exp2(random(-6, 6)));
  for (int i = 0; i < spots; ++i)
    b.spotLight(random.place(), random.direction(), std::exp2(random(-6, 6)), random(0, 0.2f), random(0.3f, 1.5f));
  if (sun > 0.0f) b.directionalLight({0.3f, -1, 0.2f}, glm::vec3(1.0f), sun);
  for (int i = 0; i < triangles; ++i) addTriangle(b, b.emitter(glm::vec3(std::exp2(random(-3, 3)))), random);
  b.scene.environment.radiance = glm::vec3(0.2f * sun);
  return b;
}

struct HallCase {
  const char* name;
  int points, spots, triangles;
  float sun;  // [W/m²]
};
void PrintTo(const HallCase& c, std::ostream* out) { *out << c.name; }

class LightTree : public testing::TestWithParam<HallCase> {
 protected:
  LightTree() : m_hall(hall(GetParam().points, GetParam().spots, GetParam().triangles, GetParam().sun)) {
    ChangeSet everything;
    everything.everything = true;
    must(m_mirror.sync(m_hall.scene, everything));
  }
  const std::vector<shared::LightData>& lights() const { return m_mirror.lights(); }
  std::vector<shared::ChosenLight> run(shared::LightTreePush push, uint32_t mode, uint32_t count) const {
    push.mode = mode;
    push.count = count;
    push.seed = 3;
    return runKernel<shared::ChosenLight>(light_treeSpirv, m_mirror.bindings(), push, count, groupsFor(count));
  }

  SceneBuilder m_hall;
  gpu::DeviceScene m_mirror{SharedDevice::get()};
};

INSTANTIATE_TEST_SUITE_P(Halls, LightTree,
                         testing::Values(HallCase{"Points", 300, 0, 0, 0.0f}, HallCase{"Spots", 0, 120, 0, 0.0f},
                                         HallCase{"Triangles", 0, 0, 200, 0.0f}, HallCase{"Everything", 40, 40, 40, 1.0f},
                                         HallCase{"StrongSun", 300, 0, 0, 1e8f}, HallCase{"WeakSun", 300, 0, 0, 1e-8f}),
                         [](const auto& tested) { return std::string(tested.param.name); });

/// On the floor, among the lights, on a wall that sees half of them, far away, and with two sides.
std::vector<shared::LightTreePush> receivers() {
  const auto at = [](glm::vec3 position, glm::vec3 normal, bool both) {
    return shared::LightTreePush{position, both, glm::normalize(normal), 0, 0, 0};
  };
  return {at({0, 0, 0}, {0, 1, 0}, false), at({1, 2, -1}, {0.2f, -1, 0.4f}, false), at({-4, 1, 0}, {-1, 0.2f, 0}, false),
          at({300, 90, -500}, {-0.3f, 0, 1}, false), at({0.5f, 1.5f, 2}, {1, 0, 0}, true)};
}

TEST_P(LightTree, LightsAreChosenAsOftenAsIsSaid) {
  for (const shared::LightTreePush& receiver : receivers()) {
    SCOPED_TRACE(receiver.posR.x);
    const auto told = run(receiver, shared::kTreeProbability, uint32_t(lights().size()));
    std::vector<double> counts(lights().size() + 1, 0.0), expected;
    double sum = 0.0;
    for (const shared::ChosenLight& light : told) {
      expected.push_back(double(light.probability) * kDraws);
      sum += light.probability;
    }
    ASSERT_LE(sum, 1.0 + 1e-5);
    expected.push_back(std::max(1.0 - sum, 0.0) * kDraws);
    for (const shared::ChosenLight& drawn : run(receiver, shared::kTreeChoose, kDraws)) {
      const size_t index = std::min(size_t(drawn.index), lights().size());
      counts[index] += 1;
      if (drawn.index != shared::kNoIndex) {
        ASSERT_NEAR(drawn.probability, told[index].probability, 2e-5 * drawn.probability);
      }
    }
    const GoodnessOfFit fit = chiSquare(counts, expected);
    EXPECT_GT(fit.p, kLevel) << "chi-square " << fit.statistic << " of " << fit.dof << ", " << fit.worst;
  }
}

/// The way to a light from the receiver [m], and the unit normal of a triangle.
struct Way {
  glm::dvec3 toLight, normal{0.0};
};

const gpu::GeometryBlock& blockOf(const gpu::DeviceScene& mirror, uint32_t triangle) {
  const auto& blocks = mirror.blocks();
  return *std::find_if(blocks.begin(), blocks.end(), [&](const gpu::GeometryBlock& block) {
    return triangle >= block.firstTriangle && triangle < block.firstTriangle + block.triangleCount();
  });
}

/// `weights` are those of a triangle's corners.
Way wayTo(const gpu::DeviceScene& mirror, const shared::LightData& light, const glm::vec3& from, const glm::dvec3& weights) {
  if (light.type != shared::kLightTriangle) return {glm::dvec3(light.posR) - glm::dvec3(from)};
  const gpu::GeometryBlock& block = blockOf(mirror, light.triangle);
  const glm::vec3* corner = &block.corners[size_t(light.triangle - block.firstTriangle) * 3];
  const glm::dvec3 a(corner[0]), b(corner[1]), c(corner[2]);
  return {a * weights.x + b * weights.y + c * weights.z - glm::dvec3(from), glm::normalize(glm::cross(b - a, c - a))};
}

/// [W/sr] Where a light is strongest.
double intensity(const Scene& scene, const gpu::DeviceScene& mirror, const shared::LightData& light) {
  if (light.type != shared::kLightTriangle) return light.color.g;
  return light.area * scene.materials[blockOf(mirror, light.triangle).material - 1].emission.g;
}

/// Of the intensity, towards the receiver and onto it.
double shareThatArrives(const gpu::DeviceScene& mirror, const shared::LightData& light, const shared::LightTreePush& at,
                        const glm::dvec3& weights = glm::dvec3(1.0 / 3.0)) {
  const Way way = wayTo(mirror, light, at.posR, weights);
  const glm::dvec3 dir = glm::normalize(way.toLight);
  double sent = 1.0;
  if (light.type == shared::kLightTriangle) sent = std::abs(glm::dot(way.normal, dir));
  if (light.type == shared::kLightSpot) {
    const double ramp = std::clamp(-glm::dot(dir, glm::dvec3(light.dirR)) * light.spotScale + light.spotOffset, 0.0, 1.0);
    sent = ramp * ramp;
  }
  const double cosine = glm::dot(dir, glm::dvec3(at.normal));
  return sent * (at.both ? std::abs(cosine) : std::max(cosine, 0.0)) / glm::dot(way.toLight, way.toLight);
}

TEST_P(LightTree, NoLightThatBringsAnythingIsLeftOut) {
  for (const shared::LightTreePush& receiver : receivers()) {
    SCOPED_TRACE(receiver.posR.x);
    const auto told = run(receiver, shared::kTreeProbability, uint32_t(lights().size()));
    for (size_t i = 0; i < lights().size(); ++i)
      for (const glm::dvec3 corner : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)})
        if (lights()[i].node != shared::kNoIndex && shareThatArrives(m_mirror, lights()[i], receiver, corner) > 0.0) {
          ASSERT_GT(told[i].probability, 0.0f) << i;
        }
  }
}

/// Expected squares of f/p over the lights of the tree.
struct Spread {
  double byTree = 0.0, byIntensity = 0.0;
};
Spread spreadOf(const Scene& scene, const gpu::DeviceScene& mirror, const std::vector<shared::ChosenLight>& told,
                const shared::LightTreePush& receiver) {
  double intensities = 0.0, treeShare = 0.0;
  Spread spread;
  for (size_t i = 0; i < told.size(); ++i) {
    const shared::LightData& light = mirror.lights()[i];
    if (light.node == shared::kNoIndex) continue;
    const double own = intensity(scene, mirror, light), share = shareThatArrives(mirror, light, receiver);
    treeShare += told[i].probability;
    intensities += own;
    if (share > 0.0) spread.byTree += own * own * share * share / told[i].probability;
    spread.byIntensity += own * share * share;
  }
  return {spread.byTree * treeShare, spread.byIntensity * intensities};
}

TEST_P(LightTree, NearAndStrongLightsAreChosenMoreOften) {
  double logs = 0.0;
  for (const shared::LightTreePush& receiver : receivers()) {
    const auto told = run(receiver, shared::kTreeProbability, uint32_t(lights().size()));
    const Spread spread = spreadOf(m_hall.scene, m_mirror, told, receiver);
    EXPECT_LT(spread.byTree, 1.01 * spread.byIntensity) << "receiver at x = " << receiver.posR.x;
    logs += std::log(spread.byTree / spread.byIntensity) / double(receivers().size());
  }
  EXPECT_LT(std::exp(logs), 0.5);
}

TEST(LightTreeOfFew, IsNotPlanted) {
  for (const int count : {int(kFewLights), int(kFewLights) + 1}) {
    const SceneBuilder b = hall(count, 0, 0, 1.0f);
    EXPECT_EQ(sceneNeeds(b.scene).manyLights, count > int(kFewLights));
    gpu::DeviceScene mirror(SharedDevice::get());
    ChangeSet everything;
    everything.everything = true;
    must(mirror.sync(b.scene, everything));
    EXPECT_EQ(mirror.lights()[0].node != shared::kNoIndex, count > int(kFewLights));
  }
}

/// Checks a branch and everything below it; returns its lights.
std::vector<uint32_t> checkBranch(const std::vector<shared::LightNode>& tree, uint32_t index, uint32_t parent,
                                  std::span<const LightBounds> lights, uint32_t depth) {
  EXPECT_LT(depth, 400u);
  const shared::LightNode& node = tree.at(index);
  EXPECT_EQ(node.parent, parent);
  std::vector<uint32_t> held;
  if (node.child & shared::kLightLeaf) {
    held = {node.child & ~shared::kLightLeaf};
  } else {
    for (const uint32_t child : {node.child, node.child + 1})
      for (const uint32_t light : checkBranch(tree, child, index, lights, depth + 1)) held.push_back(light);
  }
  double intensity = 0.0;
  for (const uint32_t light : held) {
    const LightBounds& b = lights[light];
    intensity += b.intensity;
    for (int k = 0; k < 8; ++k) {
      const glm::dvec3 corner(k & 1 ? b.high.x : b.low.x, k & 2 ? b.high.y : b.low.y, k & 4 ? b.high.z : b.low.z);
      EXPECT_LE(glm::length(corner - glm::dvec3(node.centerR)), double(node.radius));
    }
    double cosine = glm::dot(b.axis, glm::dvec3(node.axis));
    if (node.cosEnd == shared::kTwoSidedEnd) cosine = std::abs(cosine);
    const double off = std::atan2(glm::length(glm::cross(b.axis, glm::dvec3(node.axis))), cosine);
    const double rounding = 3.5e-4;  // [rad] of a cosine near 1 in single precision
    EXPECT_GE(std::acos(std::clamp(double(node.cosOpening), -1.0, 1.0)) + rounding, std::min(off + b.opening, kPi));
  }
  EXPECT_NEAR(node.intensity, intensity, 1e-5 * intensity);
  return held;
}

void checkTree(const std::vector<LightBounds>& lights) {
  const auto tree = gpu::buildLightTree(lights);
  ASSERT_EQ(tree.size(), gpu::lightTreeNodes(lights.size()));
  std::vector<uint32_t> held = checkBranch(tree, 0, shared::kNoIndex, lights, 0);
  for (const uint32_t light : checkBranch(tree, 1, shared::kNoIndex, lights, 0)) held.push_back(light);
  std::sort(held.begin(), held.end());
  std::vector<uint32_t> all(lights.size());
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(held, all);
}

std::vector<LightBounds> numbered(std::vector<LightBounds> lights) {
  for (size_t i = 0; i < lights.size(); ++i) lights[i].light = uint32_t(i);
  return lights;
}

TEST(LightTreeBuild, BranchesBoundTheirLights) {
  Randoms random;
  std::vector<LightBounds> lights;
  for (int i = 0; i < 500; ++i) {
    lights.push_back(gpu::pointBounds(random.place(), random(0.1f, 9)));
    lights.push_back(gpu::spotBounds(random.place() * 1e-3f, random.direction(), random(-0.5f, 1), random(0.1f, 9)));
    const glm::vec3 at = random.place() * 1e4f;
    const glm::vec3 corner[3] = {at, at + random.direction(), at + random.direction()};
    lights.push_back(gpu::triangleBounds(corner, random(0.1f, 9)));
  }
  for (const bool mixed : {true, false}) {
    if (!mixed) std::erase_if(lights, [](const LightBounds& b) { return b.cosEnd != shared::kSpotEnd; });
    checkTree(numbered(lights));
  }
}

TEST(LightTreeBuild, PlacesThatAreHardToDivide) {
  std::vector<LightBounds> together, geometric, two;
  for (int i = 0; i < 1000; ++i) together.push_back(gpu::pointBounds({1e6f, -3, 2}, 1.0));
  for (int i = 0; i < 240; ++i)
    geometric.push_back(gpu::pointBounds({std::exp2(float(i - 120)), 0, 0}, std::exp2(double(i % 60))));
  for (int i = 0; i < 2; ++i) two.push_back(gpu::pointBounds({0, float(i), 0}, 1.0));
  checkTree(numbered(together));
  checkTree(numbered(geometric));
  checkTree(numbered(two));
}

}  // namespace
}  // namespace limn::test
