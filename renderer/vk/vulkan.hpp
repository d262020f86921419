#pragma once
#include <vulkan/vulkan.h>

#include <string_view>

#include "renderer/base/result.hpp"

namespace limn::vk {

/// A Vulkan struct, all zero but for its sType.
template <class T>
T typed(VkStructureType type) {
  T value{};
  value.sType = type;
  return value;
}

/// "VK_ERROR_DEVICE_LOST" and its kin.
const char* resultName(VkResult result);

/// An Error that names the failed call. Codes: "device-lost" (the process must start anew), "out-of-memory",
/// "unsupported", and "device" for the rest.
Error deviceError(VkResult result, std::string_view call);

}  // namespace limn::vk
