#include "renderer/vk/queue.hpp"

#include <algorithm>

#include "renderer/vk/device.hpp"
#include "renderer/vk/test_environment.hpp"

namespace limn::vk {
namespace {

constexpr uint32_t kSetsPerPool = 64;
constexpr uint32_t kDescriptorsPerPool = 512;  // of each kind: more than 64 sets of our shaders use

}  // namespace

Result<std::unique_ptr<Queue>> Queue::create(Device& device) {
  std::unique_ptr<Queue> queue(new Queue(device));
  queue->m_loseAt = testEnvironment().loseDeviceAt;
  vkGetDeviceQueue(device.handle(), device.queueFamily(), 0, &queue->m_handle);
  device.setName(VK_OBJECT_TYPE_QUEUE, uint64_t(queue->m_handle), "queue");
  auto type = typed<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  auto info = typed<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
  info.pNext = &type;
  if (const VkResult r = vkCreateSemaphore(device.handle(), &info, nullptr, &queue->m_timeline); r != VK_SUCCESS) {
    return deviceError(r, "vkCreateSemaphore");
  }
  device.setName(VK_OBJECT_TYPE_SEMAPHORE, uint64_t(queue->m_timeline), "timeline");
  return queue;
}

Queue::~Queue() {
  if (!m_lost && m_timeline) (void)wait(m_lastSubmitted, ~uint64_t(0));
  while (!m_retired.empty()) {
    m_retired.front().destroy();
    m_retired.pop_front();
  }
  for (const auto& slot : m_slots) {
    for (const VkDescriptorPool pool : slot->descriptorPools) vkDestroyDescriptorPool(m_device.handle(), pool, nullptr);
    vkDestroyCommandPool(m_device.handle(), slot->pool, nullptr);
  }
  vkDestroySemaphore(m_device.handle(), m_timeline, nullptr);
}

Error Queue::note(VkResult result, const char* call) {
  if (result == VK_ERROR_DEVICE_LOST) m_lost = true;
  return deviceError(result, call);
}

Result<CommandSlot*> Queue::createSlot() {
  auto slot = std::make_unique<CommandSlot>();
  auto poolInfo = typed<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
  poolInfo.queueFamilyIndex = m_device.queueFamily();
  if (const VkResult r = vkCreateCommandPool(m_device.handle(), &poolInfo, nullptr, &slot->pool); r != VK_SUCCESS) {
    return note(r, "vkCreateCommandPool");
  }
  auto info = typed<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
  info.commandPool = slot->pool;
  info.commandBufferCount = 1;
  if (const VkResult r = vkAllocateCommandBuffers(m_device.handle(), &info, &slot->commands); r != VK_SUCCESS) {
    vkDestroyCommandPool(m_device.handle(), slot->pool, nullptr);
    return note(r, "vkAllocateCommandBuffers");
  }
  const std::string name = "commands." + std::to_string(m_slots.size());
  m_device.setName(VK_OBJECT_TYPE_COMMAND_BUFFER, uint64_t(slot->commands), name);
  m_slots.push_back(std::move(slot));
  return m_slots.back().get();
}

Result<CommandSlot*> Queue::acquire() {
  const auto unused = std::find_if(m_slots.begin(), m_slots.end(),
                                   [&](const auto& slot) { return !slot->recording && reached(slot->doneAt); });
  CommandSlot* slot = unused == m_slots.end() ? nullptr : unused->get();
  if (!slot) {
    auto made = createSlot();
    if (!made) return made.error();
    slot = *made;
  }
  if (const VkResult r = vkResetCommandPool(m_device.handle(), slot->pool, 0); r != VK_SUCCESS) {
    return note(r, "vkResetCommandPool");
  }
  for (const VkDescriptorPool pool : slot->descriptorPools) vkResetDescriptorPool(m_device.handle(), pool, 0);
  slot->openPool = 0;
  auto info = typed<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  if (const VkResult r = vkBeginCommandBuffer(slot->commands, &info); r != VK_SUCCESS) {
    return note(r, "vkBeginCommandBuffer");
  }
  slot->recording = true;
  return slot;
}

void Queue::giveBack(CommandSlot& slot) { slot.recording = false; }

Result<uint64_t> Queue::submit(CommandSlot& slot) {
  slot.recording = false;
  destroyRetired();
  auto commands = typed<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
  commands.commandBuffer = slot.commands;
  auto signal = typed<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
  signal.semaphore = m_timeline;
  signal.value = m_lastSubmitted + 1;
  signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  auto info = typed<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &commands;
  info.signalSemaphoreInfoCount = 1;
  info.pSignalSemaphoreInfos = &signal;
  if (const VkResult r = submitToDriver(info); r != VK_SUCCESS) return note(r, "vkQueueSubmit2");
  slot.doneAt = ++m_lastSubmitted;
  return m_lastSubmitted;
}

VkResult Queue::submitToDriver(const VkSubmitInfo2& info) {
  if (m_lastSubmitted + 1 != m_loseAt) return vkQueueSubmit2(m_handle, 1, &info, VK_NULL_HANDLE);
  // A device that is lost works no more on what it was given: the pretended one must not either.
  (void)wait(m_lastSubmitted, ~uint64_t(0));
  return VK_ERROR_DEVICE_LOST;
}

Result<void> Queue::wait(uint64_t value, uint64_t timeoutNs) {
  LIMN_CHECK_LE(value, m_lastSubmitted);
  if (m_lost) return deviceError(VK_ERROR_DEVICE_LOST, "an earlier call");
  if (value > m_lastReached) {
    auto info = typed<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
    info.semaphoreCount = 1;
    info.pSemaphores = &m_timeline;
    info.pValues = &value;
    const VkResult r = vkWaitSemaphores(m_device.handle(), &info, timeoutNs);
    if (r == VK_TIMEOUT) return Error{"timeout", "the device did not finish in time", ""};
    if (r != VK_SUCCESS) return note(r, "vkWaitSemaphores");
    m_lastReached = value;
  }
  destroyRetired();
  return {};
}

bool Queue::reached(uint64_t value) const {
  if (value <= m_lastReached) return true;
  uint64_t now = 0;
  if (m_lost || vkGetSemaphoreCounterValue(m_device.handle(), m_timeline, &now) != VK_SUCCESS) return false;
  m_lastReached = std::max(m_lastReached, now);
  return value <= m_lastReached;
}

Result<void> Queue::addDescriptorPool(CommandSlot& slot) {
  std::vector<VkDescriptorPoolSize> sizes{{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kDescriptorsPerPool},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kDescriptorsPerPool},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, kDescriptorsPerPool}};
  if (m_device.hasRayQuery()) sizes.push_back({VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, kSetsPerPool});
  auto info = typed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
  info.maxSets = kSetsPerPool;
  info.poolSizeCount = uint32_t(sizes.size());
  info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  const VkResult r = vkCreateDescriptorPool(m_device.handle(), &info, nullptr, &pool);
  if (r != VK_SUCCESS) return note(r, "vkCreateDescriptorPool");
  slot.descriptorPools.push_back(pool);
  return {};
}

Result<VkDescriptorSet> Queue::allocateSet(CommandSlot& slot, VkDescriptorSetLayout layout) {
  for (;; ++slot.openPool) {
    const bool fresh = slot.openPool == slot.descriptorPools.size();
    if (fresh) {
      if (auto added = addDescriptorPool(slot); !added) return added.error();
    }
    auto info = typed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    info.descriptorPool = slot.descriptorPools[slot.openPool];
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkResult r = vkAllocateDescriptorSets(m_device.handle(), &info, &set);
    if (r == VK_SUCCESS) return set;
    const bool full = r == VK_ERROR_OUT_OF_POOL_MEMORY || r == VK_ERROR_FRAGMENTED_POOL;
    if (!full || fresh) return note(r, "vkAllocateDescriptorSets");
  }
}

void Queue::retire(std::function<void()> destroy) {
  if (m_lost || reached(m_lastSubmitted)) return destroy();
  m_retired.push_back({m_lastSubmitted, std::move(destroy)});
}

void Queue::destroyRetired() {
  while (!m_retired.empty() && reached(m_retired.front().doneAt)) {
    const std::function<void()> destroy = std::move(m_retired.front().destroy);
    m_retired.pop_front();
    destroy();
  }
}

}  // namespace limn::vk
