#include "renderer/gpu/device_scene.hpp"
#include "renderer/visibility/bvh.hpp"
#include "shaders/shared/bindings.h"
#include "tests/gpu/departure.spv.hpp"
#include "tests/gpu/kernel.hpp"
#include "tests/support/scene_builder.hpp"

namespace limn::test {
namespace {

struct Place {
  double scale;   ///< [m], half the plane's width
  double offset;  ///< [m], of the plane from the origin
};
void PrintTo(const Place& place, std::ostream* out) { *out << place.scale << " m at " << place.offset << " m"; }

/// A tilted plane of many triangles, all at one height of its own space.
SceneBuilder planeAt(const Place& place) {
  constexpr uint32_t kCells = 8;
  SceneBuilder b;
  Primitive p;
  p.material = int32_t(b.diffuse(glm::vec3(0.5f)));
  for (uint32_t i = 0; i <= kCells; ++i)
    for (uint32_t j = 0; j <= kCells; ++j) {
      p.positions.push_back({2.0f * float(i) / kCells - 1, 0, 1 - 2.0f * float(j) / kCells});
      p.normals.push_back({0, 1, 0});
    }
  for (uint32_t i = 0; i < kCells; ++i)
    for (uint32_t j = 0; j < kCells; ++j) {
      const uint32_t at = i * (kCells + 1) + j, next = at + kCells + 1;
      for (const uint32_t k : {at, next, next + 1, at, next + 1, at + 1}) p.indices.push_back(k);
    }
  const uint32_t node = b.mesh(p);
  Transform& t = b.scene.nodes[node].parentFromLocal;
  t.rotation = glm::normalize(glm::dquat(0.8, 0.3, -0.2, 0.4));
  t.scale = glm::dvec3(place.scale);
  t.translation = place.offset * glm::normalize(glm::dvec3(1, -2, 0.5));
  return b;
}

class Departure : public testing::TestWithParam<Place> {};
INSTANTIATE_TEST_SUITE_P(Places, Departure,
                         testing::Values(Place{1e-3, 0}, Place{1, 0}, Place{1e3, 0}, Place{1e6, 0}, Place{1e-3, 0.01},
                                         Place{1e-3, 1e5}, Place{1, 10}, Place{1, 1e3}, Place{1, 1e5}, Place{1e3, 1e4},
                                         Place{1e3, 1e5}, Place{1e6, 1e5}));

TEST_P(Departure, RaysNeverMeetTheirOwnPlane) {
  const SceneBuilder b = planeAt(GetParam());
  gpu::DeviceScene mirror(SharedDevice::get());
  ChangeSet everything;
  everything.everything = true;
  must(mirror.sync(b.scene, everything));
  std::vector<TriangleBlock> blocks;
  for (const gpu::GeometryBlock& block : mirror.blocks()) blocks.push_back({block.corners, block.firstTriangle, false});
  SceneBvh bvh;
  must(bvh.update(SharedDevice::get(), blocks, {}));

  struct Push {
    uint32_t triangleCount, count, seed;
    float distance;
  };
  constexpr uint32_t kRays = 1u << 15;
  const auto bindings = gpu::joined(mirror.bindings(), {vk::texel(BINDING_BVH_NODES, bvh.nodes()),
                                                        vk::texel(BINDING_BVH_TRIANGLES, bvh.triangles())});
  const auto results = runKernel<uint32_t>(
      departureSpirv, bindings, Push{uint32_t(mirror.triangleCount()), kRays, 3, float(2 * GetParam().scale)}, kRays,
      groupsFor(kRays));
  uint32_t hits = 0, strays = 0;
  for (const uint32_t r : results) {
    hits += r == 1;
    strays += r == 2;
  }
  EXPECT_EQ(hits, 0u);
  EXPECT_LT(strays, kRays / 20);  // rays aimed at the rim pass by it
}

}  // namespace
}  // namespace limn::test
