#include "renderer/vk/compute_pipeline.hpp"

#include <set>
#include <utility>

#include "renderer/base/clock.hpp"

namespace limn::vk {

VkDescriptorType descriptorType(BindingKind kind) {
  switch (kind) {
    case BindingKind::storage: return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    case BindingKind::uniform: return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case BindingKind::texel: return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    case BindingKind::acceleration: return VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
  }
  return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

PipelineAllowance::PipelineAllowance(Device& device, uint32_t count) : m_device(device) {
  LIMN_CHECK(!device.pipelinesAllowed());
  device.pipelinesAllowed() = count;
}

PipelineAllowance::~PipelineAllowance() { m_device.pipelinesAllowed().reset(); }

Result<ComputePipeline> ComputePipeline::create(Device& device, const PipelineDesc& desc) {
  constexpr uint32_t kMostPushBytes = 128;  // what every Vulkan device offers
  LIMN_CHECK_LE(desc.pushConstantBytes, kMostPushBytes);
  LIMN_CHECK_EQ(desc.pushConstantBytes % 4, 0u);
  LIMN_CHECK(!desc.spirv.empty());
  if (std::optional<uint32_t>& left = device.pipelinesAllowed(); left && (*left)-- == 0) {
    left = 0;
    return Error{PipelineAllowance::kSpent, desc.name + ": no more pipelines may be made now", ""};
  }
  ComputePipeline pipeline;
  pipeline.m_device = &device;
  pipeline.m_name = desc.name;
  pipeline.m_slots = desc.layout;
  pipeline.m_pushConstantBytes = desc.pushConstantBytes;
  pipeline.m_pushDescriptors =
      device.features().pushDescriptors && desc.layout.size() <= device.limits().maxPushDescriptors;
  if (auto done = pipeline.createLayout(); !done) return done.error();
  if (auto done = pipeline.createPipeline(desc); !done) return done.error();
  return pipeline;
}

Result<void> ComputePipeline::createLayout() {
  std::set<uint32_t> numbers;
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const BindingSlot& slot : m_slots) {
    LIMN_CHECK(numbers.insert(slot.binding).second);
    bindings.push_back({slot.binding, descriptorType(slot.kind), 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  }
  auto setInfo = typed<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
  setInfo.flags = m_pushDescriptors ? VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR : 0;
  setInfo.bindingCount = uint32_t(bindings.size());
  setInfo.pBindings = bindings.data();
  VkResult r = vkCreateDescriptorSetLayout(m_device->handle(), &setInfo, nullptr, &m_setLayout);
  if (r != VK_SUCCESS) return deviceError(r, "vkCreateDescriptorSetLayout for " + m_name);

  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, m_pushConstantBytes};
  auto info = typed<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  info.setLayoutCount = 1;
  info.pSetLayouts = &m_setLayout;
  info.pushConstantRangeCount = m_pushConstantBytes ? 1 : 0;
  info.pPushConstantRanges = &range;
  r = vkCreatePipelineLayout(m_device->handle(), &info, nullptr, &m_layout);
  if (r != VK_SUCCESS) return deviceError(r, "vkCreatePipelineLayout for " + m_name);
  m_device->setName(VK_OBJECT_TYPE_PIPELINE_LAYOUT, uint64_t(m_layout), m_name);
  return {};
}

Result<void> ComputePipeline::createPipeline(const PipelineDesc& desc) {
  auto moduleInfo = typed<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  moduleInfo.codeSize = desc.spirv.size_bytes();
  moduleInfo.pCode = desc.spirv.data();
  VkShaderModule module = VK_NULL_HANDLE;
  VkResult r = vkCreateShaderModule(m_device->handle(), &moduleInfo, nullptr, &module);
  if (r != VK_SUCCESS) return deviceError(r, "vkCreateShaderModule for " + m_name);
  m_device->setName(VK_OBJECT_TYPE_SHADER_MODULE, uint64_t(module), m_name);

  std::vector<VkSpecializationMapEntry> entries;
  for (uint32_t i = 0; i < desc.specialization.size(); ++i) entries.push_back({i, i * 4, 4});
  VkSpecializationInfo specialization{};
  specialization.mapEntryCount = uint32_t(entries.size());
  specialization.pMapEntries = entries.data();
  specialization.dataSize = desc.specialization.size() * 4;
  specialization.pData = desc.specialization.data();

  auto info = typed<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
  info.layout = m_layout;
  info.stage = typed<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = entries.empty() ? nullptr : &specialization;
  const double start = nowSeconds();
  r = vkCreateComputePipelines(m_device->handle(), m_device->pipelineCache(), 1, &info, nullptr, &m_handle);
  m_device->mutablePipelineStats().createMs += (nowSeconds() - start) * 1e3;
  vkDestroyShaderModule(m_device->handle(), module, nullptr);
  if (r != VK_SUCCESS) return deviceError(r, "vkCreateComputePipelines for " + m_name);
  ++m_device->mutablePipelineStats().created;
  m_device->setName(VK_OBJECT_TYPE_PIPELINE, uint64_t(m_handle), m_name);
  return {};
}

void ComputePipeline::noteUse() const {
  if (std::exchange(m_used, true)) return;
  ++m_device->mutablePipelineStats().firstUses;
}

ComputePipeline::~ComputePipeline() { destroy(); }

ComputePipeline::ComputePipeline(ComputePipeline&& other) noexcept { *this = std::move(other); }

ComputePipeline& ComputePipeline::operator=(ComputePipeline&& other) noexcept {
  if (this == &other) return *this;
  destroy();
  m_device = std::exchange(other.m_device, nullptr);
  m_setLayout = std::exchange(other.m_setLayout, VK_NULL_HANDLE);
  m_layout = std::exchange(other.m_layout, VK_NULL_HANDLE);
  m_handle = std::exchange(other.m_handle, VK_NULL_HANDLE);
  m_name = std::move(other.m_name);
  m_slots = std::move(other.m_slots);
  m_pushConstantBytes = std::exchange(other.m_pushConstantBytes, 0);
  m_pushDescriptors = other.m_pushDescriptors;
  m_used = other.m_used;
  return *this;
}

void ComputePipeline::destroy() {
  if (!m_device) return;
  m_device->retire([device = m_device, handle = m_handle, layout = m_layout, setLayout = m_setLayout] {
    vkDestroyPipeline(device->handle(), handle, nullptr);
    vkDestroyPipelineLayout(device->handle(), layout, nullptr);
    vkDestroyDescriptorSetLayout(device->handle(), setLayout, nullptr);
  });
  m_device = nullptr;
}

}  // namespace limn::vk
