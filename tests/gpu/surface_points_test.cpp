// Points that ride on the surfaces of a scene through its edits.
#include "renderer/cache/surface_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "shaders/shared/bindings.h"
#include "tests/gpu/kernel.hpp"
#include "tests/support/scene_builder.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kCount = 4096, kClusters = 32, kSeed = 7;

vk::Device& device() { return SharedDevice::get(); }

/// A scene with its mirror and its points.
struct World {
  Scene scene;
  gpu::DeviceScene mirror{device()};
  SurfacePoints points;

  explicit World(Scene s) : scene(std::move(s)) {
    ChangeSet everything;
    everything.everything = true;
    must(mirror.sync(scene, everything));
  }
  SurfacePoints::Update update(uint32_t count = kCount, uint32_t clusters = kClusters) {
    return must(points.update(device(), scene, mirror, count, clusters, kSeed));
  }
  /// Changes a node and brings all up to date.
  template <class Change>
  SurfacePoints::Update edit(uint32_t node, const Change& change) {
    change(scene.nodes[node].parentFromLocal);
    ChangeSet changes;
    changes.nodes = {node};
    must(mirror.sync(scene, changes));
    return update();
  }
};

using Site = std::tuple<uint32_t, float, float>;
std::vector<Site> sortedSites(const SurfacePoints& points) {
  std::vector<Site> sites;
  for (const shared::PointSite& s : points.sites()) sites.push_back({s.triangle, s.barycentrics.x, s.barycentrics.y});
  std::sort(sites.begin(), sites.end());
  return sites;
}

template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// What the device holds is what the host says, and that is what a new world of the same scene would hold.
void expectFresh(World& world) {
  World fresh(world.scene);
  fresh.update();
  ASSERT_TRUE(sameBits(world.points.points(), fresh.points.points()));
  ASSERT_TRUE(sameBits(world.points.sites(), fresh.points.sites()));
  EXPECT_EQ(world.points.areaPerPoint(), fresh.points.areaPerPoint());
  EXPECT_EQ(world.points.relativeRadius(), fresh.points.relativeRadius());
}

/// Nodes of cornellLike().
constexpr uint32_t kFloor = 0, kBox = 5, kSphere = 6;

TEST(SurfacePoints, SharesOutTheWholeSurface) {
  World world(cornellLike().scene);
  const SurfacePoints::Update done = world.update(4090);
  EXPECT_TRUE(done.changed);
  EXPECT_EQ(done.sampledBlocks, 8u);
  EXPECT_EQ(world.points.count(), kCount);
  EXPECT_EQ(world.points.clusterSize(), kCount / kClusters);
  double area = 0.0;
  for (const gpu::GeometryBlock& block : world.mirror.blocks()) area += areaOf(block.corners);
  EXPECT_NEAR(world.points.areaPerPoint() * kCount, area, 1e-9 * area);
  EXPECT_GE(world.points.relativeRadius(), 0.6);
  std::cout << "relative radius " << world.points.relativeRadius() << '\n';

  // Every block has its share to a point and the rounding of its metric.
  for (const gpu::GeometryBlock& block : world.mirror.blocks()) {
    const auto inBlock = [&](const shared::PointSite& s) {
      return s.triangle >= block.firstTriangle && s.triangle < block.firstTriangle + block.triangleCount();
    };
    const double share = kCount * areaOf(block.corners) / area;
    EXPECT_NEAR(double(std::count_if(world.points.sites().begin(), world.points.sites().end(), inBlock)), share, 1.0);
  }
}

TEST(SurfacePoints, DeviceHoldsWhatTheHostSays) {
  World world(cornellLike().scene);
  world.update();
  const std::vector<vk::Binding> bindings = world.points.bindings();
  ASSERT_EQ(bindings.size(), 2u);
  EXPECT_EQ(bindings[0].binding, uint32_t(BINDING_POINTS));
  EXPECT_EQ(bindings[1].binding, uint32_t(BINDING_POINT_SITES));
  EXPECT_TRUE(sameBits(must(vk::readBackArray<shared::SurfacePoint>(device(), *bindings[0].buffer, kCount)),
                       world.points.points()));
  EXPECT_TRUE(sameBits(must(vk::readBackArray<shared::PointSite>(device(), *bindings[1].buffer, kCount)),
                       world.points.sites()));
}

TEST(SurfacePoints, MovingAndTurningKeepsTheSites) {
  World world(cornellLike().scene);
  world.update();
  const std::vector<Site> before = sortedSites(world.points);
  const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(0.3, 1.0, 0.2)));
  const SurfacePoints::Update done = world.edit(kBox, [&](Transform& t) {
    t.translation = {0.2, 0.1, 0.3};
    t.rotation = turn;
  });
  EXPECT_TRUE(done.changed);
  EXPECT_EQ(done.sampledBlocks, 0u);
  EXPECT_EQ(sortedSites(world.points), before);
  expectFresh(world);
}

/// The points of a moved object are where the motion takes them.
TEST(SurfacePoints, PointsFollowTheirTriangles) {
  World still(cornellLike().scene), moved(cornellLike().scene);
  still.update();
  moved.update();
  const glm::dvec3 shift(0.2, 0.1, 0.3);
  const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(0.3, 1.0, 0.2)));
  moved.edit(kSphere, [&](Transform& t) {
    t.translation = shift;
    t.rotation = turn;
  });
  const auto byPlace = [](const World& world) {
    std::vector<std::pair<Site, shared::SurfacePoint>> all;
    for (uint32_t i = 0; i < world.points.count(); ++i) {
      const shared::PointSite& s = world.points.sites()[i];
      all.push_back({{s.triangle, s.barycentrics.x, s.barycentrics.y}, world.points.points()[i]});
    }
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    return all;
  };
  const auto a = byPlace(still), b = byPlace(moved);
  const gpu::GeometryBlock& sphere = still.mirror.blocks()[kSphere];
  for (size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].first, b[i].first);
    const uint32_t triangle = std::get<0>(a[i].first);
    const bool rides = triangle >= sphere.firstTriangle && triangle < sphere.firstTriangle + sphere.triangleCount();
    const glm::dvec3 p(a[i].second.posR);
    ASSERT_LT(glm::distance(glm::dvec3(b[i].second.posR), rides ? turn * p + shift : p), 1e-6);
  }
}

TEST(SurfacePoints, NormalsFollowTheWindingOfMirroredObjectsToo) {
  SceneBuilder b;
  const uint32_t sphere = b.sphere(b.diffuse(glm::vec3(0.5f)), {0, 0, 0}, 1.0f, 16);
  for (const double x : {1.0, -1.0}) {
    b.scene.nodes[sphere].parentFromLocal.scale = {x, 1.0, 1.0};
    World world(b.scene);
    world.update();
    for (uint32_t i = 0; i < world.points.count(); ++i) {
      const shared::SurfacePoint& p = world.points.points()[i];
      const shared::PointSite& s = world.points.sites()[i];
      const glm::vec3* c = &world.mirror.blocks()[0].corners[size_t(s.triangle) * 3];
      const glm::vec3 at = c[0] + (c[1] - c[0]) * s.barycentrics.x + (c[2] - c[0]) * s.barycentrics.y;
      ASSERT_LT(glm::distance(at, p.posR), 1e-6f);
      const glm::dvec3 a(c[0]);
      const glm::vec3 n(glm::normalize(glm::cross(glm::dvec3(c[1]) - a, glm::dvec3(c[2]) - a)));
      ASSERT_GT(glm::dot(n, p.posR), 0.9f);
      ASSERT_EQ(p.normal, gpu::octEncode(n));
    }
  }
}

TEST(SurfacePoints, SamplesOnlyWhatChangedItsSize) {
  World world(cornellLike().scene);
  world.update();
  EXPECT_FALSE(world.update().changed);
  EXPECT_EQ(world.edit(kSphere, [](Transform& t) { t.scale = glm::dvec3(1.001); }).sampledBlocks, 0u);
  expectFresh(world);
  const SurfacePoints::Update grown = world.edit(kSphere, [](Transform& t) { t.scale = glm::dvec3(1.5); });
  EXPECT_GE(grown.sampledBlocks, 1u);
  EXPECT_LT(grown.sampledBlocks, 8u);
  expectFresh(world);
}

/// However an object came to where it is.
TEST(SurfacePoints, EditsThenUpdateIsAFreshLoad) {
  World world(cornellLike().scene);
  world.update();
  for (int i = 1; i <= 6; ++i) {
    world.edit(i % 2 ? kSphere : kBox, [&](Transform& t) {
      t.translation.x = 0.1 * i;
      t.rotation = glm::angleAxis(0.3 * i, glm::dvec3(0, 1, 0));
      t.scale = glm::dvec3(i == 3 ? 0.0 : i == 4 ? -1.5 : 1.0 + 0.2 * i, 1.0, 1.0 + 0.01 * i);
    });
    expectFresh(world);
  }
}

TEST(SurfacePoints, CountAndClustersMayChange) {
  World world(cornellLike().scene);
  world.update();
  EXPECT_TRUE(world.update(kCount, 64).changed);
  EXPECT_EQ(world.points.clusterCount(), 64u);
  EXPECT_TRUE(world.update(2 * kCount, 64).changed);
  EXPECT_EQ(world.points.count(), 2 * kCount);
  world.update();
  expectFresh(world);
}

TEST(SurfacePoints, HardScenes) {
  SceneBuilder one;
  Primitive triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.normals.assign(3, {0, 0, 1});
  triangle.indices = {0, 1, 2};
  const uint32_t node = one.mesh(triangle);
  for (const double scale : {1.0, 1e6, 1e-6}) {
    one.scene.nodes[node].parentFromLocal.scale = glm::dvec3(scale);
    World world(one.scene);
    world.update();
    EXPECT_EQ(world.points.count(), kCount);
    EXPECT_GE(world.points.relativeRadius(), 0.6);
    EXPECT_NEAR(world.points.areaPerPoint() * kCount, 0.5 * scale * scale, 1e-5 * scale * scale);
    for (const shared::SurfacePoint& p : world.points.points())
      ASSERT_TRUE(std::isfinite(p.posR.x + p.posR.y) && p.posR.x >= 0.0f && p.posR.y >= 0.0f && p.posR.z == 0.0f);
  }

  one.scene.nodes[node].parentFromLocal.scale = glm::dvec3(0.0);
  for (const Scene& scene : {one.scene, SceneBuilder().scene}) {
    World world(scene);
    EXPECT_TRUE(world.update().changed);
    EXPECT_EQ(world.points.count(), 0u);
    EXPECT_EQ(world.points.clusterSize(), 0u);
    EXPECT_EQ(world.points.bindings().size(), 2u);
  }
}

}  // namespace
}  // namespace limn::test
