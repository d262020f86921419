// Look-ups of shaders/lib/point_grid.glsl against sums over all points on the host.
#include <cmath>
#include <random>

#include "renderer/cache/point_grid.hpp"
#include "shaders/shared/bindings.h"
#include "tests/gpu/kernel.hpp"
#include "tests/gpu/point_grid.spv.hpp"
#include "tests/support/scene_builder.hpp"

namespace limn::test {
namespace {

enum Sides : uint32_t { front, back, either };  // of shaders/lib/point_grid.glsl

struct Query {
  glm::vec3 posR, normal;
  uint32_t sides;
};
struct GridLight {
  glm::vec3 indirect;
  float weight;
};
static_assert(sizeof(Query) == 28 && sizeof(GridLight) == 16);

vk::Device& device() { return SharedDevice::get(); }

/// Points of a scene on the device, with light of their own.
struct Lit {
  gpu::DeviceScene mirror{device()};
  SurfacePoints points;
  PointGrid grid;
  std::vector<shared::PointLight> light;
  vk::Buffer lightBuffer;

  Lit(const Scene& scene, uint32_t count, uint32_t clusters) {
    ChangeSet everything;
    everything.everything = true;
    must(mirror.sync(scene, everything));
    must(points.update(device(), scene, mirror, count, clusters, 1));
  }

  /// Lights every point by `indirect(point, side)` and builds the grid over the first `slots` of each cluster.
  template <class Indirect>
  void fill(uint32_t slots, const Indirect& indirect) {
    must(grid.update(device(), points, slots));
    light.assign(std::max(points.count(), 1u), {});
    for (uint32_t i = 0; i < points.count(); ++i) {
      light[i].indirectFront = indirect(points.points()[i], 0);
      light[i].indirectBack = indirect(points.points()[i], 1);
    }
    lightBuffer = inputOf(light);
  }

  std::vector<GridLight> lookUp(const std::vector<Query>& queries) const {
    const vk::Buffer in = inputOf(queries);
    std::vector<vk::Binding> bindings = gpu::joined(grid.bindings(), {points.bindings()[0]});
    bindings.push_back(vk::storage(BINDING_POINT_LIGHT, lightBuffer));
    bindings.push_back(vk::storage(60, in));
    return runKernel<GridLight>(std::span<const uint32_t>(point_gridSpirv), bindings, uint32_t(queries.size()),
                                queries.size(), groupsFor(queries.size()));
  }

  GridLight bruteForce(const Query& q, uint32_t slots) const {
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (uint32_t i = 0; i < points.count(); ++i) {
      if (i % points.clusterSize() >= slots) continue;
      const shared::SurfacePoint& p = points.points()[i];
      const float cosine = glm::dot(normalOf(p), q.normal);
      const bool useBack = q.sides == either ? cosine < 0.0f : q.sides == back;
      const double w = pointWeight(p.posR - q.posR, q.normal, useBack ? -cosine : cosine, grid.radius());
      sum += w * glm::dvec3(useBack ? light[i].indirectBack : light[i].indirectFront);
      weights += w;
    }
    return {weights > 0.0 ? glm::vec3(sum / weights) : glm::vec3(0.0f), float(weights)};
  }

  static glm::vec3 normalOf(const shared::SurfacePoint& p) {
    const glm::vec2 e = glm::unpackSnorm2x16(p.normal);
    glm::vec3 v(e, 1.0f - std::abs(e.x) - std::abs(e.y));
    if (v.z < 0.0f)
      v = {(1.0f - std::abs(e.y)) * (e.x >= 0.0f ? 1.0f : -1.0f), (1.0f - std::abs(e.x)) * (e.y >= 0.0f ? 1.0f : -1.0f),
           v.z};
    return glm::normalize(v);
  }
};

/// Light that tells place, normal and side apart.
glm::vec3 pattern(const shared::SurfacePoint& p, int side) {
  return glm::vec3(2.0f + std::sin(7.0f * p.posR.x), 2.0f + std::cos(5.0f * p.posR.z), 1.0f + float(side));
}

TEST(PointGridLookUp, IsTheSumOverAllPoints) {
  Lit lit(cornellLike().scene, 8192, 64);
  constexpr uint32_t kSlots = 40;
  lit.fill(kSlots, pattern);
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::vector<Query> queries;
  for (uint32_t i = 0; i < 3000; ++i) {
    const shared::SurfacePoint& p = lit.points.points()[(i * 977) % lit.points.count()];
    const glm::vec3 jitter = glm::vec3(normal(random), normal(random), normal(random)) * 0.2f;
    const glm::vec3 n = Lit::normalOf(p) * (i % 2 ? -1.0f : 1.0f);
    queries.push_back({p.posR + jitter * lit.grid.radius(), glm::normalize(n + jitter), i % 3});
  }
  queries.push_back({glm::vec3(1e9f), {0, 1, 0}, either});
  const std::vector<GridLight> found = lit.lookUp(queries);
  uint32_t known = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const GridLight expected = lit.bruteForce(queries[i], kSlots);
    ASSERT_NEAR(found[i].weight, expected.weight, 1e-4f + 1e-3f * expected.weight) << i;
    known += expected.weight > 0.1f;
    if (expected.weight < 0.01f) continue;
    for (int k = 0; k < 3; ++k)
      ASSERT_NEAR(found[i].indirect[k], expected.indirect[k], 3e-3f * expected.indirect[k]) << i;
  }
  EXPECT_GT(known, 1500u);
  EXPECT_EQ(found.back().weight, 0.0f);
  EXPECT_EQ(found.back().indirect, glm::vec3(0.0f));
}

/// Amid an even surface every place is near some points, of any part of the set.
TEST(PointGridLookUp, KnowsEveryPlaceOfASurface) {
  SceneBuilder b;
  b.quad(b.diffuse(glm::vec3(0.5f)), {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0});
  Lit lit(b.scene, 4096, 32);
  for (const uint32_t slots : {1u, 5u, 32u, 128u}) {
    lit.fill(slots, [](const shared::SurfacePoint&, int side) { return glm::vec3(side == 0 ? 3.0f : 1.0f); });
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit;
    std::vector<Query> queries;
    for (int i = 0; i < 2000; ++i) queries.push_back({{unit(random), 0.0f, unit(random)}, {0, 1, 0}, either});
    float least = 1e9f, mean = 0.0f;
    for (const GridLight& light : lit.lookUp(queries)) {
      least = std::min(least, light.weight);
      mean += light.weight / 2000.0f;
      ASSERT_NEAR(light.indirect.x, 3.0f, 1e-5f);
    }
    std::cout << slots << " slots: weights of " << least << " at least, " << mean << " in the mean\n";
    EXPECT_GT(least, 0.1f) << slots;
  }
}

/// Light of one face of a thin plate, or of the wall behind, does not show on the other.
TEST(PointGridLookUp, FacesOfAThinPlateAreApart) {
  SceneBuilder b;
  b.box(b.diffuse(glm::vec3(0.5f)), {0, 0, 0}, {1, 0.001f, 1});
  Lit lit(b.scene, 4096, 32);
  // Outside: 1 above, 0 below; the dark inside is black.
  lit.fill(128, [](const shared::SurfacePoint& p, int side) {
    return glm::vec3(side == 0 && Lit::normalOf(p).y > 0.5f ? 1.0f : 0.0f);
  });
  const std::vector<GridLight> found =
      lit.lookUp({{{0.5f, 0.001f, 0.5f}, {0, 1, 0}, front}, {{0.5f, 0.0f, 0.5f}, {0, -1, 0}, front}});
  EXPECT_NEAR(found[0].indirect.x, 1.0f, 1e-5f);
  EXPECT_NEAR(found[1].indirect.x, 0.0f, 1e-5f);
  EXPECT_GT(std::min(found[0].weight, found[1].weight), 0.1f);
}

TEST(PointGridLookUp, NothingIsKnownWithoutPoints) {
  Lit lit(SceneBuilder().scene, 4096, 32);
  EXPECT_EQ(lit.points.count(), 0u);
  lit.fill(0, pattern);
  EXPECT_EQ(lit.lookUp({{{0.0f, 0.0f, 0.0f}, {0, 1, 0}, either}})[0].weight, 0.0f);
}

}  // namespace
}  // namespace limn::test
