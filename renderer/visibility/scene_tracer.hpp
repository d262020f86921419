#pragma once
#include <vector>

#include "renderer/visibility/acceleration_structure.hpp"
#include "renderer/visibility/bvh.hpp"
#include "renderer/vk/command_recorder.hpp"

namespace limn {

/// How rays find triangles.
enum class TraceMethod {
  best,      ///< rayQuery where the device has it, else walk
  walk,      ///< SceneBvh, by shaders/lib/trace_walk.glsl
  rayQuery,  ///< SceneAcceleration, by shaders/lib/trace_ray_query.glsl
};

/// What shaders trace rays against: the scene's triangles in one of two forms, of which only the one in use is built.
/// Its bindings say which it is, and gpu::Pass takes the variant of a shader that goes with them. Render thread.
class SceneTracer {
 public:
  explicit SceneTracer(TraceMethod method = TraceMethod::best) : m_method(method) {}

  /// As SceneBvh::update. Errors: those of SceneBvh or SceneAcceleration; "unsupported" for a rayQuery that was asked
  /// for where the device has none.
  Result<void> update(vk::Device& device, std::span<const TriangleBlock> blocks, std::span<const uint32_t> changed);

  /// For every shader that includes lib/trace.glsl after lib/scene_bindings.glsl. Valid after the first update.
  std::vector<vk::Binding> bindings() const;
  /// Of the last update; never `best`.
  TraceMethod method() const { return m_method; }
  /// Blocks whose own tree was built in the last update.
  uint32_t blocksRebuilt() const { return m_blocksRebuilt; }
  /// Kept on the host to build from [byte]; nothing for rayQuery.
  uint64_t hostBytes() const { return m_bvh.stats().hostBytes; }

 private:
  TraceMethod m_method;
  SceneBvh m_bvh;
  SceneAcceleration m_acceleration;
  uint32_t m_blocksRebuilt = 0;
};

}  // namespace limn
