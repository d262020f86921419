#include "renderer/vk/device.hpp"

#include <cstdlib>
#include <type_traits>

#include "renderer/base/log.hpp"
#include "renderer/vk/command_recorder.hpp"
#include "renderer/vk/instance.hpp"
#include "renderer/vk/physical_device.hpp"
#include "renderer/vk/pipeline_cache.hpp"
#include "renderer/vk/queue.hpp"

namespace limn::vk {
namespace {

Result<std::vector<DeviceInfo>> describeAll(const std::vector<VkPhysicalDevice>& devices) {
  std::vector<DeviceInfo> infos;
  for (size_t i = 0; i < devices.size(); ++i) infos.push_back(describeDevice(devices[i], uint32_t(i)));
  return infos;
}

/// Switches on what Limn needs and, of what it can use, what the device has.
void enableFeatures(const FeatureChain& has, const DeviceFeatures& use, FeatureChain& on) {
  on.v12.timelineSemaphore = VK_TRUE;
  on.v12.scalarBlockLayout = VK_TRUE;
  on.v13.synchronization2 = VK_TRUE;
  on.v13.maintenance4 = VK_TRUE;
  on.root.features.shaderInt64 = use.int64;
  on.root.features.shaderFloat64 = use.float64;
  on.root.features.shaderInt16 = use.storage16;
  on.v11.storageBuffer16BitAccess = use.storage16;
  on.v12.storageBuffer8BitAccess = use.storage8;
  on.v12.shaderInt8 = use.storage8;
  on.v12.shaderBufferInt64Atomics = use.bufferInt64Atomics;
  on.v12.shaderSharedInt64Atomics = use.sharedInt64Atomics;
  on.v12.shaderSubgroupExtendedTypes = has.v12.shaderSubgroupExtendedTypes;
  on.atomicFloat.shaderBufferFloat32Atomics = has.atomicFloat.shaderBufferFloat32Atomics;
  on.atomicFloat.shaderBufferFloat32AtomicAdd = use.bufferFloat32AtomicAdd;
  on.atomicFloat.shaderSharedFloat32Atomics = has.atomicFloat.shaderSharedFloat32Atomics;
  on.atomicFloat.shaderSharedFloat32AtomicAdd = use.sharedFloat32AtomicAdd;
  on.v12.bufferDeviceAddress = use.rayQuery;
  on.acceleration.accelerationStructure = use.rayQuery;
  on.rayQuery.rayQuery = use.rayQuery;
}

/// Extensions to switch on; FeatureChain must be built from the same set, so that it links only their structs.
std::set<std::string> wantedExtensions(const std::set<std::string>& present, const DeviceFeatures& use) {
  std::set<std::string> wanted;
  if (use.pushDescriptors) wanted.insert(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
  const char* atomicFloat = VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME;
  if (present.count(atomicFloat)) wanted.insert(atomicFloat);
  if (use.rayQuery) {
    wanted.insert({VK_KHR_RAY_QUERY_EXTENSION_NAME, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                   VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME});
  }
  return wanted;
}

VkResult createDevice(VkPhysicalDevice physical, uint32_t queueFamily, const DeviceFeatures& use, VkDevice* device) {
  const std::set<std::string> present = deviceExtensions(physical);
  FeatureChain has(present);
  vkGetPhysicalDeviceFeatures2(physical, &has.root);
  const std::set<std::string> wanted = wantedExtensions(present, use);
  FeatureChain on(wanted);
  enableFeatures(has, use, on);

  std::vector<const char*> names;
  for (const std::string& name : wanted) names.push_back(name.c_str());
  const float priority = 1.0f;
  auto queue = typed<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  queue.queueFamilyIndex = queueFamily;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  auto info = typed<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
  info.pNext = &on.root;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = uint32_t(names.size());
  info.ppEnabledExtensionNames = names.data();
  return vkCreateDevice(physical, &info, nullptr, device);
}

}  // namespace

Device::Device(DeviceOptions options) : m_options(std::move(options)) {}

Result<std::unique_ptr<Device>> Device::open(const DeviceOptions& options) {
  std::unique_ptr<Device> device(new Device(options));
  if (auto done = device->init(); !done) return done.error();
  return device;
}

Result<std::vector<DeviceInfo>> Device::list() {
  auto instance = Instance::create(false);
  if (!instance) return instance.error();
  const auto devices = (*instance)->physicalDevices();
  if (!devices) return devices.error();
  return describeAll(*devices);
}

Result<void> Device::init() {
  // lavapipe compiles at the first dispatch and keeps the machine code in Mesa's own cache, not in VkPipelineCache.
  if (!m_options.cacheDir.empty()) setenv("MESA_SHADER_CACHE_DIR", m_options.cacheDir.c_str(), 0);
  auto instance = Instance::create(m_options.validation);
  if (!instance) return instance.error();
  m_instance = instance.take();
  const auto devices = m_instance->physicalDevices();
  if (!devices) return devices.error();
  const auto infos = describeAll(*devices);
  const auto chosen = chooseDevice(*infos, m_options.select);
  if (!chosen) return chosen.error();

  m_info = (*infos)[*chosen];
  m_physical = (*devices)[*chosen];
  m_queueFamily = *computeQueueFamily(m_physical);
  m_limits = readLimits(m_physical);
  if (m_options.largestBuffer > 0) m_limits.maxBufferSize = std::min(m_limits.maxBufferSize, m_options.largestBuffer);
  m_features = readFeatures(m_physical);
  m_features.pushDescriptors = m_features.pushDescriptors && m_options.pushDescriptors;
  if (const VkResult r = createDevice(m_physical, m_queueFamily, m_features, &m_handle); r != VK_SUCCESS) {
    return deviceError(r, "vkCreateDevice");
  }
  loadFunctions();
  auto queue = Queue::create(*this);
  if (!queue) return queue.error();
  m_queue = queue.take();
  auto cache = PipelineCache::create(*this, m_options.cacheDir);
  if (!cache) return cache.error();
  m_pipelineCache = cache.take();
  logInfo("device " + std::to_string(m_info.index) + ": " + m_info.name + " (" + m_info.type + "), Vulkan " +
          m_info.apiVersion + ", driver " + m_info.driver + ", version " + m_info.driverVersion +
          (m_features.rayQuery ? ", ray query" : ", no ray query") +
          (m_instance->validation() ? ", validation layer on" : "") +
          (m_pipelineCache->loaded() ? ", pipeline cache loaded" : ""));
  return {};
}

void Device::loadFunctions() {
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(vkGetDeviceProcAddr(m_handle, name));
    LIMN_CHECK(function != nullptr);
  };
  if (m_features.pushDescriptors) load(m_functions.cmdPushDescriptorSet, "vkCmdPushDescriptorSetKHR");
  if (m_instance->hasDebugUtils()) {
    m_functions.setObjectName = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
        vkGetInstanceProcAddr(m_instance->handle(), "vkSetDebugUtilsObjectNameEXT"));
  }
  if (!m_features.rayQuery) return;
  load(m_functions.getAccelerationStructureBuildSizes, "vkGetAccelerationStructureBuildSizesKHR");
  load(m_functions.createAccelerationStructure, "vkCreateAccelerationStructureKHR");
  load(m_functions.destroyAccelerationStructure, "vkDestroyAccelerationStructureKHR");
  load(m_functions.cmdBuildAccelerationStructures, "vkCmdBuildAccelerationStructuresKHR");
  load(m_functions.getAccelerationStructureDeviceAddress, "vkGetAccelerationStructureDeviceAddressKHR");
}

Device::~Device() {
  if (m_pipelineCache) {
    if (const auto saved = savePipelineCache(); !saved) logWarning(saved.error().text());
  }
  m_queue.reset();
  m_pipelineCache.reset();
  if (m_handle) {
    LIMN_CHECK_EQ(m_memory.allocationCount(), 0u);
    vkDestroyDevice(m_handle, nullptr);
  }
}

bool Device::lost() const { return m_queue->lost(); }

Result<uint64_t> Device::submit(CommandRecorder& recorder) {
  LIMN_CHECK(recorder.m_ended);
  recorder.m_ended = false;
  CommandSlot* slot = recorder.m_slot;
  recorder.m_slot = nullptr;
  if (recorder.m_error) {
    if (slot) m_queue->giveBack(*slot);
    return *recorder.m_error;
  }
  return m_queue->submit(*slot);
}

Result<void> Device::wait(uint64_t value, uint64_t timeoutNs) { return m_queue->wait(value, timeoutNs); }
Result<void> Device::waitIdle() { return m_queue->wait(m_queue->lastSubmitted(), kForever); }
bool Device::reached(uint64_t value) const { return m_queue->reached(value); }
uint64_t Device::lastSubmitted() const { return m_queue->lastSubmitted(); }
void Device::retire(std::function<void()> destroy) { m_queue->retire(std::move(destroy)); }

Result<void> Device::savePipelineCache() const { return m_pipelineCache->save(); }
bool Device::pipelineCacheLoaded() const { return m_pipelineCache->loaded(); }
std::string Device::pipelineCachePath() const { return m_pipelineCache->path(); }
VkPipelineCache Device::pipelineCache() const { return m_pipelineCache->handle(); }

uint64_t Device::validationMessageCount() const { return m_instance->log()->count(); }
std::vector<std::string> Device::validationMessages() const { return m_instance->log()->texts(); }
std::shared_ptr<const ValidationLog> Device::validationLog() const { return m_instance->log(); }

void Device::setName(VkObjectType type, uint64_t handle, const std::string& name) const {
  if (!m_functions.setObjectName || name.empty()) return;
  auto info = typed<VkDebugUtilsObjectNameInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT);
  info.objectType = type;
  info.objectHandle = handle;
  info.pObjectName = name.c_str();
  (void)m_functions.setObjectName(m_handle, &info);
}

}  // namespace limn::vk
