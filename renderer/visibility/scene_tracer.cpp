#include "renderer/visibility/scene_tracer.hpp"

#include "renderer/vk/device.hpp"
#include "shaders/shared/bindings.h"

namespace limn {

Result<void> SceneTracer::update(vk::Device& device, std::span<const TriangleBlock> blocks,
                                 std::span<const uint32_t> changed) {
  if (m_method == TraceMethod::best) m_method = device.hasRayQuery() ? TraceMethod::rayQuery : TraceMethod::walk;
  if (m_method == TraceMethod::rayQuery) {
    if (auto done = m_acceleration.update(device, blocks, changed); !done) return done;
    m_blocksRebuilt = m_acceleration.blocksRebuilt();
    return {};
  }
  if (auto done = m_bvh.update(device, blocks, changed); !done) return done;
  m_blocksRebuilt = m_bvh.stats().blocksRebuilt;
  return {};
}

std::vector<vk::Binding> SceneTracer::bindings() const {
  if (m_method == TraceMethod::rayQuery) return {vk::acceleration(BINDING_ACCELERATION, m_acceleration.top())};
  return {vk::texel(BINDING_BVH_NODES, m_bvh.nodes()), vk::texel(BINDING_BVH_TRIANGLES, m_bvh.triangles())};
}

}  // namespace limn
