#include "renderer/vk/physical_device.hpp"

#include <algorithm>
#include <charconv>
#include <cctype>

namespace limn::vk {
namespace {

bool hasRayQueryExtensions(const std::set<std::string>& extensions) {
  return extensions.count(VK_KHR_RAY_QUERY_EXTENSION_NAME) &&
         extensions.count(VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME) &&
         extensions.count(VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME);
}

std::string versionText(uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

const char* typeWord(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return "cpu";
    default: return "other";
  }
}

int preference(const std::string& type) {
  if (type == "discrete") return 4;
  if (type == "integrated") return 3;
  if (type == "virtual") return 2;
  return type == "cpu" ? 1 : 0;
}

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// Why Limn cannot run on the device; empty when it can.
std::string refusal(VkPhysicalDevice device, uint32_t apiVersion) {
  if (apiVersion < VK_API_VERSION_1_3) return "it speaks Vulkan " + versionText(apiVersion) + ", 1.3 is needed";
  if (!computeQueueFamily(device)) return "it has no compute queue";
  FeatureChain chain(deviceExtensions(device));
  vkGetPhysicalDeviceFeatures2(device, &chain.root);
  if (!chain.v12.timelineSemaphore) return "it lacks timelineSemaphore";
  if (!chain.v12.scalarBlockLayout) return "it lacks scalarBlockLayout";
  if (!chain.v13.synchronization2) return "it lacks synchronization2";
  if (!chain.v13.maintenance4) return "it lacks maintenance4";
  return "";
}

}  // namespace

FeatureChain::FeatureChain(const std::set<std::string>& extensions) {
  void** tail = &root.pNext;
  const auto link = [&](auto& features, VkStructureType type) {
    features.sType = type;
    *tail = &features;
    tail = &features.pNext;
  };
  root.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  link(v11, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES);
  link(v12, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
  link(v13, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  if (extensions.count(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME)) {
    link(atomicFloat, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT);
  }
  if (hasRayQueryExtensions(extensions)) {
    link(acceleration, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR);
    link(rayQuery, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR);
  }
}

std::set<std::string> deviceExtensions(VkPhysicalDevice device) {
  uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> properties(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, properties.data());
  std::set<std::string> names;
  for (const VkExtensionProperties& property : properties) names.insert(property.extensionName);
  return names;
}

std::optional<uint32_t> computeQueueFamily(VkPhysicalDevice device) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  std::optional<uint32_t> found;
  for (uint32_t i = 0; i < count; ++i) {
    if (!(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)) continue;
    if (families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) return i;
    if (!found) found = i;
  }
  return found;
}

DeviceInfo describeDevice(VkPhysicalDevice device, uint32_t index) {
  auto driver = typed<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
  auto properties = typed<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
  properties.pNext = &driver;
  vkGetPhysicalDeviceProperties2(device, &properties);
  const VkPhysicalDeviceProperties& base = properties.properties;

  DeviceInfo info;
  info.index = index;
  info.name = base.deviceName;
  info.type = typeWord(base.deviceType);
  info.driver = std::string(driver.driverName) + (driver.driverInfo[0] ? ", " : "") + driver.driverInfo;
  info.driverVersion = std::to_string(base.driverVersion);
  info.apiVersion = versionText(base.apiVersion);

  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(device, &memory);
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    const VkMemoryHeap& heap = memory.memoryHeaps[i];
    info.heaps.push_back({heap.size, (heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0});
  }
  info.refusal = refusal(device, base.apiVersion);
  info.rayQuery = info.refusal.empty() && readFeatures(device).rayQuery;
  return info;
}

DeviceLimits readLimits(VkPhysicalDevice device) {
  auto push = typed<VkPhysicalDevicePushDescriptorPropertiesKHR>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PUSH_DESCRIPTOR_PROPERTIES_KHR);
  auto v13 = typed<VkPhysicalDeviceVulkan13Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES);
  auto v11 = typed<VkPhysicalDeviceVulkan11Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES);
  auto properties = typed<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
  properties.pNext = &v11;
  v11.pNext = &v13;
  if (deviceExtensions(device).count(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME)) v13.pNext = &push;
  vkGetPhysicalDeviceProperties2(device, &properties);
  const VkPhysicalDeviceLimits& base = properties.properties.limits;

  DeviceLimits limits;
  limits.maxMemoryAllocationSize = v11.maxMemoryAllocationSize;
  limits.maxBufferSize = v13.maxBufferSize;
  limits.maxStorageBufferRange = base.maxStorageBufferRange;
  limits.maxUniformBufferRange = base.maxUniformBufferRange;
  limits.maxTexelBufferElements = base.maxTexelBufferElements;
  limits.maxMemoryAllocationCount = base.maxMemoryAllocationCount;
  limits.maxSharedMemory = base.maxComputeSharedMemorySize;
  limits.maxWorkGroupInvocations = base.maxComputeWorkGroupInvocations;
  std::copy_n(base.maxComputeWorkGroupCount, 3, limits.maxWorkGroupCount.begin());
  std::copy_n(base.maxComputeWorkGroupSize, 3, limits.maxWorkGroupSize.begin());
  limits.maxPushConstants = base.maxPushConstantsSize;
  limits.maxPushDescriptors = push.maxPushDescriptors;
  limits.storageOffsetAlignment = uint32_t(base.minStorageBufferOffsetAlignment);
  limits.uniformOffsetAlignment = uint32_t(base.minUniformBufferOffsetAlignment);
  limits.subgroupSize = v11.subgroupSize;
  return limits;
}

DeviceFeatures readFeatures(VkPhysicalDevice device) {
  const std::set<std::string> extensions = deviceExtensions(device);
  FeatureChain chain(extensions);
  vkGetPhysicalDeviceFeatures2(device, &chain.root);
  DeviceFeatures features;
  features.pushDescriptors = extensions.count(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME) != 0;
  features.rayQuery =
      chain.rayQuery.rayQuery && chain.acceleration.accelerationStructure && chain.v12.bufferDeviceAddress;
  features.bufferFloat32AtomicAdd = chain.atomicFloat.shaderBufferFloat32AtomicAdd;
  features.sharedFloat32AtomicAdd = chain.atomicFloat.shaderSharedFloat32AtomicAdd;
  features.int64 = chain.root.features.shaderInt64;
  features.bufferInt64Atomics = chain.v12.shaderBufferInt64Atomics;
  features.sharedInt64Atomics = chain.v12.shaderSharedInt64Atomics;
  features.float64 = chain.root.features.shaderFloat64;
  features.storage8 = chain.v12.storageBuffer8BitAccess && chain.v12.shaderInt8;
  features.storage16 = chain.v11.storageBuffer16BitAccess && chain.root.features.shaderInt16;
  return features;
}

Result<size_t> chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& select) {
  if (devices.empty()) return Error{"no-device", "this machine has no Vulkan device", ""};
  size_t best = devices.size();
  uint32_t index = 0;
  const auto [end, failed] = std::from_chars(select.data(), select.data() + select.size(), index);
  const bool byIndex = !select.empty() && failed == std::errc() && end == select.data() + select.size();
  for (size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& device = devices[i];
    const bool nameFits = lowered(device.name).find(lowered(select)) != std::string::npos;
    const bool matches = byIndex ? device.index == index : nameFits;
    const bool eligible = matches && (device.refusal.empty() || !select.empty());
    if (eligible && (best == devices.size() || preference(device.type) > preference(devices[best].type))) best = i;
  }
  std::string known;
  for (const DeviceInfo& device : devices) {
    known += (known.empty() ? "" : ", ") + std::to_string(device.index) + " = " + device.name +
             (device.refusal.empty() ? "" : " (" + device.refusal + ")");
  }
  if (best == devices.size()) return Error{"no-device", "no Vulkan device is '" + select + "'; there is " + known, ""};
  if (!devices[best].refusal.empty()) {
    return Error{"unsupported", devices[best].name + " cannot be used: " + devices[best].refusal, ""};
  }
  return best;
}

}  // namespace limn::vk
