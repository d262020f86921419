#include "renderer/vk/image.hpp"

#include <cstring>
#include <utility>

#include "renderer/vk/command_recorder.hpp"
#include "renderer/vk/memory.hpp"
#include "renderer/vk/transfer.hpp"

namespace limn::vk {
namespace {

constexpr VkImageSubresourceRange wholeRange(uint32_t layers) { return {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, layers}; }

VkImageUsageFlags usageFlags(const ImageDesc& desc) {
  return VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
         (desc.storage ? VkImageUsageFlags(VK_IMAGE_USAGE_STORAGE_BIT) : 0);
}

Result<void> checkLimits(const Device& device, const ImageDesc& desc) {
  VkImageFormatProperties most{};
  const VkResult r = vkGetPhysicalDeviceImageFormatProperties(
      device.physical(), desc.format, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL, usageFlags(desc), 0, &most);
  if (r == VK_ERROR_FORMAT_NOT_SUPPORTED) {
    return Error{"unsupported", desc.name + ": the device has no such image of VkFormat " +
                                    std::to_string(int(desc.format)), ""};
  }
  if (r != VK_SUCCESS) return deviceError(r, "vkGetPhysicalDeviceImageFormatProperties");
  const bool fits = desc.width <= most.maxExtent.width && desc.height <= most.maxExtent.height;
  if (fits && desc.layers <= most.maxArrayLayers) return {};
  return Error{"limit", desc.name + " wants " + std::to_string(desc.width) + "x" + std::to_string(desc.height) + "x" +
                            std::to_string(desc.layers) + " texels, the device holds at most " +
                            std::to_string(most.maxExtent.width) + "x" + std::to_string(most.maxExtent.height) + "x" +
                            std::to_string(most.maxArrayLayers), ""};
}

/// Orders everything before against everything after and changes the layout. Images are written at loading only, so the
/// widest barrier is good enough.
void transition(CommandRecorder& recorder, VkImage image, uint32_t layers, VkImageLayout from, VkImageLayout to) {
  if (!recorder.handle()) return;
  auto barrier = typed<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
  barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = wholeRange(layers);
  auto info = typed<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(recorder.handle(), &info);
}

}  // namespace

Result<Image> Image::create(Device& device, const ImageDesc& desc) {
  LIMN_CHECK(desc.width > 0 && desc.height > 0 && desc.layers > 0);
  if (auto fits = checkLimits(device, desc); !fits) return fits.error();
  Image image;
  image.m_device = &device;
  image.m_width = desc.width;
  image.m_height = desc.height;
  image.m_layers = desc.layers;
  image.m_layout = desc.storage ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  image.m_owner = desc.owner;
  auto info = typed<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = desc.format;
  info.extent = {desc.width, desc.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = desc.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = usageFlags(desc);
  if (const VkResult r = vkCreateImage(device.handle(), &info, nullptr, &image.m_handle); r != VK_SUCCESS) {
    return deviceError(r, "vkCreateImage for " + desc.name);
  }
  device.setName(VK_OBJECT_TYPE_IMAGE, uint64_t(image.m_handle), desc.name);
  if (auto done = image.allocate(desc.name); !done) return done.error();
  if (auto done = image.createView(desc); !done) return done.error();

  CommandRecorder recorder(device);
  recorder.begin();
  transition(recorder, image.m_handle, desc.layers, VK_IMAGE_LAYOUT_UNDEFINED, image.m_layout);
  if (auto done = submitAndWait(device, recorder); !done) return done.error();
  return image;
}

Result<void> Image::allocate(const std::string& name) {
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(m_device->handle(), m_handle, &needs);
  const auto allocation = allocateMemory(*m_device, needs, MemoryKind::deviceLocal, false, name);
  if (!allocation) return allocation.error();
  m_memory = allocation->memory;
  m_allocatedBytes = allocation->bytes;
  m_device->memoryUse().add(m_owner, m_allocatedBytes);
  const VkResult r = vkBindImageMemory(m_device->handle(), m_handle, m_memory, 0);
  if (r != VK_SUCCESS) return deviceError(r, "vkBindImageMemory for " + name);
  return {};
}

Result<void> Image::createView(const ImageDesc& desc) {
  auto info = typed<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
  info.image = m_handle;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  info.format = desc.format;
  info.subresourceRange = wholeRange(desc.layers);
  VkResult r = vkCreateImageView(m_device->handle(), &info, nullptr, &m_view);
  if (r != VK_SUCCESS) return deviceError(r, "vkCreateImageView for " + desc.name);
  m_device->setName(VK_OBJECT_TYPE_IMAGE_VIEW, uint64_t(m_view), desc.name);

  auto sampler = typed<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
  sampler.magFilter = sampler.minFilter = desc.filter;
  sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = desc.address;
  r = vkCreateSampler(m_device->handle(), &sampler, nullptr, &m_sampler);
  if (r != VK_SUCCESS) return deviceError(r, "vkCreateSampler for " + desc.name);
  m_device->setName(VK_OBJECT_TYPE_SAMPLER, uint64_t(m_sampler), desc.name);
  return {};
}

Result<void> Image::uploadLayer(uint32_t layer, std::span<const std::byte> texels) {
  LIMN_CHECK_LE(layer + 1, m_layers);
  LIMN_CHECK(!texels.empty() && texels.size() % (size_t(m_width) * m_height) == 0);
  BufferDesc desc;
  desc.size = texels.size();
  desc.usage = BufferUsage::none;
  desc.memory = MemoryKind::upload;
  desc.name = desc.owner = "staging";
  const auto staging = Buffer::create(*m_device, desc);
  if (!staging) return staging.error();
  std::memcpy(staging->mapped(), texels.data(), texels.size());

  CommandRecorder recorder(*m_device);
  recorder.begin();
  constexpr VkImageLayout kTarget = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  transition(recorder, m_handle, m_layers, m_layout, kTarget);
  if (recorder.handle()) {
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
    region.imageExtent = {m_width, m_height, 1};
    vkCmdCopyBufferToImage(recorder.handle(), staging->handle(), m_handle, kTarget, 1, &region);
  }
  transition(recorder, m_handle, m_layers, kTarget, m_layout);
  return submitAndWait(*m_device, recorder);
}

Image::~Image() { destroy(); }

Image::Image(Image&& other) noexcept { *this = std::move(other); }

Image& Image::operator=(Image&& other) noexcept {
  if (this == &other) return *this;
  destroy();
  m_device = std::exchange(other.m_device, nullptr);
  m_handle = std::exchange(other.m_handle, VK_NULL_HANDLE);
  m_memory = std::exchange(other.m_memory, VK_NULL_HANDLE);
  m_view = std::exchange(other.m_view, VK_NULL_HANDLE);
  m_sampler = std::exchange(other.m_sampler, VK_NULL_HANDLE);
  m_width = std::exchange(other.m_width, 0);
  m_height = std::exchange(other.m_height, 0);
  m_layers = std::exchange(other.m_layers, 0);
  m_layout = other.m_layout;
  m_allocatedBytes = std::exchange(other.m_allocatedBytes, 0);
  m_owner = std::move(other.m_owner);
  return *this;
}

void Image::destroy() {
  if (!m_handle) return;
  m_device->retire([device = m_device, sampler = m_sampler, view = m_view, handle = m_handle, memory = m_memory,
                    bytes = m_allocatedBytes, owner = m_owner] {
    vkDestroySampler(device->handle(), sampler, nullptr);
    vkDestroyImageView(device->handle(), view, nullptr);
    vkDestroyImage(device->handle(), handle, nullptr);
    vkFreeMemory(device->handle(), memory, nullptr);
    if (memory) device->memoryUse().remove(owner, bytes);
  });
  m_handle = VK_NULL_HANDLE;
}

}  // namespace limn::vk
