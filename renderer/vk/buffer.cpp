#include "renderer/vk/buffer.hpp"

#include <utility>

#include "renderer/vk/memory.hpp"

namespace limn::vk {
namespace {

bool needsAddress(const Device& device, BufferUsage usage) {
  constexpr BufferUsage kAddressed =
      BufferUsage::accelerationInput | BufferUsage::accelerationStorage | BufferUsage::scratch;
  return device.hasRayQuery() && has(usage, kAddressed);
}

VkBufferUsageFlags usageFlags(const Device& device, BufferUsage usage) {
  VkBufferUsageFlags flags = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  if (has(usage, BufferUsage::storage)) flags |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  if (has(usage, BufferUsage::uniform)) flags |= VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
  if (has(usage, BufferUsage::texel)) flags |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
  if (!needsAddress(device, usage)) return flags;
  flags |= VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  if (has(usage, BufferUsage::accelerationInput)) {
    flags |= VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
  }
  if (has(usage, BufferUsage::accelerationStorage)) flags |= VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR;
  if (has(usage, BufferUsage::scratch)) flags |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  return flags;
}

/// Bytes of one element of a view; 0 for a format that is not offered for texel buffers.
size_t texelBytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
    case VK_FORMAT_R8_UINT: return 1;
    case VK_FORMAT_R16_UINT:
    case VK_FORMAT_R16_SFLOAT: return 2;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_UINT:
    case VK_FORMAT_R16G16_UINT:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SINT:
    case VK_FORMAT_R32_SFLOAT: return 4;
    case VK_FORMAT_R16G16B16A16_UINT:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32_SINT:
    case VK_FORMAT_R32G32_SFLOAT: return 8;
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT: return 16;
    default: return 0;
  }
}

Error overLimit(const BufferDesc& desc, const char* limit, uint64_t most) {
  return {"limit", desc.name + " wants " + std::to_string(desc.size) + " bytes, the device's " + limit + " is " +
                       std::to_string(most), ""};
}

Result<void> checkTexelFormat(const Device& device, const BufferDesc& desc) {
  const size_t elementBytes = texelBytes(desc.texelFormat);
  LIMN_CHECK(elementBytes > 0);
  LIMN_CHECK_EQ(desc.size % elementBytes, 0u);
  if (desc.size / elementBytes > device.limits().maxTexelBufferElements) {
    return overLimit(desc, "maxTexelBufferElements", device.limits().maxTexelBufferElements);
  }
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(device.physical(), desc.texelFormat, &properties);
  if (!(properties.bufferFeatures & VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT)) {
    return Error{"unsupported", desc.name + ": the device cannot read VkFormat " +
                                    std::to_string(int(desc.texelFormat)) + " from a texel buffer", ""};
  }
  return {};
}

Result<void> checkLimits(const Device& device, const BufferDesc& desc) {
  const DeviceLimits& limits = device.limits();
  if (desc.size > limits.maxBufferSize) return overLimit(desc, "maxBufferSize", limits.maxBufferSize);
  if (desc.size > limits.maxMemoryAllocationSize) {
    return overLimit(desc, "maxMemoryAllocationSize", limits.maxMemoryAllocationSize);
  }
  if (has(desc.usage, BufferUsage::storage) && desc.size > limits.maxStorageBufferRange) {
    return overLimit(desc, "maxStorageBufferRange", limits.maxStorageBufferRange);
  }
  if (has(desc.usage, BufferUsage::texel)) return checkTexelFormat(device, desc);
  return {};
}

/// The bytes that a buffer is made with. Mesa's software device (22.3) compiles a shader anew, at the dispatch, when a
/// texel buffer is the first that is, or is not, a power of two long, or whose length has, or has not, an empty second
/// byte. A little room at the end makes all of them neither.
size_t roomFor(const Device& device, const BufferDesc& desc) {
  if (!has(desc.usage, BufferUsage::texel)) return desc.size;
  BufferDesc padded = desc;
  const auto peculiar = [](size_t size) { return (size & (size - 1)) == 0 || (size & 0xff00) == 0; };
  for (padded.size = (desc.size + 255) & ~size_t(255); peculiar(padded.size);) padded.size += 256;
  return checkLimits(device, padded).ok() ? padded.size : desc.size;
}

}  // namespace

Result<Buffer> Buffer::create(Device& device, const BufferDesc& desc) {
  LIMN_CHECK(desc.size > 0);
  if (auto fits = checkLimits(device, desc); !fits) return fits.error();
  Buffer buffer;
  buffer.m_device = &device;
  buffer.m_size = desc.size;
  buffer.m_usage = desc.usage;
  buffer.m_name = desc.name;
  buffer.m_owner = desc.owner;
  auto info = typed<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.size = roomFor(device, desc);
  info.usage = usageFlags(device, desc.usage);
  if (const VkResult r = vkCreateBuffer(device.handle(), &info, nullptr, &buffer.m_handle); r != VK_SUCCESS) {
    return deviceError(r, "vkCreateBuffer for " + desc.name);
  }
  device.setName(VK_OBJECT_TYPE_BUFFER, uint64_t(buffer.m_handle), desc.name);
  if (auto done = buffer.allocate(desc.memory); !done) return done.error();
  if (has(desc.usage, BufferUsage::texel)) {
    if (auto done = buffer.createView(desc.texelFormat); !done) return done.error();
  }
  return buffer;
}

Result<void> Buffer::allocate(MemoryKind kind) {
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(m_device->handle(), m_handle, &needs);
  const auto allocation = allocateMemory(*m_device, needs, kind, needsAddress(*m_device, m_usage), m_name);
  if (!allocation) return allocation.error();
  m_memory = allocation->memory;
  m_mapped = allocation->mapped;
  m_allocatedBytes = allocation->bytes;
  m_device->memoryUse().add(m_owner, m_allocatedBytes);
  const VkResult r = vkBindBufferMemory(m_device->handle(), m_handle, m_memory, 0);
  if (r != VK_SUCCESS) return deviceError(r, "vkBindBufferMemory for " + m_name);
  if (!needsAddress(*m_device, m_usage)) return {};
  auto info = typed<VkBufferDeviceAddressInfo>(VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO);
  info.buffer = m_handle;
  m_address = vkGetBufferDeviceAddress(m_device->handle(), &info);
  return {};
}

Result<void> Buffer::createView(VkFormat format) {
  auto info = typed<VkBufferViewCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO);
  info.buffer = m_handle;
  info.format = format;
  info.range = VK_WHOLE_SIZE;
  const VkResult r = vkCreateBufferView(m_device->handle(), &info, nullptr, &m_view);
  if (r != VK_SUCCESS) return deviceError(r, "vkCreateBufferView for " + m_name);
  m_device->setName(VK_OBJECT_TYPE_BUFFER_VIEW, uint64_t(m_view), m_name);
  return {};
}

Buffer::~Buffer() { destroy(); }

Buffer::Buffer(Buffer&& other) noexcept { *this = std::move(other); }

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  if (this == &other) return *this;
  destroy();
  m_device = std::exchange(other.m_device, nullptr);
  m_handle = std::exchange(other.m_handle, VK_NULL_HANDLE);
  m_memory = std::exchange(other.m_memory, VK_NULL_HANDLE);
  m_view = std::exchange(other.m_view, VK_NULL_HANDLE);
  m_address = std::exchange(other.m_address, 0);
  m_mapped = std::exchange(other.m_mapped, nullptr);
  m_size = std::exchange(other.m_size, 0);
  m_allocatedBytes = std::exchange(other.m_allocatedBytes, 0);
  m_usage = std::exchange(other.m_usage, BufferUsage::none);
  m_name = std::move(other.m_name);
  m_owner = std::move(other.m_owner);
  return *this;
}

void Buffer::destroy() {
  if (!m_device || !m_handle) return;
  m_device->retire([device = m_device, view = m_view, handle = m_handle, memory = m_memory, bytes = m_allocatedBytes,
                    owner = m_owner] {
    vkDestroyBufferView(device->handle(), view, nullptr);
    vkDestroyBuffer(device->handle(), handle, nullptr);
    vkFreeMemory(device->handle(), memory, nullptr);
    if (memory) device->memoryUse().remove(owner, bytes);
  });
  m_handle = VK_NULL_HANDLE;
}

}  // namespace limn::vk
