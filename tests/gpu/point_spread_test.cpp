#include <cmath>

#include "renderer/cache/point_grid.hpp"
#include "renderer/cache/point_light.hpp"
#include "renderer/cache/surface_points.hpp"
#include "tests/gpu/kernel.hpp"
#include "tests/support/scene_builder.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kPoints = 4096, kClusters = 16, kKnownSlots = 32;
constexpr float kUnknown = 1e9f;  // what points hold that nobody may read

/// Points of a scene whose first slots were given indirect light by the test, spread to all others.
class Spread {
 public:
  using Given = std::function<shared::PointLight(const shared::SurfacePoint&)>;

  Spread(const SceneBuilder& b, const Given& given) {
    vk::Device& device = SharedDevice::get();
    gpu::DeviceScene mirror(device);
    ChangeSet everything;
    everything.everything = true;
    must(mirror.sync(b.scene, everything));
    (void)must(m_points.update(device, b.scene, mirror, kPoints, kClusters, 1));
    PointGrid grid;
    must(grid.update(device, m_points, kKnownSlots));

    const PointLayout layout{m_points.clusterCount(), m_points.clusterSize()};
    const SceneTracer unused;
    const PointLightContext context{device, mirror, unused, m_points.bindings()};
    PointLightCache cache;
    must(cache.resize(device, layout, false));
    must(cache.prepareSpread(context, grid.bindings()));
    std::vector<shared::PointLight> before;
    const glm::vec3 unknown(kUnknown);
    for (uint32_t i = 0; i < m_points.count(); ++i)
      before.push_back(known(i) ? given(m_points.points()[i])
                                : shared::PointLight{{1, 1, 1}, {2, 2, 2}, unknown, unknown});
    const vk::Buffer source = inputOf(before);
    must(gpu::runNow(device, [&](vk::CommandRecorder& r) {
      r.copyBuffer(source, 0, cache.light(), 0, source.size());
      r.barrier();
      cache.recordSpread(r, context, grid.bindings(), {kKnownSlots, layout.clusterSize});
    }));
    light = must(vk::readBackArray<shared::PointLight>(device, cache.light(), m_points.count()));
  }

  bool known(uint32_t point) const { return point % m_points.clusterSize() < kKnownSlots; }
  glm::vec3 position(uint32_t point) const { return m_points.points()[point].posR; }
  uint32_t count() const { return m_points.count(); }

  std::vector<shared::PointLight> light;

 private:
  SurfacePoints m_points;
};

shared::PointLight indirect(float front, float back) { return {{}, {}, glm::vec3(front), glm::vec3(back)}; }

SceneBuilder floorOfTwoMetres() {
  SceneBuilder b;
  b.quad(b.diffuse(glm::vec3(0.5f)), {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
  return b;
}

TEST(PointSpread, KeepsAConstantAndTheSidesApart) {
  const Spread spread(floorOfTwoMetres(), [](const auto&) { return indirect(3.0f, 0.25f); });
  for (uint32_t i = 0; i < spread.count(); ++i) {
    EXPECT_NEAR(spread.light[i].indirectFront.g, 3.0f, 1e-5f) << i;
    EXPECT_NEAR(spread.light[i].indirectBack.b, 0.25f, 1e-6f) << i;
  }
}

TEST(PointSpread, FollowsAGradientAndLeavesTheRestAlone) {
  const auto ramp = [](const glm::vec3& p) { return 2.0f + p.x - 0.5f * p.z; };
  const Spread spread(floorOfTwoMetres(), [&](const auto& p) { return indirect(ramp(p.posR), 0.0f); });
  double error = 0.0;
  for (uint32_t i = 0; i < spread.count(); ++i) {
    const float expected = ramp(spread.position(i)), found = spread.light[i].indirectFront.r;
    EXPECT_NEAR(found, expected, spread.known(i) ? 0.0f : 0.25f) << i;
    error += std::abs(found - expected) / spread.count();
    EXPECT_EQ(spread.light[i].directFront, spread.known(i) ? glm::vec3(0.0f) : glm::vec3(1.0f));
    EXPECT_EQ(spread.light[i].directBack, spread.known(i) ? glm::vec3(0.0f) : glm::vec3(2.0f));
  }
  EXPECT_LT(error, 0.03);
}

TEST(PointSpread, StoreysDoNotMix) {
  SceneBuilder b = floorOfTwoMetres();
  b.quad(0, {-1, 0.4f, 1}, {1, 0.4f, 1}, {1, 0.4f, -1}, {-1, 0.4f, -1});
  const auto storey = [](const glm::vec3& p) { return p.y > 0.2f ? 7.0f : 1.0f; };
  const Spread spread(b, [&](const auto& p) { return indirect(storey(p.posR), storey(p.posR)); });
  for (uint32_t i = 0; i < spread.count(); ++i)
    EXPECT_NEAR(spread.light[i].indirectFront.r, storey(spread.position(i)), 1e-4f) << i;
}

/// Small cards that lie on the floor face down, so that their sides are the other way round.
TEST(PointSpread, ASideWithoutNeighboursOfItsKindAsksAllSurfaces) {
  constexpr uint32_t kCards = 16;
  SceneBuilder b = floorOfTwoMetres();
  for (uint32_t i = 0; i < kCards; ++i) {
    const float x = -0.75f + 0.5f * float(i % 4), z = -0.75f + 0.5f * float(i / 4), y = 0.001f, r = 0.03f;
    b.quad(0, {x - r, y, z - r}, {x + r, y, z - r}, {x + r, y, z + r}, {x - r, y, z + r});
  }
  const auto onCard = [](const glm::vec3& p) { return p.y > 0.0005f; };
  const Spread spread(b, [&](const auto& p) { return onCard(p.posR) ? indirect(5, 1) : indirect(1, 5); });
  std::vector<uint32_t> known(kCards, 0), unknown(kCards, 0);
  for (uint32_t i = 0; i < spread.count(); ++i) {
    const glm::vec3 p = spread.position(i);
    EXPECT_NEAR(spread.light[i].indirectFront.r, onCard(p) ? 5.0f : 1.0f, 1e-4f) << i;
    EXPECT_NEAR(spread.light[i].indirectBack.r, onCard(p) ? 1.0f : 5.0f, 1e-4f) << i;
    if (onCard(p)) ++(spread.known(i) ? known : unknown)[uint32_t((p.z + 1) / 0.5f) * 4 + uint32_t((p.x + 1) / 0.5f)];
  }
  uint32_t alone = 0;
  for (uint32_t i = 0; i < kCards; ++i) alone += known[i] == 0 && unknown[i] > 0;
  EXPECT_GT(alone, 2u) << "cards of which the grid knows no point";
}

}  // namespace
}  // namespace limn::test
