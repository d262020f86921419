#include "tests/gpu/vk/vk_fixture.hpp"

#include <array>

#include "tests/gpu/vk/ray_query.spv.hpp"

namespace limn::vk {
namespace {

using Hit = std::array<float, 4>;  // instance, geometry, primitive, distance; all -1 for a miss

class AccelerationStructureTest : public OnEveryPath {
 protected:
  AccelerationStructureTest() {
    // Two triangles side by side at z = 0 and, as a second geometry, the first again at z = -1.
    const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 3, 0, 0, 2, 1, 0,
                                       0, 0, -1, 1, 0, -1, 0, 1, -1};
    const std::vector<uint32_t> indices{0, 1, 2, 3, 4, 5, 0, 1, 2};
    const auto usage = BufferUsage::storage | BufferUsage::accelerationInput;
    m_positions = must(createBufferWith<float>(*device, storageDesc(0, "positions", usage), positions));
    m_indices = must(createBufferWith<uint32_t>(*device, storageDesc(0, "indices", usage), indices));
    m_geometries[0] = {&m_positions, 0, 12, 6, &m_indices, 0, 2, true};
    m_geometries[1] = {&m_positions, 6 * 12, 12, 3, &m_indices, 6 * 4, 1, true};
  }

  std::vector<Hit> trace(const AccelerationStructure& scene, const std::vector<std::array<float, 4>>& starts) {
    PipelineDesc desc;
    desc.name = "ray query";
    desc.spirv = ray_querySpirv;
    desc.layout = {{0, BindingKind::acceleration}, {1, BindingKind::storage}, {2, BindingKind::storage}};
    desc.pushConstantBytes = 4;
    const ComputePipeline pipeline = must(ComputePipeline::create(*device, desc));
    const Buffer in =
        must(createBufferWith<std::array<float, 4>>(*device, storageDesc(0, "starts"), starts));
    const Buffer out = must(Buffer::create(*device, storageDesc(in.size(), "hits")));
    const std::array bindings{acceleration(0, scene), storage(1, in), storage(2, out)};
    CommandRecorder recorder(*device);
    recorder.begin();
    recorder.dispatch(pipeline, bindings, pushBytes(uint32_t(starts.size())), 1);
    finish(*device, recorder);
    return must(readBackArray<Hit>(*device, out, starts.size()));
  }

  Buffer m_positions, m_indices;
  std::array<TriangleGeometry, 2> m_geometries;
};
INSTANTIATE_TEST_SUITE_P(Paths, AccelerationStructureTest, testing::ValuesIn(kDevicePaths), pathName);

TEST_P(AccelerationStructureTest, RaysFindInstanceGeometryAndTriangleOrTheDeviceSaysItCannot) {
  auto geometry = AccelerationStructure::fromTriangles(*device, m_geometries, "geometry", "test");
  ASSERT_EQ(geometry.ok(), device->hasRayQuery());
  if (!device->hasRayQuery()) {
    EXPECT_EQ(geometry.error().code, "unsupported");
    EXPECT_EQ(m_positions.address(), 0u);
    EXPECT_EQ(AccelerationStructure::fromInstances(*device, {}, "scene", "test").error().code, "unsupported");
    return;
  }
  EXPECT_GT(geometry->bytes(), 0u);
  const std::array instances{
      AccelerationInstance{.customIndex = 7, .geometry = &*geometry},
      AccelerationInstance{.worldFromObject = {1, 0, 0, 10, 0, 1, 0, 0, 0, 0, 1, 2}, .customIndex = 9,
                           .geometry = &*geometry}};
  const auto scene = must(AccelerationStructure::fromInstances(*device, instances, "scene", "test"));
  const auto hits = trace(scene, {{0.2f, 0.2f, 5, 0}, {2.2f, 0.2f, 5, 0}, {0.2f, 0.2f, -0.5f, 0}, {12.2f, 0.2f, 5, 0},
                                  {5, 0, 5, 0}});
  EXPECT_EQ(hits[0], (Hit{7, 0, 0, 5}));
  EXPECT_EQ(hits[1], (Hit{7, 0, 1, 5}));
  EXPECT_EQ(hits[2], (Hit{7, 1, 0, 0.5f}));
  EXPECT_EQ(hits[3], (Hit{9, 0, 1, 3}));
  EXPECT_EQ(hits[4], (Hit{-1, -1, -1, -1}));
  const auto nothing = must(AccelerationStructure::fromInstances(*device, {}, "nothing", "test"));
  EXPECT_EQ(trace(nothing, {{0.2f, 0.2f, 5, 0}})[0], (Hit{-1, -1, -1, -1}));
}

}  // namespace
}  // namespace limn::vk
