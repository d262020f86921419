#include "renderer/vk/transfer.hpp"

#include <algorithm>
#include <cstring>

#include "renderer/vk/command_recorder.hpp"

namespace limn::vk {
namespace {

constexpr size_t kStagingBytes = size_t(16) << 20;

Result<Buffer> createStaging(Device& device, size_t size, MemoryKind kind) {
  BufferDesc desc;
  desc.size = std::min(size, kStagingBytes);
  desc.usage = BufferUsage::none;
  desc.memory = kind;
  desc.name = "staging";
  desc.owner = "staging";
  return Buffer::create(device, desc);
}

}  // namespace

Result<void> submitAndWait(Device& device, CommandRecorder& recorder) {
  recorder.end();
  const auto value = device.submit(recorder);
  if (!value) return value.error();
  return device.wait(*value);
}

Result<void> upload(Device& device, Buffer& dst, size_t offset, std::span<const std::byte> bytes) {
  LIMN_CHECK_LE(offset + bytes.size(), dst.size());
  if (bytes.empty()) return {};
  if (dst.mapped()) {
    if (auto idle = device.waitIdle(); !idle) return idle.error();
    std::memcpy(static_cast<std::byte*>(dst.mapped()) + offset, bytes.data(), bytes.size());
    return {};
  }
  const auto staging = createStaging(device, bytes.size(), MemoryKind::upload);
  if (!staging) return staging.error();
  CommandRecorder recorder(device);
  for (size_t done = 0; done < bytes.size(); done += kStagingBytes) {
    const size_t part = std::min(kStagingBytes, bytes.size() - done);
    std::memcpy(staging->mapped(), bytes.data() + done, part);
    recorder.begin();
    recorder.copyBuffer(*staging, 0, dst, offset + done, part);
    if (auto copied = submitAndWait(device, recorder); !copied) return copied.error();
  }
  return {};
}

Result<void> fill(Device& device, Buffer& dst, size_t offset, size_t size, uint32_t word) {
  CommandRecorder recorder(device);
  recorder.begin();
  recorder.fillBuffer(dst, offset, size, word);
  return submitAndWait(device, recorder);
}

Result<std::vector<std::byte>> readBack(Device& device, const Buffer& src, size_t offset, size_t size) {
  LIMN_CHECK_LE(offset + size, src.size());
  std::vector<std::byte> bytes(size);
  if (size == 0) return bytes;
  if (src.mapped()) {
    if (auto idle = device.waitIdle(); !idle) return idle.error();
    std::memcpy(bytes.data(), static_cast<const std::byte*>(src.mapped()) + offset, size);
    return bytes;
  }
  const auto staging = createStaging(device, size, MemoryKind::readback);
  if (!staging) return staging.error();
  CommandRecorder recorder(device);
  for (size_t done = 0; done < size; done += kStagingBytes) {
    const size_t part = std::min(kStagingBytes, size - done);
    recorder.begin();
    recorder.copyBuffer(src, offset + done, *staging, 0, part);
    if (auto copied = submitAndWait(device, recorder); !copied) return copied.error();
    std::memcpy(bytes.data() + done, staging->mapped(), part);
  }
  return bytes;
}

}  // namespace limn::vk
