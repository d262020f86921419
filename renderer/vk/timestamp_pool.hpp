#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/vk/device.hpp"

namespace limn::vk {

class CommandRecorder;

struct StageTime {
  std::string stage;
  double ms = 0;  ///< device time [ms]
};

/// Device time of named stages of one submission: reset, then begin/end pairs (not nested) in one recording; read
/// when its timeline value was reached. Keep one pool for each submission in flight. On a queue without timestamps
/// the times are 0. Render thread.
class TimestampPool {
 public:
  /// Errors: "out-of-memory".
  static Result<TimestampPool> create(Device& device, uint32_t maxStages, const std::string& name);

  TimestampPool() = default;
  ~TimestampPool();
  TimestampPool(TimestampPool&& other) noexcept;
  TimestampPool& operator=(TimestampPool&& other) noexcept;

  /// Forgets the stages; the first thing in a recording.
  void reset(CommandRecorder& recorder);
  void begin(CommandRecorder& recorder, std::string_view stage);
  void end(CommandRecorder& recorder);
  /// Stages in recorded order; one that was begun twice is listed twice. Errors: "device-lost", "device".
  Result<std::vector<StageTime>> read() const;
  /// Raw ticks of the slots that were written, in order. Errors as read().
  Result<std::vector<uint64_t>> readTicks() const;

  VkQueryPool handle() const { return m_handle; }
  uint32_t slotCount() const { return 2 * m_maxStages; }

 private:
  void destroy();

  Device* m_device = nullptr;
  VkQueryPool m_handle = VK_NULL_HANDLE;
  uint32_t m_maxStages = 0;
  bool m_open = false;
  std::vector<std::string> m_stages;
};

}  // namespace limn::vk
