#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "renderer/vk/buffer.hpp"

namespace limn::vk {

class CommandRecorder;

/// Ends the recording, submits it and waits for it. Errors as Device::submit and Device::wait. Render thread.
Result<void> submitAndWait(Device& device, CommandRecorder& recorder);

/// Writes `bytes` to `dst` at `offset`. Waits for the device first, so nothing that runs sees half of it: memcpy
/// where the buffer is mapped, else through a staging buffer. For edits and loading, not for every frame. Render
/// thread. Errors: "out-of-memory", "device-lost".
Result<void> upload(Device& device, Buffer& dst, size_t offset, std::span<const std::byte> bytes);

template <class T>
Result<void> uploadArray(Device& device, Buffer& dst, std::span<const T> values, size_t offsetBytes = 0) {
  return upload(device, dst, offsetBytes, std::as_bytes(values));
}

/// Sets every 4-byte word of [offset, offset + size) to `word`; both are multiples of 4. Waits. Render thread.
Result<void> fill(Device& device, Buffer& dst, size_t offset, size_t size, uint32_t word);

/// The bytes as they are once everything submitted so far is done. Waits. Render thread.
Result<std::vector<std::byte>> readBack(Device& device, const Buffer& src, size_t offset, size_t size);

/// readBack() as an array of `count` values.
template <class T>
Result<std::vector<T>> readBackArray(Device& device, const Buffer& src, size_t count, size_t offsetBytes = 0) {
  auto bytes = readBack(device, src, offsetBytes, count * sizeof(T));
  if (!bytes) return bytes.error();
  const T* first = reinterpret_cast<const T*>(bytes->data());
  return std::vector<T>(first, first + count);
}

/// A deviceLocal buffer that holds `values`. `desc.size` is set from them. Errors as Buffer::create and upload.
template <class T>
Result<Buffer> createBufferWith(Device& device, BufferDesc desc, std::span<const T> values) {
  desc.size = values.size_bytes();
  auto buffer = Buffer::create(device, desc);
  if (!buffer) return buffer.error();
  if (auto done = uploadArray(device, *buffer, values); !done) return done.error();
  return buffer;
}

}  // namespace limn::vk
