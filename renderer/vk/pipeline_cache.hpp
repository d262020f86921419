#pragma once
#include <memory>
#include <string>

#include "renderer/vk/device.hpp"

namespace limn::vk {

/// VkPipelineCache with its file, whose name holds vendor, device, driver UUID, cache UUID and driver version. A
/// file that is torn, altered or of another driver is ignored with a warning. Render thread.
class PipelineCache {
 public:
  /// `directory` "" keeps no file. Errors: "out-of-memory".
  static Result<std::unique_ptr<PipelineCache>> create(Device& device, const std::string& directory);
  ~PipelineCache();
  PipelineCache(const PipelineCache&) = delete;
  PipelineCache& operator=(const PipelineCache&) = delete;

  /// Writes beside the file and renames, so that a reader sees the old bytes or the new. Errors: "io", "device".
  Result<void> save() const;
  VkPipelineCache handle() const { return m_handle; }
  bool loaded() const { return m_loaded; }
  const std::string& path() const { return m_path; }

 private:
  explicit PipelineCache(Device& device) : m_device(device) {}

  Device& m_device;
  VkPipelineCache m_handle = VK_NULL_HANDLE;
  std::string m_path;
  bool m_loaded = false;
};

}  // namespace limn::vk
