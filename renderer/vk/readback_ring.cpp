#include "renderer/vk/readback_ring.hpp"

#include "renderer/vk/command_recorder.hpp"

namespace limn::vk {

Result<ReadbackRing> ReadbackRing::create(Device& device, size_t slotBytes, uint32_t slotCount,
                                          const std::string& name, const std::string& owner) {
  LIMN_CHECK(slotCount > 0);
  ReadbackRing ring;
  ring.m_device = &device;
  ring.m_slotBytes = slotBytes;
  for (uint32_t i = 0; i < slotCount; ++i) {
    BufferDesc desc;
    desc.size = slotBytes;
    desc.memory = MemoryKind::readback;
    desc.name = name + "." + std::to_string(i);
    desc.owner = owner;
    auto buffer = Buffer::create(device, desc);
    if (!buffer) return buffer.error();
    ring.m_slots.push_back({buffer.take(), 0});
  }
  return ring;
}

std::optional<uint32_t> ReadbackRing::take() {
  if (m_pending == m_slots.size()) return std::nullopt;
  const uint32_t slot = (m_oldest + m_pending++) % uint32_t(m_slots.size());
  m_slots[slot].timelineValue = 0;
  return slot;
}

const Buffer& ReadbackRing::buffer(uint32_t slot) const { return m_slots.at(slot).buffer; }

void ReadbackRing::copy(CommandRecorder& recorder, uint32_t slot, const Buffer& src, size_t offset, size_t size) {
  recorder.copyBuffer(src, offset, m_slots.at(slot).buffer, 0, size);
}

void ReadbackRing::submitted(uint32_t slot, uint64_t timelineValue) {
  LIMN_CHECK(timelineValue > 0);
  m_slots.at(slot).timelineValue = timelineValue;
}

std::optional<uint32_t> ReadbackRing::ready() const {
  if (m_pending == 0) return std::nullopt;
  const uint64_t value = m_slots[m_oldest].timelineValue;
  if (value == 0 || !m_device->reached(value)) return std::nullopt;
  return m_oldest;
}

std::span<const std::byte> ReadbackRing::bytes(uint32_t slot) const {
  const Slot& entry = m_slots.at(slot);
  LIMN_CHECK(entry.timelineValue > 0 && m_device->reached(entry.timelineValue));
  return entry.buffer.as<const std::byte>();
}

void ReadbackRing::release(uint32_t slot) {
  LIMN_CHECK(m_pending > 0);
  LIMN_CHECK_EQ(slot, m_oldest);
  m_oldest = (m_oldest + 1) % uint32_t(m_slots.size());
  --m_pending;
}

}  // namespace limn::vk
