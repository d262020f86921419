#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/vk/vulkan.hpp"

namespace limn::vk {

class Device;

/// A command buffer with the descriptors it uses, recycled once its submission is done.
struct CommandSlot {
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  std::vector<VkDescriptorPool> descriptorPools;  ///< used where sets are not pushed; reset with the slot
  size_t openPool = 0;                            ///< the pool sets are taken from now
  uint64_t doneAt = 0;                            ///< timeline value of the last submission
  bool recording = false;                         ///< held by a CommandRecorder
};

/// The compute queue with its timeline: submission n signals n. Render thread.
class Queue {
 public:
  static Result<std::unique_ptr<Queue>> create(Device& device);
  ~Queue();
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  /// A slot in recording state. Errors: "out-of-memory".
  Result<CommandSlot*> acquire();
  /// Takes back a slot that will not be submitted.
  void giveBack(CommandSlot& slot);
  Result<uint64_t> submit(CommandSlot& slot);
  Result<void> wait(uint64_t value, uint64_t timeoutNs);
  bool reached(uint64_t value) const;
  uint64_t lastSubmitted() const { return m_lastSubmitted; }
  bool lost() const { return m_lost; }

  /// A set of `layout` that lives as long as the slot's recording.
  Result<VkDescriptorSet> allocateSet(CommandSlot& slot, VkDescriptorSetLayout layout);
  void retire(std::function<void()> destroy);

 private:
  explicit Queue(Device& device) : m_device(device) {}
  Error note(VkResult result, const char* call);
  VkResult submitToDriver(const VkSubmitInfo2& info);
  Result<CommandSlot*> createSlot();
  Result<void> addDescriptorPool(CommandSlot& slot);
  void destroyRetired();

  struct Retired {
    uint64_t doneAt = 0;
    std::function<void()> destroy;
  };

  Device& m_device;
  VkQueue m_handle = VK_NULL_HANDLE;
  VkSemaphore m_timeline = VK_NULL_HANDLE;
  uint64_t m_lastSubmitted = 0;
  mutable uint64_t m_lastReached = 0;  ///< spares asking the driver again
  bool m_lost = false;
  std::optional<uint64_t> m_loseAt;    ///< TestEnvironment::loseDeviceAt
  std::vector<std::unique_ptr<CommandSlot>> m_slots;
  std::deque<Retired> m_retired;
};

}  // namespace limn::vk
