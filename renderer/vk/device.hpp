#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/vk/device_info.hpp"
#include "renderer/vk/memory_use.hpp"

namespace limn::vk {

class CommandRecorder;
class Instance;
class PipelineCache;
class Queue;
class ValidationLog;

/// How many compute pipelines the device has made, and what that cost. A test that compares two snapshots proves that
/// nothing is compiled after warm-up: some drivers compile at the first dispatch, which `firstUses` counts.
struct PipelineStats {
  uint32_t created = 0;
  double createMs = 0;     ///< sum of the time inside vkCreateComputePipelines [ms]
  uint32_t firstUses = 0;  ///< pipelines that were recorded for the first time
};

/// Extension entry points; null where the extension is not on.
struct DeviceFunctions {
  PFN_vkCmdPushDescriptorSetKHR cmdPushDescriptorSet = nullptr;
  PFN_vkSetDebugUtilsObjectNameEXT setObjectName = nullptr;
  PFN_vkGetAccelerationStructureBuildSizesKHR getAccelerationStructureBuildSizes = nullptr;
  PFN_vkCreateAccelerationStructureKHR createAccelerationStructure = nullptr;
  PFN_vkDestroyAccelerationStructureKHR destroyAccelerationStructure = nullptr;
  PFN_vkCmdBuildAccelerationStructuresKHR cmdBuildAccelerationStructures = nullptr;
  PFN_vkGetAccelerationStructureDeviceAddressKHR getAccelerationStructureDeviceAddress = nullptr;
};

/// An opened Vulkan 1.3 device with one compute queue. Every other object of this layer is made from it and must be
/// destroyed before it. All of it belongs to one thread, the render thread.
class Device {
 public:
  static constexpr uint64_t kForever = ~uint64_t(0);

  /// Errors: "no-device" (nothing matches `select`), "unsupported" (a needed feature or the validation layer is
  /// absent), "device" (the driver failed). With a cacheDir, software drivers keep their compiled shaders there as
  /// well; that is told to them through the environment, so open the device before other threads read it.
  static Result<std::unique_ptr<Device>> open(const DeviceOptions& options);
  /// Every device the machine has, in the order in which indices count.
  static Result<std::vector<DeviceInfo>> list();

  /// Waits for the device, writes the pipeline cache, and checks that every buffer is gone.
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const { return m_info; }
  const DeviceLimits& limits() const { return m_limits; }
  const DeviceFeatures& features() const { return m_features; }
  bool hasRayQuery() const { return m_features.rayQuery; }
  /// True once a call answered VK_ERROR_DEVICE_LOST: nothing works any more, the process must start anew.
  bool lost() const;

  /// Hands an ended recording to the queue and returns the timeline value that will say it is done. The recorder
  /// can begin again at once. Errors of recording come out here. Errors: "device-lost", "out-of-memory", "device".
  Result<uint64_t> submit(CommandRecorder& recorder);
  /// Blocks until `value` was reached. Errors: "timeout", "device-lost".
  Result<void> wait(uint64_t value, uint64_t timeoutNs = kForever);
  /// Waits for everything submitted so far.
  Result<void> waitIdle();
  bool reached(uint64_t value) const;
  uint64_t lastSubmitted() const;

  const MemoryUse& memory() const { return m_memory; }
  const PipelineStats& pipelineStats() const { return m_pipelineStats; }
  /// Writes the cache to cacheDir (atomically); does nothing without one. Errors: "io".
  Result<void> savePipelineCache() const;
  /// True when the cache file of an earlier run was there, whole, and made by this very driver.
  bool pipelineCacheLoaded() const;
  /// Empty without a cacheDir.
  std::string pipelineCachePath() const;

  bool validation() const { return m_options.validation; }
  /// Warnings and errors so far; 0 without DeviceOptions::validation.
  uint64_t validationMessageCount() const;
  /// The first few messages, for a test's output.
  std::vector<std::string> validationMessages() const;
  /// The same, for who wants to see what the device's own end says.
  std::shared_ptr<const ValidationLog> validationLog() const;

  // For the other objects of this layer.
  VkDevice handle() const { return m_handle; }
  VkPhysicalDevice physical() const { return m_physical; }
  uint32_t queueFamily() const { return m_queueFamily; }
  Queue& queue() { return *m_queue; }
  const DeviceOptions& options() const { return m_options; }
  const DeviceFunctions& functions() const { return m_functions; }
  MemoryUse& memoryUse() { return m_memory; }
  PipelineStats& mutablePipelineStats() { return m_pipelineStats; }
  std::optional<uint32_t>& pipelinesAllowed() { return m_pipelinesAllowed; }  ///< of PipelineAllowance
  VkPipelineCache pipelineCache() const;
  /// Shown by validation messages and captures; does nothing without VK_EXT_debug_utils.
  void setName(VkObjectType type, uint64_t handle, const std::string& name) const;
  /// Runs `destroy` once everything submitted so far is done: at once when it is, else at a later submit or wait.
  /// This is why a buffer may be dropped while the device still reads it.
  void retire(std::function<void()> destroy);

 private:
  explicit Device(DeviceOptions options);
  Result<void> init();
  void loadFunctions();

  DeviceOptions m_options;
  DeviceInfo m_info;
  DeviceLimits m_limits;
  DeviceFeatures m_features;
  DeviceFunctions m_functions;
  std::unique_ptr<Instance> m_instance;
  VkPhysicalDevice m_physical = VK_NULL_HANDLE;
  VkDevice m_handle = VK_NULL_HANDLE;
  uint32_t m_queueFamily = 0;
  std::unique_ptr<Queue> m_queue;
  std::unique_ptr<PipelineCache> m_pipelineCache;
  MemoryUse m_memory;
  PipelineStats m_pipelineStats;
  std::optional<uint32_t> m_pipelinesAllowed;
};

}  // namespace limn::vk
