// Drivers that compile at the first dispatch do so by what is bound. Whatever a table's size is later, warming up once
// must do.
#include <gtest/gtest.h>

#include <cstdlib>

#include "renderer/gpu/pass.hpp"
#include "tests/gpu/bvh_scenes.hpp"
#include "tests/support/processor_time.hpp"
#include "tests/support/shared_device.hpp"

namespace limn::test {
namespace {

/// The driver keeps nothing on disk, so that every compilation costs its full time.
const bool kWithoutDriverCache = setenv("MESA_SHADER_CACHE_DISABLE", "true", 1) == 0;

vk::Buffer raysOf(size_t count) {
  const vk::BufferDesc desc{count * sizeof(Ray), vk::BufferUsage::texel, vk::MemoryKind::upload, "rays", "test",
                            VK_FORMAT_R32G32B32A32_SFLOAT};
  const std::vector<Ray> rays(count);
  return must(vk::createBufferWith(SharedDevice::get(), desc, std::span(rays)));
}

double secondsOf(const std::function<void(vk::CommandRecorder&)>& record) {
  const double begin = processorSeconds();
  must(gpu::runNow(SharedDevice::get(), record));
  return processorSeconds() - begin;
}

TEST(WarmUp, OneIsEnoughForTablesOfEverySize) {
  ASSERT_TRUE(kWithoutDriverCache);
  vk::Device& device = SharedDevice::get();
  const Object ball = bumpySphere(glm::vec3(0), 1, 8);
  SceneBvh bvh;
  must(bvh.update(device, std::vector{TriangleBlock{ball.corners, 0, false}}, {}));
  vk::BufferDesc desc{sizeof(RayHit), vk::BufferUsage::storage, vk::MemoryKind::readback, "hits", "test"};
  const vk::Buffer out = must(vk::Buffer::create(device, desc));
  const auto bindings = [&](const vk::Buffer& rays) {
    return std::vector<vk::Binding>{vk::texel(0, bvh.nodes()), vk::texel(1, bvh.triangles()), vk::texel(2, rays),
                                    vk::storage(3, out)};
  };
  const vk::Buffer first = raysOf(3);
  const gpu::Pass pass = must(gpu::Pass::create(device, "trace_closest", bindings(first), 4));
  const double compiled = secondsOf([&](vk::CommandRecorder& r) { pass.warmUp(r, bindings(first)); });
  // Powers of two, and sizes whose second byte is zero: 22.3 of Mesa's software device tells them apart.
  for (const size_t count : {3, 1, 4, 64, 65, 2048, 2049, 4096, 6144, 1 << 16, 1 << 20}) {
    const vk::Buffer rays = raysOf(count);
    const double dispatched =
        secondsOf([&](vk::CommandRecorder& r) { pass.record(r, bindings(rays), uint32_t(1), 1); });
    EXPECT_LT(dispatched, compiled / 5) << count << " rays; compiling takes " << compiled << " s";
  }
}

}  // namespace
}  // namespace limn::test
