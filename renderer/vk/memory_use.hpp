#pragma once
#include <cstdint>
#include <map>
#include <string>

namespace limn::vk {

/// Device memory held, by the owner named in BufferDesc. Render thread; copy it to publish it.
class MemoryUse {
 public:
  void add(const std::string& owner, uint64_t bytes);
  void remove(const std::string& owner, uint64_t bytes);

  uint64_t totalBytes() const { return m_totalBytes; }
  uint32_t allocationCount() const { return m_allocationCount; }
  uint64_t ofOwner(const std::string& owner) const;
  /// Owner to bytes; an owner that gave everything back is not listed.
  const std::map<std::string, uint64_t>& byOwner() const { return m_byOwner; }

 private:
  std::map<std::string, uint64_t> m_byOwner;
  uint64_t m_totalBytes = 0;
  uint32_t m_allocationCount = 0;
};

}  // namespace limn::vk
