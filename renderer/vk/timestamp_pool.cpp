#include "renderer/vk/timestamp_pool.hpp"

#include <utility>

#include "renderer/vk/command_recorder.hpp"

namespace limn::vk {

Result<TimestampPool> TimestampPool::create(Device& device, uint32_t maxStages, const std::string& name) {
  LIMN_CHECK(maxStages > 0);
  TimestampPool pool;
  pool.m_device = &device;
  pool.m_maxStages = maxStages;
  if (device.limits().timestampPeriodNs == 0) return pool;
  auto info = typed<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = pool.slotCount();
  if (const VkResult r = vkCreateQueryPool(device.handle(), &info, nullptr, &pool.m_handle); r != VK_SUCCESS) {
    return deviceError(r, "vkCreateQueryPool");
  }
  device.setName(VK_OBJECT_TYPE_QUERY_POOL, uint64_t(pool.m_handle), name);
  return pool;
}

void TimestampPool::reset(CommandRecorder& recorder) {
  LIMN_CHECK(!m_open);
  m_stages.clear();
  if (m_handle && recorder.handle()) vkCmdResetQueryPool(recorder.handle(), m_handle, 0, slotCount());
}

void TimestampPool::begin(CommandRecorder& recorder, std::string_view stage) {
  LIMN_CHECK(!m_open);
  LIMN_CHECK_LE(m_stages.size() + 1, m_maxStages);
  m_open = true;
  recorder.writeTimestamp(*this, uint32_t(2 * m_stages.size()));
  m_stages.emplace_back(stage);
}

void TimestampPool::end(CommandRecorder& recorder) {
  LIMN_CHECK(m_open);
  m_open = false;
  recorder.writeTimestamp(*this, uint32_t(2 * m_stages.size() - 1));
}

Result<std::vector<uint64_t>> TimestampPool::readTicks() const {
  LIMN_CHECK(!m_open);
  std::vector<uint64_t> ticks(2 * m_stages.size());
  if (ticks.empty() || !m_handle) return ticks;
  const VkResult r = vkGetQueryPoolResults(m_device->handle(), m_handle, 0, uint32_t(ticks.size()),
                                           ticks.size() * sizeof(uint64_t), ticks.data(), sizeof(uint64_t),
                                           VK_QUERY_RESULT_64_BIT);
  if (r == VK_NOT_READY) return Error{"not-ready", "the timed submission is not done", ""};
  if (r != VK_SUCCESS) return deviceError(r, "vkGetQueryPoolResults");
  return ticks;
}

Result<std::vector<StageTime>> TimestampPool::read() const {
  const auto ticks = readTicks();
  if (!ticks) return ticks.error();
  const double msPerTick = m_device->limits().timestampPeriodNs * 1e-6;
  std::vector<StageTime> times;
  for (size_t i = 0; i < m_stages.size(); ++i) {
    times.push_back({m_stages[i], double((*ticks)[2 * i + 1] - (*ticks)[2 * i]) * msPerTick});
  }
  return times;
}

TimestampPool::~TimestampPool() { destroy(); }

TimestampPool::TimestampPool(TimestampPool&& other) noexcept { *this = std::move(other); }

TimestampPool& TimestampPool::operator=(TimestampPool&& other) noexcept {
  if (this == &other) return *this;
  destroy();
  m_device = std::exchange(other.m_device, nullptr);
  m_handle = std::exchange(other.m_handle, VK_NULL_HANDLE);
  m_maxStages = std::exchange(other.m_maxStages, 0);
  m_open = std::exchange(other.m_open, false);
  m_stages = std::move(other.m_stages);
  return *this;
}

void TimestampPool::destroy() {
  if (!m_handle) return;
  m_device->retire([device = m_device, handle = m_handle] { vkDestroyQueryPool(device->handle(), handle, nullptr); });
  m_handle = VK_NULL_HANDLE;
}

}  // namespace limn::vk
