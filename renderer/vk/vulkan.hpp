#pragma once
#include <vulkan/vulkan.h>

#include <string_view>

#include "renderer/base/result.hpp"

namespace limn::vk {

/// "VK_ERROR_DEVICE_LOST" and its kin.
const char* resultName(VkResult result);

/// An Error that names the failed call. Codes: "device-lost" (the process must start anew), "out-of-memory",
/// "unsupported", and "device" for the rest.
Error deviceError(VkResult result, std::string_view call);

}  // namespace limn::vk
