#include "renderer/vk/memory_use.hpp"

#include "renderer/base/check.hpp"

namespace limn::vk {

void MemoryUse::add(const std::string& owner, uint64_t bytes) {
  m_byOwner[owner] += bytes;
  m_totalBytes += bytes;
  ++m_allocationCount;
}

void MemoryUse::remove(const std::string& owner, uint64_t bytes) {
  const auto entry = m_byOwner.find(owner);
  LIMN_CHECK(entry != m_byOwner.end());
  LIMN_CHECK_LE(bytes, entry->second);
  entry->second -= bytes;
  if (entry->second == 0) m_byOwner.erase(entry);
  m_totalBytes -= bytes;
  --m_allocationCount;
}

uint64_t MemoryUse::ofOwner(const std::string& owner) const {
  const auto entry = m_byOwner.find(owner);
  return entry == m_byOwner.end() ? 0 : entry->second;
}

}  // namespace limn::vk
