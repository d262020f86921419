#include <gtest/gtest.h>

#include <map>

#include "renderer/gpu/pass.hpp"
#include "renderer/visibility/scene_tracer.hpp"
#include "shaders/shared/bindings.h"
#include "tests/gpu/bvh_reference.hpp"
#include "tests/gpu/bvh_scenes.hpp"
#include "tests/support/path_tracer.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/shared_device.hpp"

namespace limn::test {
namespace {

vk::Device& device() { return SharedDevice::get(); }

/// Bumpy spheres of many scales in and beside each other, every third alpha-tested, and an object without triangles.
Soup spheres(uint32_t seed) {
  Random random(seed);
  Soup soup;
  for (int i = 0; i < 7; ++i) {
    const float radius = std::pow(2.0f, random.between(-3, 1));
    soup.objects.push_back(bumpySphere(random.inCube() * 2.0f, radius, 4 + int(random.below(20))));
    soup.objects.back().alphaTested = i % 3 == 0;
  }
  soup.objects.push_back({});
  return soup;
}

/// The rule of trace_rays.comp, left open where rounding could decide.
Accepts checkers(const Soup& soup) {
  std::vector<bool> tested;
  for (const Object& object : soup.objects)
    tested.resize(tested.size() + object.corners.size() / 3, object.alphaTested);
  return [tested](uint32_t triangle, glm::dvec2 barycentrics) -> std::optional<bool> {
    if (!tested[triangle]) return true;
    if (std::abs(barycentrics.x - 0.3) < 1e-3) return std::nullopt;
    return ((triangle ^ uint32_t(barycentrics.x > 0.3)) & 1u) == 0u;
  };
}

/// `tree` is what the shader of trace_rays.comp has at its first bindings.
std::vector<RayHit> trace(const std::vector<vk::Binding>& tree, const std::vector<Ray>& rays,
                          const std::string& shader) {
  static std::map<std::string, gpu::Pass> passes;
  if (passes.empty()) SharedDevice::atEnd([] { passes.clear(); });
  vk::BufferDesc desc{rays.size() * sizeof(Ray), vk::BufferUsage::texel, vk::MemoryKind::upload, "rays", "test",
                      VK_FORMAT_R32G32B32A32_SFLOAT};
  const vk::Buffer in = must(vk::createBufferWith(device(), desc, std::span(rays)));
  desc = {rays.size() * sizeof(RayHit), vk::BufferUsage::storage, vk::MemoryKind::readback, "hits", "test"};
  const vk::Buffer out = must(vk::Buffer::create(device(), desc));
  const auto bindings = gpu::joined(tree, {vk::texel(2, in), vk::storage(3, out)});
  gpu::Pass& pass = passes[shader + (tree.size() == 1 ? "+" : "")];
  if (!pass) pass = must(gpu::Pass::create(device(), shader, bindings, 4));
  const uint32_t count = uint32_t(rays.size());
  must(gpu::runNow(device(), [&](vk::CommandRecorder& r) { pass.record(r, bindings, count, (count + 63) / 64); }));
  return must(vk::readBackArray<RayHit>(device(), out, rays.size()));
}

/// Both trees of one soup.
struct BothTrees {
  explicit BothTrees(const Soup& soup) {
    must(bvh.update(device(), soup.blocks(), {}));
    must(acceleration.update(device(), soup.blocks(), {}));
  }
  std::vector<RayHit> walk(const std::vector<Ray>& rays, const std::string& shader) const {
    return trace({vk::texel(0, bvh.nodes()), vk::texel(1, bvh.triangles())}, rays, shader);
  }
  std::vector<RayHit> query(const std::vector<Ray>& rays, const std::string& shader) const {
    return trace({vk::acceleration(0, acceleration.top())}, rays, shader);
  }
  SceneBvh bvh;
  SceneAcceleration acceleration;
};

/// A device without ray queries says so; what it does instead is tested by bvh_test.
bool refusesAsItShould() {
  if (device().hasRayQuery()) return false;
  SceneTracer tracer(TraceMethod::rayQuery);
  const auto updated = tracer.update(device(), spheres(1).blocks(), {});
  EXPECT_FALSE(updated.ok());
  EXPECT_EQ(updated.error().code, "unsupported");
  return true;
}

/// Whether no rounding may decide what `ray` meets up to its end: it stays off every edge, off the borders of what the
/// alpha rule accepts, and crosses no plane at a grazing angle.
bool isClear(const Ray& ray, double end, std::span<const glm::vec3> corners, const Accepts& accepts) {
  const double length = glm::length(glm::dvec3(ray.dirR));
  for (uint32_t i = 0; i < corners.size() / 3; ++i) {
    const Crossing c = cross(ray, corners.subspan(3 * size_t(i), 3));
    if (c.inside < -20 * c.tolerance && !c.edgeOn) continue;
    const double tolerance = 20 * c.drift * (c.slope + 1 / length);
    if (c.edgeOn || (c.t > -tolerance && c.t < end + tolerance &&
                     (c.inside < 20 * c.tolerance || c.slope * length > 20 || !accepts(i, c.barycentrics))))
      return false;
  }
  return true;
}

/// The hits of the walk and of ray queries, which are the same where rounding has no say, and most rays are such.
void expectEqualHits(const std::vector<Ray>& rays, const std::vector<RayHit>& walk, const std::vector<RayHit>& query,
                     std::span<const glm::vec3> corners, const Accepts& accepts) {
  size_t clear = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const bool missed = walk[i].triangle == shared::kNoTriangle;
    if (!isClear(rays[i], missed ? rays[i].tMax : walk[i].t, corners, accepts)) continue;
    ++clear;
    ASSERT_EQ(walk[i].triangle, query[i].triangle) << "ray " << i;
    if (missed) continue;
    ASSERT_NEAR(walk[i].t, query[i].t, 1e-4f * walk[i].t) << "ray " << i;
    ASSERT_LT(glm::length(walk[i].barycentrics - query[i].barycentrics), 1e-3f) << "ray " << i;
  }
  EXPECT_GT(clear, rays.size() / 2);
}

TEST(RayQuery, TheDeviceDecidesWhichTreeIsBuilt) {
  const Soup soup = spheres(1);
  SceneTracer tracer;
  must(tracer.update(device(), soup.blocks(), {}));
  EXPECT_EQ(tracer.method(), device().hasRayQuery() ? TraceMethod::rayQuery : TraceMethod::walk);
  EXPECT_EQ(tracer.blocksRebuilt(), soup.objects.size());
  const auto bindings = tracer.bindings();
  if (device().hasRayQuery()) {
    ASSERT_EQ(bindings.size(), 1u);
    EXPECT_EQ(bindings[0].kind, vk::BindingKind::acceleration);
    EXPECT_EQ(bindings[0].binding, uint32_t(BINDING_ACCELERATION));
  } else {
    ASSERT_EQ(bindings.size(), 2u);
    EXPECT_EQ(bindings[0].kind, vk::BindingKind::texel);
  }
  must(tracer.update(device(), soup.blocks(), std::vector{2u}));
  EXPECT_EQ(tracer.blocksRebuilt(), 1u);
}

class RayQuerySeeds : public testing::TestWithParam<uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, RayQuerySeeds, testing::Range(1u, 21u));

TEST_P(RayQuerySeeds, HitsEqualTheWalk) {
  if (refusesAsItShould()) return;
  const Soup soup = spheres(GetParam());
  const BothTrees trees(soup);
  const std::vector<Ray> rays = randomRays(soup, GetParam(), 1000);
  const std::vector<glm::vec3> corners = soup.corners();
  const auto walk = trees.walk(rays, "trace_closest"), query = trees.query(rays, "trace_closest");
  const auto any = trees.query(rays, "trace_any");
  for (size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(judge(rays[i], query[i], corners), "") << "ray " << i;
    EXPECT_EQ(query[i].triangle == shared::kNoTriangle, any[i].triangle == shared::kNoTriangle) << "ray " << i;
  }
  const Accepts all = [](uint32_t, glm::dvec2) { return true; };
  expectEqualHits(rays, walk, query, corners, all);
}

TEST_P(RayQuerySeeds, AlphaIsAsked) {
  if (refusesAsItShould()) return;
  const Soup soup = spheres(GetParam());
  const BothTrees trees(soup);
  const std::vector<Ray> rays = randomRays(soup, GetParam(), 1000);
  const std::vector<glm::vec3> corners = soup.corners();
  const Accepts accepts = checkers(soup);
  const auto walk = trees.walk(rays, "trace_closest_alpha"), query = trees.query(rays, "trace_closest_alpha");
  const auto any = trees.query(rays, "trace_any_alpha");
  for (size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(judge(rays[i], query[i], corners, accepts), "") << "ray " << i;
    EXPECT_EQ(query[i].triangle == shared::kNoTriangle, any[i].triangle == shared::kNoTriangle) << "ray " << i;
  }
  expectEqualHits(rays, walk, query, corners, accepts);
}

TEST(RayQuery, MovingABlockRebuildsItAlone) {
  if (refusesAsItShould()) return;
  Soup soup = spheres(3);
  BothTrees trees(soup);
  for (glm::vec3& corner : soup.objects[2].corners) corner = corner * 1.5f + glm::vec3(0.1f);
  must(trees.acceleration.update(device(), soup.blocks(), std::vector{2u}));
  EXPECT_EQ(trees.acceleration.blocksRebuilt(), 1u);
  const std::vector<Ray> rays = randomRays(soup, 3, 1000);
  const auto moved = trees.query(rays, "trace_closest"), fresh = BothTrees(soup).query(rays, "trace_closest");
  for (size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(moved[i].triangle, fresh[i].triangle) << "ray " << i;
    ASSERT_EQ(moved[i].t, fresh[i].t) << "ray " << i;
  }
}

TEST(RayQuery, NothingIsHitWhereThereIsNothing) {
  if (refusesAsItShould()) return;
  const Soup soups[] = {{}, {{{{}, {}}}}};
  for (const Soup& soup : soups)
    for (const RayHit& hit : BothTrees(soup).query(randomRays({}, 1, 100), "trace_closest"))
      ASSERT_EQ(hit.triangle, shared::kNoTriangle);
}

/// Of the same paths: equal but where a hit at an edge went to a neighbour, and there only noise.
void expectTheSamePicture(const Scene& scene) {
  RenderOptions options;
  options.samples = 64;
  options.maxBounces = 6;
  options.method = TraceMethod::walk;
  PathTracer walk(device()), query(device());
  const FilmImage byWalk = walk.render(scene, options);
  options.method = TraceMethod::best;
  const FilmImage byQuery = query.render(scene, options);
  const auto &a = byWalk.find("beauty")->data, &b = byQuery.find("beauty")->data;
  const auto& errors = byWalk.find("error")->data;
  size_t equal = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    equal += std::abs(a[i] - b[i]) <= 1e-3f * std::abs(a[i]);
    EXPECT_LE(std::abs(a[i] - b[i]), 6 * errors[i / 3] + 1e-3f * std::abs(a[i])) << "channel " << i;
  }
  EXPECT_GT(equal, a.size() * 9 / 10) << "of " << a.size();
  EXPECT_LT(std::abs(measure(byQuery).mean - measure(byWalk).mean), 2 * measure(byWalk).error);
}

TEST(RayQuery, ThePathTracersPictureIsTheSame) { expectTheSamePicture(cornellLike().scene); }
TEST(RayQuery, ThePictureOfAlphaTexturesAndGlassIsTheSame) { expectTheSamePicture(richScene().scene); }

}  // namespace
}  // namespace limn::test
