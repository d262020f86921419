#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "renderer/vk/device.hpp"

namespace limn::vk {

enum class BufferUsage : uint32_t {
  none = 0,
  storage = 1,
  uniform = 2,
  texel = 4,  ///< read-only `samplerBuffer` and kin; BufferDesc::texelFormat says the element
  transferSrc = 16,
  transferDst = 32,
  accelerationInput = 64,     ///< what an acceleration structure is built from; nothing without ray queries
  accelerationStorage = 128,  ///< AccelerationStructure's own
  scratch = 256,              ///< AccelerationStructure's own
};
constexpr BufferUsage operator|(BufferUsage a, BufferUsage b) { return BufferUsage(uint32_t(a) | uint32_t(b)); }
constexpr bool has(BufferUsage set, BufferUsage one) { return (uint32_t(set) & uint32_t(one)) != 0; }

enum class MemoryKind {
  deviceLocal,  ///< where shaders read fastest; mapped too where that memory is the host's own (CPU, most integrated)
  upload,       ///< host-visible and coherent, mapped; the host writes, the device reads
  readback,     ///< host-visible, coherent and cached where there is such, mapped; the device writes, the host reads
};

struct BufferDesc {
  size_t size = 0;  ///< bytes, > 0
  BufferUsage usage = BufferUsage::storage;
  MemoryKind memory = MemoryKind::deviceLocal;
  std::string name;   ///< debug name, "bvh.nodes"
  std::string owner;  ///< whose memory it is in the statistics, "visibility"
  VkFormat texelFormat = VK_FORMAT_UNDEFINED;  ///< element of the view, with BufferUsage::texel
};

/// A buffer with its own memory. Transfer usage is always added, so upload(), fill() and readBack() work on every
/// buffer. Contents are undefined until written. Destroying one that the device still uses is safe, one that a
/// recording names which was not submitted yet is not. Render thread.
class Buffer {
 public:
  /// Checks the device's limits before it allocates. Errors: "limit" (over a limit, which is named), "unsupported"
  /// (a texel format the device cannot read from a buffer), "out-of-memory".
  static Result<Buffer> create(Device& device, const BufferDesc& desc);

  Buffer() = default;
  ~Buffer();
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;

  explicit operator bool() const { return m_handle != VK_NULL_HANDLE; }
  size_t size() const { return m_size; }
  BufferUsage usage() const { return m_usage; }
  const std::string& name() const { return m_name; }
  VkBuffer handle() const { return m_handle; }
  /// The view over the whole buffer, and up to 767 bytes after it that hold nothing; null without BufferUsage::texel.
  VkBufferView view() const { return m_view; }
  /// Device address of byte 0 for acceleration structures; 0 with other usage or without ray queries.
  VkDeviceAddress address() const { return m_address; }
  /// Host address of byte 0, or null when this memory is not mapped. Coherent: no flush is needed, only that the
  /// device is not using the bytes.
  void* mapped() const { return m_mapped; }
  /// The mapped bytes as an array. Only on mapped buffers.
  template <class T>
  std::span<T> as() const {
    LIMN_CHECK(m_mapped != nullptr);
    return {static_cast<T*>(m_mapped), m_size / sizeof(T)};
  }

 private:
  Result<void> allocate(MemoryKind kind);
  Result<void> createView(VkFormat format);
  void destroy();

  Device* m_device = nullptr;
  VkBuffer m_handle = VK_NULL_HANDLE;
  VkDeviceMemory m_memory = VK_NULL_HANDLE;
  VkBufferView m_view = VK_NULL_HANDLE;
  VkDeviceAddress m_address = 0;
  void* m_mapped = nullptr;
  size_t m_size = 0;
  uint64_t m_allocatedBytes = 0;
  BufferUsage m_usage = BufferUsage::none;
  std::string m_name;
  std::string m_owner;
};

}  // namespace limn::vk
