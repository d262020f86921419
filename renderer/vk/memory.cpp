#include "renderer/vk/memory.hpp"

#include <array>

namespace limn::vk {
namespace {

constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

std::optional<uint32_t> findType(const VkPhysicalDeviceMemoryProperties& memory, uint32_t allowed,
                                 VkMemoryPropertyFlags wanted) {
  for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    if ((allowed & (1u << i)) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  }
  return std::nullopt;
}

/// What to ask for, best first. Device-local memory is mapped only where the host caches it: uncached reads over a bus
/// are slower than a copy. `0` takes anything, which a device without that heap has to answer with.
std::array<VkMemoryPropertyFlags, 3> wishes(const Device& device, MemoryKind kind) {
  const bool discrete = device.options().assumeDiscrete || device.info().type == "discrete";
  switch (kind) {
    case MemoryKind::deviceLocal: return {discrete ? kLocal : kLocal | kHost | kCached, kLocal, 0};
    case MemoryKind::upload: return {kHost, kHost, kHost};
    case MemoryKind::readback: return {kHost | kCached, kHost, kHost};
  }
  return {};
}

bool wantsMapping(const Device& device, MemoryKind kind, VkMemoryPropertyFlags flags) {
  if (kind != MemoryKind::deviceLocal) return true;
  return !device.options().assumeDiscrete && (flags & (kHost | kCached)) == (kHost | kCached);
}

}  // namespace

Result<Allocation> allocateMemory(const Device& device, const VkMemoryRequirements& needs, MemoryKind kind,
                                  bool deviceAddress, const std::string& name) {
  const DeviceLimits& limits = device.limits();
  if (needs.size > limits.maxMemoryAllocationSize) {
    return Error{"limit", name + " needs " + std::to_string(needs.size) + " bytes, one allocation holds at most " +
                              std::to_string(limits.maxMemoryAllocationSize), ""};
  }
  if (device.memory().allocationCount() >= limits.maxMemoryAllocationCount) {
    return Error{"limit", name + ": the device allows " + std::to_string(limits.maxMemoryAllocationCount) +
                              " allocations and all are taken", ""};
  }
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(device.physical(), &memory);
  std::optional<uint32_t> type;
  for (const VkMemoryPropertyFlags wish : wishes(device, kind)) {
    if (!type) type = findType(memory, needs.memoryTypeBits, wish);
  }
  if (!type) return Error{"unsupported", name + ": the device has no memory of this kind", ""};

  auto info = typed<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
  info.allocationSize = needs.size;
  info.memoryTypeIndex = *type;
  auto flags = typed<VkMemoryAllocateFlagsInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO);
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  if (deviceAddress) info.pNext = &flags;
  Allocation allocation;
  allocation.bytes = needs.size;
  if (const VkResult r = vkAllocateMemory(device.handle(), &info, nullptr, &allocation.memory); r != VK_SUCCESS) {
    return deviceError(r, "vkAllocateMemory of " + std::to_string(needs.size) + " bytes for " + name);
  }
  device.setName(VK_OBJECT_TYPE_DEVICE_MEMORY, uint64_t(allocation.memory), name);
  if (!wantsMapping(device, kind, memory.memoryTypes[*type].propertyFlags)) return allocation;
  const VkResult r = vkMapMemory(device.handle(), allocation.memory, 0, VK_WHOLE_SIZE, 0, &allocation.mapped);
  if (r == VK_SUCCESS) return allocation;
  vkFreeMemory(device.handle(), allocation.memory, nullptr);
  return deviceError(r, "vkMapMemory for " + name);
}

}  // namespace limn::vk
