#pragma once
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "renderer/vk/device_info.hpp"
#include "renderer/vk/vulkan.hpp"

namespace limn::vk {

/// The feature structs that Limn asks for or looks at, chained below `root`. Not copyable: the chain holds addresses.
struct FeatureChain {
  VkPhysicalDeviceFeatures2 root{};
  VkPhysicalDeviceVulkan11Features v11{};
  VkPhysicalDeviceVulkan12Features v12{};
  VkPhysicalDeviceVulkan13Features v13{};
  VkPhysicalDeviceShaderAtomicFloatFeaturesEXT atomicFloat{};
  VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration{};
  VkPhysicalDeviceRayQueryFeaturesKHR rayQuery{};

  explicit FeatureChain(const std::set<std::string>& extensions);
  FeatureChain(const FeatureChain&) = delete;
  FeatureChain& operator=(const FeatureChain&) = delete;
};

/// Names of the device extensions.
std::set<std::string> deviceExtensions(VkPhysicalDevice device);
/// The first queue family that computes, if any; one that does nothing else is preferred less than a general one.
std::optional<uint32_t> computeQueueFamily(VkPhysicalDevice device);
DeviceInfo describeDevice(VkPhysicalDevice device, uint32_t index);
DeviceLimits readLimits(VkPhysicalDevice device);
DeviceFeatures readFeatures(VkPhysicalDevice device);
/// Index into `devices` by DeviceOptions::select. Errors: "no-device", "unsupported".
Result<size_t> chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& select);

}  // namespace limn::vk
