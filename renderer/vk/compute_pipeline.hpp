#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "renderer/vk/device.hpp"

namespace limn::vk {

enum class BindingKind {
  storage,       ///< `buffer` block
  uniform,       ///< `uniform` block
  texel,         ///< samplerBuffer, isamplerBuffer, usamplerBuffer
  acceleration,  ///< accelerationStructureEXT
};

VkDescriptorType descriptorType(BindingKind kind);

/// One binding of set 0 as the shader declares it.
struct BindingSlot {
  uint32_t binding = 0;
  BindingKind kind = BindingKind::storage;
};

struct PipelineDesc {
  std::string name;                  ///< debug name and log, "path_trace"
  std::span<const uint32_t> spirv;   ///< compute shader with entry point main
  std::vector<BindingSlot> layout;   ///< set 0; binding numbers unique
  uint32_t pushConstantBytes = 0;    ///< <= 128, a multiple of 4
  std::vector<uint32_t> specialization;  ///< the constant with id i takes word i; floats and bools as their bits
};

/// While it lives, so many pipelines of the device may be made, and no more: the next creation fails with the error
/// kSpent. So a list of pipelines can be made a few at a time, by whoever keeps those that it has. Not nested. Render
/// thread.
class PipelineAllowance {
 public:
  static constexpr const char* kSpent = "not-now";

  PipelineAllowance(Device& device, uint32_t count);
  ~PipelineAllowance();
  PipelineAllowance(const PipelineAllowance&) = delete;
  PipelineAllowance& operator=(const PipelineAllowance&) = delete;

 private:
  Device& m_device;
};

/// A compute pipeline with its layout. Render thread.
class ComputePipeline {
 public:
  /// Takes milliseconds; some drivers compile at the first dispatch instead (see CommandRecorder::warmUp). Errors:
  /// "device", "out-of-memory", and PipelineAllowance::kSpent under a spent one.
  static Result<ComputePipeline> create(Device& device, const PipelineDesc& desc);

  ComputePipeline() = default;
  ~ComputePipeline();
  ComputePipeline(ComputePipeline&& other) noexcept;
  ComputePipeline& operator=(ComputePipeline&& other) noexcept;

  explicit operator bool() const { return m_handle != VK_NULL_HANDLE; }
  const std::string& name() const { return m_name; }
  VkPipeline handle() const { return m_handle; }
  VkPipelineLayout layout() const { return m_layout; }
  VkDescriptorSetLayout setLayout() const { return m_setLayout; }
  const std::vector<BindingSlot>& slots() const { return m_slots; }
  uint32_t pushConstantBytes() const { return m_pushConstantBytes; }
  bool usesPushDescriptors() const { return m_pushDescriptors; }
  /// Counts PipelineStats::firstUses at the first call.
  void noteUse() const;

 private:
  Result<void> createLayout();
  Result<void> createPipeline(const PipelineDesc& desc);
  void destroy();

  Device* m_device = nullptr;
  VkDescriptorSetLayout m_setLayout = VK_NULL_HANDLE;
  VkPipelineLayout m_layout = VK_NULL_HANDLE;
  VkPipeline m_handle = VK_NULL_HANDLE;
  std::string m_name;
  std::vector<BindingSlot> m_slots;
  uint32_t m_pushConstantBytes = 0;
  bool m_pushDescriptors = false;
  mutable bool m_used = false;
};

}  // namespace limn::vk
