#pragma once
#include <map>
#include <span>
#include <vector>

#include "renderer/gpu/pass.hpp"
#include "tests/support/shared_device.hpp"

namespace limn::test {

inline vk::BufferDesc kernelBuffer(const char* name, size_t bytes = 0) {
  vk::BufferDesc desc;
  desc.name = name;
  desc.owner = "test";
  desc.size = bytes;
  return desc;
}

template <class T>
vk::Buffer inputOf(const std::vector<T>& values) {
  return must(vk::createBufferWith(SharedDevice::get(), kernelBuffer("input"), std::span<const T>(values)));
}

constexpr uint32_t kOutputBinding = 30;  ///< beyond those of bindings.h

/// Runs a kernel once over `groups` workgroups, its results in binding kOutputBinding, and gives `count` of them. A
/// kernel is compiled the first time; its layout is that of the first bindings it sees.
template <class T, class Push>
std::vector<T> runKernel(std::span<const uint32_t> spirv, std::vector<vk::Binding> bindings, const Push& push,
                         size_t count, uint32_t groups) {
  static std::map<const uint32_t*, vk::ComputePipeline> pipelines;
  vk::Device& device = SharedDevice::get();
  const vk::Buffer out = must(vk::Buffer::create(device, kernelBuffer("output", count * sizeof(T))));
  bindings.push_back(vk::storage(kOutputBinding, out));
  vk::ComputePipeline& pipeline = pipelines[spirv.data()];
  if (!pipeline) {
    if (pipelines.size() == 1) SharedDevice::atEnd([] { pipelines.clear(); });
    vk::PipelineDesc desc;
    desc.name = "kernel";
    desc.spirv = spirv;
    for (const vk::Binding& binding : bindings) desc.layout.push_back({binding.binding, binding.kind});
    desc.pushConstantBytes = sizeof(Push);
    pipeline = must(vk::ComputePipeline::create(device, desc));
  }
  must(gpu::runNow(device,
                   [&](vk::CommandRecorder& r) { r.dispatch(pipeline, bindings, vk::pushBytes(push), groups); }));
  return must(vk::readBackArray<T>(device, out, count));
}

constexpr uint32_t kKernelGroup = 64;  ///< invocations of a workgroup of every kernel
inline uint32_t groupsFor(size_t invocations) { return uint32_t((invocations + kKernelGroup - 1) / kKernelGroup); }

}  // namespace limn::test
