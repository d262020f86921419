#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/vk/buffer.hpp"

namespace limn::vk {

class CommandRecorder;

/// N host-cached buffers through which results leave the device without a stop: record into a slot, submit, go on,
/// and read the slot when its timeline value was reached. Slots leave in the order in which they were taken. Render
/// thread.
class ReadbackRing {
 public:
  /// Errors as Buffer::create.
  static Result<ReadbackRing> create(Device& device, size_t slotBytes, uint32_t slotCount, const std::string& name,
                                     const std::string& owner);

  /// A free slot, or none when all are waiting to be read. A shader may write `buffer(slot)` itself; else record
  /// copy().
  std::optional<uint32_t> take();
  /// Storage buffer of the slot; mapped.
  const Buffer& buffer(uint32_t slot) const;
  /// Records src[offset, offset + size) → slot. The barrier before it is the caller's.
  void copy(CommandRecorder& recorder, uint32_t slot, const Buffer& src, size_t offset, size_t size);
  /// Says that the work which fills `slot` was submitted and is done at `timelineValue`.
  void submitted(uint32_t slot, uint64_t timelineValue);
  /// The oldest taken slot, if its value was reached.
  std::optional<uint32_t> ready() const;
  /// The slot's bytes in place, no copy; until release(). Only a slot that ready() named.
  std::span<const std::byte> bytes(uint32_t slot) const;
  /// Frees the oldest slot; also drops one that was taken and never submitted.
  void release(uint32_t slot);
  uint32_t pending() const { return m_pending; }
  size_t slotBytes() const { return m_slotBytes; }

 private:
  struct Slot {
    Buffer buffer;
    uint64_t timelineValue = 0;  ///< 0: not submitted yet
  };

  Device* m_device = nullptr;
  std::vector<Slot> m_slots;
  size_t m_slotBytes = 0;
  uint32_t m_oldest = 0;
  uint32_t m_pending = 0;
};

}  // namespace limn::vk
