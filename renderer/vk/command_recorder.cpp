#include "renderer/vk/command_recorder.hpp"

#include <algorithm>
#include <vector>

#include "renderer/vk/queue.hpp"

namespace limn::vk {
namespace {

void checkBinding(const Device& device, const ComputePipeline& pipeline, const Binding& binding) {
  const bool declared = std::any_of(pipeline.slots().begin(), pipeline.slots().end(), [&](const BindingSlot& slot) {
    return slot.binding == binding.binding && slot.kind == binding.kind;
  });
  if (!declared) checkFailed(__FILE__, __LINE__, "binding is declared", pipeline.name() + " binding " +
                                                                            std::to_string(binding.binding));
  const DeviceLimits& limits = device.limits();
  switch (binding.kind) {
    case BindingKind::storage: LIMN_CHECK_EQ(binding.offset % limits.storageOffsetAlignment, 0u); break;
    case BindingKind::uniform: LIMN_CHECK_EQ(binding.offset % limits.uniformOffsetAlignment, 0u); break;
    case BindingKind::texel: LIMN_CHECK(binding.buffer && binding.buffer->view()); break;
    case BindingKind::acceleration: LIMN_CHECK(binding.acceleration && *binding.acceleration); return;
  }
  LIMN_CHECK(binding.buffer && *binding.buffer);
  LIMN_CHECK_LE(binding.offset + binding.size, binding.buffer->size());
}

/// VkWriteDescriptorSets and what they point to.
struct DescriptorWrites {
  std::vector<VkDescriptorBufferInfo> buffers;
  std::vector<VkBufferView> views;
  std::vector<VkAccelerationStructureKHR> structures;
  std::vector<VkWriteDescriptorSetAccelerationStructureKHR> structureWrites;
  std::vector<VkWriteDescriptorSet> writes;

  explicit DescriptorWrites(std::span<const Binding> bindings) {
    buffers.reserve(bindings.size());
    views.reserve(bindings.size());
    structures.reserve(bindings.size());
    structureWrites.reserve(bindings.size());
    for (const Binding& binding : bindings) add(binding);
  }

  void add(const Binding& binding) {
    auto write = typed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstBinding = binding.binding;
    write.descriptorCount = 1;
    write.descriptorType = descriptorType(binding.kind);
    if (binding.acceleration) {
      auto& structureWrite = structureWrites.emplace_back(typed<VkWriteDescriptorSetAccelerationStructureKHR>(
          VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR));
      structureWrite.accelerationStructureCount = 1;
      structureWrite.pAccelerationStructures = &structures.emplace_back(binding.acceleration->handle());
      write.pNext = &structureWrite;
    } else if (binding.kind == BindingKind::texel) {
      write.pTexelBufferView = &views.emplace_back(binding.buffer->view());
    } else {
      const VkDeviceSize size = binding.size ? binding.size : VK_WHOLE_SIZE;
      write.pBufferInfo =
          &buffers.emplace_back(VkDescriptorBufferInfo{binding.buffer->handle(), binding.offset, size});
    }
    writes.push_back(write);
  }
};

}  // namespace

CommandRecorder::CommandRecorder(Device& device) : m_device(device) {}

CommandRecorder::~CommandRecorder() {
  if (!m_slot) return;
  if (m_recording) vkEndCommandBuffer(m_slot->commands);
  m_device.queue().giveBack(*m_slot);
}

VkCommandBuffer CommandRecorder::handle() const { return m_slot ? m_slot->commands : VK_NULL_HANDLE; }

void CommandRecorder::begin() {
  LIMN_CHECK(!m_recording && !m_ended);
  m_recording = true;
  m_error.reset();
  auto slot = m_device.queue().acquire();
  if (slot) m_slot = *slot;
  else m_error = slot.error();
}

void CommandRecorder::end() {
  LIMN_CHECK(m_recording);
  barrier();
  m_recording = false;
  m_ended = true;
  if (!m_slot) return;
  if (const VkResult r = vkEndCommandBuffer(m_slot->commands); r != VK_SUCCESS) fail(r, "vkEndCommandBuffer");
}

void CommandRecorder::fail(VkResult result, const char* call) {
  if (!m_error) m_error = deviceError(result, call);
}

void CommandRecorder::bind(const ComputePipeline& pipeline, std::span<const Binding> bindings,
                           std::span<const std::byte> pushConstants) {
  LIMN_CHECK(m_recording);
  LIMN_CHECK_EQ(bindings.size(), pipeline.slots().size());
  LIMN_CHECK_EQ(pushConstants.size(), pipeline.pushConstantBytes());
  for (const Binding& binding : bindings) checkBinding(m_device, pipeline, binding);
  if (m_error) return;

  const VkCommandBuffer commands = m_slot->commands;
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle());
  pipeline.noteUse();
  if (!pushConstants.empty()) {
    vkCmdPushConstants(commands, pipeline.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, uint32_t(pushConstants.size()),
                       pushConstants.data());
  }
  if (bindings.empty()) return;
  DescriptorWrites writes(bindings);
  if (pipeline.usesPushDescriptors()) {
    m_device.functions().cmdPushDescriptorSet(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout(), 0,
                                              uint32_t(writes.writes.size()), writes.writes.data());
    return;
  }
  const auto set = m_device.queue().allocateSet(*m_slot, pipeline.setLayout());
  if (!set) {
    m_error = set.error();
    return;
  }
  for (VkWriteDescriptorSet& write : writes.writes) write.dstSet = *set;
  vkUpdateDescriptorSets(m_device.handle(), uint32_t(writes.writes.size()), writes.writes.data(), 0, nullptr);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout(), 0, 1, &*set, 0, nullptr);
}

void CommandRecorder::dispatch(const ComputePipeline& pipeline, std::span<const Binding> bindings,
                               std::span<const std::byte> pushConstants, uint32_t gx, uint32_t gy, uint32_t gz) {
  const auto& most = m_device.limits().maxWorkGroupCount;
  LIMN_CHECK_LE(gx, most[0]);
  LIMN_CHECK_LE(gy, most[1]);
  LIMN_CHECK_LE(gz, most[2]);
  bind(pipeline, bindings, pushConstants);
  if (!m_error) vkCmdDispatch(m_slot->commands, gx, gy, gz);
}

void CommandRecorder::warmUp(const ComputePipeline& pipeline, std::span<const Binding> bindings) {
  const std::vector<std::byte> zeros(pipeline.pushConstantBytes());
  dispatch(pipeline, bindings, zeros, 0, 0, 0);
}

void CommandRecorder::barrier() {
  LIMN_CHECK(m_recording);
  if (m_error) return;
  auto memory = typed<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
  memory.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
  memory.srcAccessMask = VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;
  memory.dstStageMask = memory.srcStageMask | VK_PIPELINE_STAGE_2_HOST_BIT;
  memory.dstAccessMask = VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_UNIFORM_READ_BIT |
                         VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
                         VK_ACCESS_2_HOST_READ_BIT;
  if (m_device.hasRayQuery()) {
    memory.srcStageMask |= VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
    memory.srcAccessMask |= VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR;
    memory.dstStageMask |= VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
    memory.dstAccessMask |=
        VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR | VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR;
  }
  auto info = typed<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &memory;
  vkCmdPipelineBarrier2(m_slot->commands, &info);
}

void CommandRecorder::copyBuffer(const Buffer& src, size_t srcOffset, const Buffer& dst, size_t dstOffset,
                                 size_t size) {
  LIMN_CHECK(m_recording);
  LIMN_CHECK_LE(srcOffset + size, src.size());
  LIMN_CHECK_LE(dstOffset + size, dst.size());
  if (m_error || size == 0) return;
  const VkBufferCopy region{srcOffset, dstOffset, size};
  vkCmdCopyBuffer(m_slot->commands, src.handle(), dst.handle(), 1, &region);
}

void CommandRecorder::fillBuffer(const Buffer& dst, size_t offset, size_t size, uint32_t word) {
  LIMN_CHECK(m_recording);
  LIMN_CHECK_EQ(offset % 4, 0u);
  LIMN_CHECK_EQ(size % 4, 0u);
  LIMN_CHECK_LE(offset + size, dst.size());
  if (!m_error) vkCmdFillBuffer(m_slot->commands, dst.handle(), offset, size ? size : VK_WHOLE_SIZE, word);
}

}  // namespace limn::vk
