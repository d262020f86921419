#include "renderer/visibility/bvh.hpp"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <numeric>

#include "renderer/gpu/pass.hpp"
#include "tests/gpu/bvh_reference.hpp"
#include "tests/gpu/bvh_scenes.hpp"
#include "tests/gpu/vk/vk_fixture.hpp"

namespace limn::test {
namespace {

using vk::must;

class BvhTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { s_device = new vk::ValidatedDevice(); }
  static void TearDownTestSuite() {
    s_passes.clear();
    delete s_device;
  }
  static vk::Device& device() { return **s_device; }

  static SceneBvh fresh(const Soup& soup) {
    SceneBvh bvh;
    must(bvh.update(device(), soup.blocks(), {}));
    return bvh;
  }

  /// `shader`: one of trace_closest, trace_any and their _alpha variants.
  static std::vector<RayHit> trace(const SceneBvh& bvh, const std::vector<Ray>& rays, const std::string& shader) {
    vk::BufferDesc desc{rays.size() * sizeof(Ray), vk::BufferUsage::texel, vk::MemoryKind::upload, "rays", "test",
                        VK_FORMAT_R32G32B32A32_SFLOAT};
    vk::Buffer in = must(vk::createBufferWith(device(), desc, std::span(rays)));
    desc = {rays.size() * sizeof(RayHit), vk::BufferUsage::storage, vk::MemoryKind::readback, "hits", "test"};
    vk::Buffer out = must(vk::Buffer::create(device(), desc));
    const std::vector<vk::Binding> bindings{vk::texel(0, bvh.nodes()), vk::texel(1, bvh.triangles()), vk::texel(2, in),
                                            vk::storage(3, out)};
    gpu::Pass& pass = s_passes[shader];
    if (!pass) pass = must(gpu::Pass::create(device(), shader, bindings, 4));
    const uint32_t count = uint32_t(rays.size());
    must(gpu::runNow(
        device(), [&](vk::CommandRecorder& recorder) { pass.record(recorder, bindings, count, (count + 63) / 64); }));
    return must(vk::readBackArray<RayHit>(device(), out, rays.size()));
  }

  static std::pair<std::vector<std::byte>, std::vector<std::byte>> content(const SceneBvh& bvh) {
    return {must(vk::readBack(device(), bvh.nodes(), 0, bvh.nodes().size())),
            must(vk::readBack(device(), bvh.triangles(), 0, bvh.triangles().size()))};
  }

  /// Closest hits against the reference, any hits against closest hits, lowest id among identical triangles.
  static void checkTracing(const Soup& soup, const std::vector<Ray>& rays, const std::string& name) {
    const SceneBvh bvh = fresh(soup);
    const std::vector<glm::vec3> corners = soup.corners();
    const std::vector<RayHit> closest = trace(bvh, rays, "trace_closest"), any = trace(bvh, rays, "trace_any");
    int wrong = 0;
    for (size_t i = 0; i < rays.size() && wrong < 3; ++i) {
      std::string verdict = judge(rays[i], closest[i], corners);
      if ((closest[i].triangle == shared::kNoTriangle) != (any[i].triangle == shared::kNoTriangle))
        verdict = "any-hit disagrees";
      for (uint32_t twin = 0; closest[i].triangle != shared::kNoTriangle && twin < closest[i].triangle; ++twin) {
        const size_t hit = 3 * size_t(closest[i].triangle);
        if (std::equal(&corners[hit], &corners[hit] + 3, &corners[3 * size_t(twin)]))
          verdict = "not the lowest of identical ids";
      }
      if (verdict.empty()) continue;
      ++wrong;
      const Ray& r = rays[i];
      ADD_FAILURE() << name << ", ray " << i << ": " << verdict << "\norigin " << r.originR.x << ' ' << r.originR.y
                    << ' ' << r.originR.z << " direction " << r.dirR.x << ' ' << r.dirR.y << ' ' << r.dirR.z
                    << " tMax " << r.tMax;
    }
  }

 private:
  static inline vk::ValidatedDevice* s_device = nullptr;
  static inline std::map<std::string, gpu::Pass> s_passes;
};

class BvhSeedTest : public BvhTest, public testing::WithParamInterface<uint32_t> {};

TEST_P(BvhSeedTest, EqualsBruteForce) {
  const Soup soup = randomSoup(GetParam());
  checkTracing(soup, randomRays(soup, GetParam(), 400), "seed " + std::to_string(GetParam()));
}

TEST_P(BvhSeedTest, AlphaIsAsked) {
  const uint32_t seed = GetParam();
  const Soup soup = randomSoup(seed);
  const std::vector<Ray> rays = randomRays(soup, seed, 200);
  const SceneBvh bvh = fresh(soup);
  const std::vector<RayHit> closest = trace(bvh, rays, "trace_closest_alpha"),
                            any = trace(bvh, rays, "trace_any_alpha");
  std::vector<bool> tested;
  for (const Object& object : soup.objects)
    tested.resize(tested.size() + object.corners.size() / 3, object.alphaTested);
  // The rule of trace_rays.comp, left open where rounding could decide.
  const Accepts accepts = [&](uint32_t triangle, glm::dvec2 barycentrics) -> std::optional<bool> {
    if (!tested[triangle]) return true;
    if (std::abs(barycentrics.x - 0.3) < 1e-3) return std::nullopt;
    return ((triangle ^ uint32_t(barycentrics.x > 0.3)) & 1u) == 0u;
  };
  const std::vector<glm::vec3> corners = soup.corners();
  for (size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(judge(rays[i], closest[i], corners, accepts), "") << "seed " << seed << " ray " << i;
    ASSERT_EQ(closest[i].triangle == shared::kNoTriangle, any[i].triangle == shared::kNoTriangle)
        << "seed " << seed << " ray " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, BvhSeedTest, testing::Range(1u, 101u));

TEST_F(BvhTest, NothingIsHitWhereThereIsNothing) {
  const std::vector<Ray> rays = randomRays({}, 1, 100);
  const glm::vec3 a(0.5f), b(0.6f, 0.7f, 0.8f);
  const Soup soups[] = {{}, {{{}, {}}}, {{{{a, a, a}}}}, {{{{a, b, b}}, {{a, b, (a + b) * 0.5f}}}}};
  for (const Soup& soup : soups) {
    const SceneBvh bvh = fresh(soup);
    for (const RayHit& hit : trace(bvh, rays, "trace_closest")) ASSERT_EQ(hit.triangle, shared::kNoTriangle);
  }
}

TEST_F(BvhTest, OneTriangleIsHit) {
  const Soup soup{{{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}}}};
  const std::vector<RayHit> hits = trace(fresh(soup), {{{0.25f, 0.5f, 0}, 1e30f, {0, 0, 2}, 0}}, "trace_closest");
  EXPECT_EQ(hits[0].triangle, 0u);
  EXPECT_FLOAT_EQ(hits[0].t, 0.5f);
  EXPECT_FLOAT_EQ(hits[0].barycentrics.x, 0.25f);
  EXPECT_FLOAT_EQ(hits[0].barycentrics.y, 0.5f);
}

TEST_F(BvhTest, TheIntervalIsOpen) {
  const Soup soup{{{{{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}}}}};
  const std::vector<Ray> rays{
      {{0, 0, 0}, 1.0f, {0, 0, 1}, 0}, {{0, 0, 0}, 1.0001f, {0, 0, 1}, 0}, {{0, 0, 1}, 9, {0, 0, 1}, 0}};
  const std::vector<RayHit> hits = trace(fresh(soup), rays, "trace_closest");
  EXPECT_EQ(hits[0].triangle, shared::kNoTriangle);
  EXPECT_EQ(hits[1].triangle, 0u);
  EXPECT_EQ(hits[2].triangle, shared::kNoTriangle);
}

TEST_F(BvhTest, ClosedSurfaceHasNoGaps) {
  for (const float distance : {0.0f, 1e3f}) {
    for (const float radius : {1e-3f, 1.0f, 1e3f}) {
      const glm::vec3 center = glm::vec3(0.3f, -0.2f, 0.9f) * distance * radius;
      const Soup soup{{bumpySphere(center, radius, 40)}};
      std::vector<Ray> rays;
      Random random(7);
      for (size_t i = 0; i < soup.objects[0].corners.size(); ++i) {
        const glm::vec3 a = soup.objects[0].corners[i], b = soup.objects[0].corners[i - i % 3 + (i + 1) % 3];
        const glm::vec3 origin = center + random.inCube() * radius * 0.3f;
        rays.push_back({origin, 1e30f, a - origin, 0});
        rays.push_back({origin, 1e30f, (a + b) * 0.5f - origin, 0});
        rays.push_back({origin, 1e30f, random.direction(), 0});
      }
      int gaps = 0;
      for (const RayHit& hit : trace(fresh(soup), rays, "trace_closest")) gaps += hit.triangle == shared::kNoTriangle;
      EXPECT_EQ(gaps, 0) << "of " << rays.size() << " at radius " << radius << " and " << distance
                         << " radii from the origin";
    }
  }
}

TEST_F(BvhTest, ShellsInShellsStayLow) {
  // Each triangle holds all smaller ones: splitting by surface peels them off one by one, deeper than the stack.
  Soup soup{{{}, {}}};
  for (int i = 0; i < 400; ++i) {
    const float s = std::pow(2.0f, float(i - 200) * 0.25f);
    soup.objects[0].corners.insert(soup.objects[0].corners.end(), {{-s, -s, s}, {s, -s, s * 0.9f}, {0, s, s * 1.1f}});
    soup.objects[1].corners.insert(soup.objects[1].corners.end(), {{-s, -s, -s}, {s, -s, -s}, {0, s, -s}});
  }
  for (int i = 0; i < 300; ++i)
    soup.objects.push_back({{{float(1 << (i % 24)), 0, 0}, {float(1 << (i % 24)), 1, 0}, {0, 1, 2}}});
  std::vector<Ray> rays;
  Random random(3);
  for (int i = 0; i < 300; ++i)
    rays.push_back({random.inCube() * std::pow(2.0f, random.between(-55, 55)), 1e36f, random.direction(), 0});
  for (int i = 0; i < 300; ++i) rays.push_back({glm::vec3(0), 1e36f, random.direction(), 0});
  checkTracing(soup, rays, "shells");
}

TEST_F(BvhTest, ManySmallBlocks) {
  Random random(11);
  Soup soup;
  for (int i = 0; i < 3000; ++i) {
    soup.objects.push_back(randomObject(random, 1 + random.below(4)));
    const glm::vec3 place = random.inCube() * 20.0f;
    for (glm::vec3& corner : soup.objects.back().corners) corner = corner * 0.5f + place;
  }
  checkTracing(soup, randomRays(soup, 11, 300), "many blocks");
}

TEST_F(BvhTest, MovingAnObjectRebuildsItAlone) {
  Soup soup = randomSoup(5);
  SceneBvh bvh = fresh(soup);
  EXPECT_EQ(bvh.stats().blocksRebuilt, soup.objects.size());
  const uint32_t moved = 2;
  for (glm::vec3& corner : soup.objects[moved].corners) corner = corner * 1.5f + glm::vec3(0.1f);
  must(bvh.update(device(), soup.blocks(), std::vector{moved}));
  EXPECT_EQ(bvh.stats().blocksRebuilt, 1u);
  EXPECT_EQ(content(bvh), content(fresh(soup)));
  must(bvh.update(device(), soup.blocks(), {}));
  EXPECT_EQ(bvh.stats().blocksRebuilt, 0u);
  EXPECT_EQ(content(bvh), content(fresh(soup)));
}

TEST_F(BvhTest, MoreTrianglesThanItCountsAreRefused) {
  const size_t most = shared::kBvhBaseMask;
  const auto corners = std::make_unique_for_overwrite<glm::vec3[]>(3 * (most + 1));  // never looked at
  const std::vector<TriangleBlock> one{{{corners.get(), 3 * (most + 1)}, 0}};
  const std::vector<TriangleBlock> two{{{corners.get(), 3 * (most / 2)}, 0}, {{corners.get(), 3 * (most / 2 + 1)}, uint32_t(most / 2)}};
  for (const std::vector<TriangleBlock>& blocks : {one, two}) {
    SceneBvh bvh;
    const Result<void> updated = bvh.update(device(), blocks, {});
    ASSERT_FALSE(updated.ok());
    EXPECT_EQ(updated.error().code, "limit");
  }
}

class BvhHistoryTest : public BvhTest, public testing::WithParamInterface<uint32_t> {};

TEST_P(BvhHistoryTest, LeavesNoTrace) {
  const uint32_t seed = GetParam();
  Random random(seed);
  Soup soup = randomSoup(seed);
  SceneBvh bvh = fresh(soup);
  for (int step = 0; step < 10; ++step) {
    std::vector<uint32_t> changed;
    bool tellAll = random.below(5) == 0;
    if (tellAll) soup = randomSoup(seed + 1000 * random.below(3));
    const float scale = soup.objects[0].corners.empty() ? 1.0f : glm::length(soup.objects[0].corners[0]);
    for (uint32_t n = random.below(4); n > 0; --n) {
      changed.push_back(random.below(uint32_t(soup.objects.size())));
      Object& object = soup.objects[changed.back()];
      if (random.below(6) == 0) {
        object.corners.resize(object.corners.size() / 6 * 3);
        tellAll = true;  // the ids of later blocks moved
      }
      for (glm::vec3& corner : object.corners) corner += random.inCube() * scale * 0.01f;
    }
    if (tellAll) {
      changed.resize(soup.objects.size());
      std::iota(changed.begin(), changed.end(), 0u);
    }
    must(bvh.update(device(), soup.blocks(), changed));
    EXPECT_EQ(bvh.stats().blocksRebuilt, changed.size());
  }
  EXPECT_EQ(content(bvh), content(fresh(soup))) << "seed " << seed;
}

INSTANTIATE_TEST_SUITE_P(Seeds, BvhHistoryTest, testing::Range(200u, 220u));

}  // namespace
}  // namespace limn::test
