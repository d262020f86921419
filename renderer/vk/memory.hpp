#pragma once
#include <cstdint>
#include <optional>

#include "renderer/vk/buffer.hpp"

namespace limn::vk {

/// What one resource needs of vkAllocateMemory.
struct Allocation {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  uint64_t bytes = 0;
  void* mapped = nullptr;  ///< where the kind is mapped on this device
};

/// Picks the memory type for `kind` among those that `needs` allows, allocates, maps where that is of use.
/// `deviceAddress` is for buffers that have one.
/// Errors: "limit" (size or number of allocations), "out-of-memory", "unsupported" (no such memory).
Result<Allocation> allocateMemory(const Device& device, const VkMemoryRequirements& needs, MemoryKind kind,
                                  bool deviceAddress, const std::string& name);

}  // namespace limn::vk
