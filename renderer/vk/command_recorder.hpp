#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>

#include "renderer/vk/acceleration_structure.hpp"
#include "renderer/vk/buffer.hpp"
#include "renderer/vk/compute_pipeline.hpp"

namespace limn::vk {

struct CommandSlot;

/// A resource for one binding of the shader. Make it with storage(), uniform(), texel() or
/// acceleration().
struct Binding {
  uint32_t binding = 0;
  BindingKind kind = BindingKind::storage;
  const Buffer* buffer = nullptr;
  size_t offset = 0;
  size_t size = 0;  ///< 0: to the end
  const AccelerationStructure* acceleration = nullptr;
};

inline Binding storage(uint32_t binding, const Buffer& buffer, size_t offset = 0, size_t size = 0) {
  return {binding, BindingKind::storage, &buffer, offset, size, nullptr};
}
inline Binding uniform(uint32_t binding, const Buffer& buffer, size_t offset = 0, size_t size = 0) {
  return {binding, BindingKind::uniform, &buffer, offset, size, nullptr};
}
inline Binding texel(uint32_t binding, const Buffer& buffer) {
  return {binding, BindingKind::texel, &buffer, 0, 0, nullptr};
}
inline Binding acceleration(uint32_t binding, const AccelerationStructure& structure) {
  return {binding, BindingKind::acceleration, nullptr, 0, 0, &structure};
}

/// The bytes of a push-constant struct.
template <class T>
std::span<const std::byte> pushBytes(const T& value) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= 128 && sizeof(T) % 4 == 0);
  return std::as_bytes(std::span<const T, 1>(&value, 1));
}

/// Records one submission: begin, commands, end, Device::submit; then it can begin again. What the environment
/// breaks while recording is kept and comes out of submit(). Commands of one recording run in order but overlap:
/// put barrier() between a writer and its reader. Between submissions nothing is needed, end() has one. Render
/// thread.
class CommandRecorder {
 public:
  explicit CommandRecorder(Device& device);
  ~CommandRecorder();
  CommandRecorder(const CommandRecorder&) = delete;
  CommandRecorder& operator=(const CommandRecorder&) = delete;

  void begin();
  void end();

  /// Runs gx × gy × gz workgroups. `bindings` covers the pipeline's layout exactly, `pushConstants` is as long as
  /// the pipeline says. A count of 0 runs nothing.
  void dispatch(const ComputePipeline& pipeline, std::span<const Binding> bindings,
                std::span<const std::byte> pushConstants, uint32_t gx, uint32_t gy = 1, uint32_t gz = 1);
  /// A dispatch of no workgroup, for drivers that compile at first use: bind what the real dispatches bind.
  void warmUp(const ComputePipeline& pipeline, std::span<const Binding> bindings);
  /// All earlier shader and transfer writes are visible to all later shader and transfer reads and to the host.
  void barrier();
  void copyBuffer(const Buffer& src, size_t srcOffset, const Buffer& dst, size_t dstOffset, size_t size);
  /// Offset and size are multiples of 4; size 0: to the end.
  void fillBuffer(const Buffer& dst, size_t offset, size_t size, uint32_t word);

  bool recording() const { return m_recording; }
  Device& device() { return m_device; }
  VkCommandBuffer handle() const;

 private:
  friend class Device;
  friend class Queue;
  void bind(const ComputePipeline& pipeline, std::span<const Binding> bindings,
            std::span<const std::byte> pushConstants);
  void fail(VkResult result, const char* call);

  Device& m_device;
  CommandSlot* m_slot = nullptr;  ///< owned by the Queue; ours from begin() to submit()
  bool m_recording = false;
  bool m_ended = false;
  std::optional<Error> m_error;
};

}  // namespace limn::vk
