#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "renderer/vk/device.hpp"

namespace limn::vk {

struct ImageDesc {
  uint32_t width = 0, height = 0;
  uint32_t layers = 1;  ///< bound as an array image always
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  bool storage = false;  ///< written by shaders as well
  VkFilter filter = VK_FILTER_LINEAR;
  VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_REPEAT;
  std::string name;
  std::string owner;
};

/// A 2D array image with its view and sampler, device-local, one mip level. Render thread.
class Image {
 public:
  /// Errors: "limit", "unsupported" (the format cannot do what is asked), "out-of-memory".
  static Result<Image> create(Device& device, const ImageDesc& desc);

  Image() = default;
  ~Image();
  Image(Image&& other) noexcept;
  Image& operator=(Image&& other) noexcept;

  explicit operator bool() const { return m_handle != VK_NULL_HANDLE; }
  VkImage handle() const { return m_handle; }
  VkImageView view() const { return m_view; }
  VkSampler sampler() const { return m_sampler; }
  /// What the image is in between the calls of this layer: GENERAL with ImageDesc::storage, else
  /// SHADER_READ_ONLY_OPTIMAL.
  VkImageLayout layout() const { return m_layout; }
  uint32_t width() const { return m_width; }
  uint32_t height() const { return m_height; }
  uint32_t layers() const { return m_layers; }
  /// Replaces one layer by tightly packed texels, row by row from the top. Waits.
  Result<void> uploadLayer(uint32_t layer, std::span<const std::byte> texels);

 private:
  Result<void> allocate(const std::string& name);
  Result<void> createView(const ImageDesc& desc);
  void destroy();

  Device* m_device = nullptr;
  VkImage m_handle = VK_NULL_HANDLE;
  VkDeviceMemory m_memory = VK_NULL_HANDLE;
  VkImageView m_view = VK_NULL_HANDLE;
  VkSampler m_sampler = VK_NULL_HANDLE;
  uint32_t m_width = 0, m_height = 0, m_layers = 0;
  VkImageLayout m_layout = VK_IMAGE_LAYOUT_UNDEFINED;
  uint64_t m_allocatedBytes = 0;
  std::string m_owner;
};

}  // namespace limn::vk
