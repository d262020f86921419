#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "renderer/vk/vulkan.hpp"

namespace limn::vk {

/// Warnings and errors of the validation layer. The driver may report from any thread; m_mutex guards the texts.
class ValidationLog {
 public:
  static constexpr size_t kKeptTexts = 16;

  void add(std::string text);
  uint64_t count() const { return m_count.load(); }
  /// The first kKeptTexts messages.
  std::vector<std::string> texts() const;
  /// From now on a message ends the process with exit 1, once it is logged.
  void endProcessAtMessages() { m_endsProcess = true; }
  bool endsProcess() const { return m_endsProcess; }

 private:
  std::atomic<uint64_t> m_count{0};
  mutable std::mutex m_mutex;
  std::vector<std::string> m_texts;
  bool m_endsProcess = false;  ///< set before the messenger is made
};

/// VkInstance with, on request or where TestEnvironment asks for it, the validation layer and a messenger that feeds
/// `log()`.
class Instance {
 public:
  static Result<std::unique_ptr<Instance>> create(bool validation);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return m_handle; }
  bool hasDebugUtils() const { return m_debugUtils; }
  bool validation() const { return m_messenger != VK_NULL_HANDLE; }
  /// Outlives the instance for who holds it, so that the messages of its end are seen too.
  std::shared_ptr<const ValidationLog> log() const { return m_log; }
  /// In the driver's order, which is the order of Device::list().
  Result<std::vector<VkPhysicalDevice>> physicalDevices() const;

 private:
  Instance() = default;
  Result<void> createMessenger();

  VkInstance m_handle = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT m_messenger = VK_NULL_HANDLE;
  bool m_debugUtils = false;
  std::shared_ptr<ValidationLog> m_log = std::make_shared<ValidationLog>();
};

}  // namespace limn::vk
