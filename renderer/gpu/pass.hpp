#pragma once
#include <string>
#include <vector>

#include "renderer/vk/command_recorder.hpp"
#include "renderer/vk/compute_pipeline.hpp"
#include "shaders/embedded_shaders.hpp"

namespace limn::gpu {

/// One compute shader of shaders/shaders.cmake with its pipeline. The layout is taken from the first set of bindings it is
/// given, so that binding numbers are said in bindings.h alone.
class Pass {
 public:
  /// Errors: "device", "out-of-memory".
  static Result<Pass> create(vk::Device& device, const std::string& shader, const std::vector<vk::Binding>& like,
                             uint32_t pushConstantBytes, std::vector<uint32_t> specialization = {}) {
    vk::PipelineDesc desc;
    desc.name = shader;
    desc.spirv = tracingVariant(shader, like);
    LIMN_CHECK(!desc.spirv.empty());
    for (const vk::Binding& binding : like) desc.layout.push_back({binding.binding, binding.kind});
    desc.pushConstantBytes = pushConstantBytes;
    desc.specialization = std::move(specialization);
    auto pipeline = vk::ComputePipeline::create(device, desc);
    if (!pipeline) return pipeline.error();
    Pass pass;
    pass.m_pipeline = pipeline.take();
    return pass;
  }

  /// As create(), and compiled also by drivers that do so at the first dispatch. Errors: as create(), "device-lost".
  static Result<Pass> createWarm(vk::Device& device, const std::string& shader, const std::vector<vk::Binding>& like,
                                 uint32_t pushConstantBytes, std::vector<uint32_t> specialization = {});

  template <class Push>
  void record(vk::CommandRecorder& recorder, const std::vector<vk::Binding>& bindings, const Push& push, uint32_t gx,
              uint32_t gy = 1) const {
    recorder.dispatch(m_pipeline, bindings, vk::pushBytes(push), gx, gy);
  }
  /// Lets drivers that compile at the first dispatch do so now.
  void warmUp(vk::CommandRecorder& recorder, const std::vector<vk::Binding>& bindings) const {
    recorder.warmUp(m_pipeline, bindings);
  }
  explicit operator bool() const { return bool(m_pipeline); }

 private:
  /// Where an acceleration structure is bound, a shader that traces (limn_tracing_shader) uses ray queries.
  static std::span<const uint32_t> tracingVariant(const std::string& shader, const std::vector<vk::Binding>& like) {
    for (const vk::Binding& binding : like) {
      if (binding.kind != vk::BindingKind::acceleration) continue;
      if (const auto twin = embeddedShader(shader + "_ray_query"); !twin.empty()) return twin;
    }
    return embeddedShader(shader);
  }

  vk::ComputePipeline m_pipeline;
};

/// Runs what `record` puts into a recording and waits for it.
template <class Record>
Result<void> runNow(vk::Device& device, Record record) {
  vk::CommandRecorder recorder(device);
  recorder.begin();
  record(recorder);
  recorder.end();
  auto value = device.submit(recorder);
  if (!value) return value.error();
  return device.wait(*value);
}

inline Result<Pass> Pass::createWarm(vk::Device& device, const std::string& shader,
                                     const std::vector<vk::Binding>& like, uint32_t pushConstantBytes,
                                     std::vector<uint32_t> specialization) {
  auto pass = create(device, shader, like, pushConstantBytes, std::move(specialization));
  if (!pass) return pass;
  auto done = runNow(device, [&](vk::CommandRecorder& r) { pass->warmUp(r, like); });
  return done ? std::move(pass) : Result<Pass>(done.error());
}

inline std::vector<vk::Binding> joined(std::vector<vk::Binding> a, const std::vector<vk::Binding>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace limn::gpu
