#include "renderer/vk/instance.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

#include "renderer/base/log.hpp"
#include "renderer/vk/test_environment.hpp"

namespace limn::vk {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                         VkDebugUtilsMessageTypeFlagsEXT types,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  // Loaders report through the same channel what other drivers of the machine lack; that says nothing about our calls.
  constexpr VkDebugUtilsMessageTypeFlagsEXT kOurs =
      VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  if ((types & kOurs) == 0) return VK_FALSE;
  const std::string text = data->pMessage ? data->pMessage : "";
  const bool isError = (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) != 0;
  log(isError ? LogLevel::error : LogLevel::warning, "validation: " + text);
  auto& messages = *static_cast<ValidationLog*>(user);
  messages.add(text);
  if (messages.endsProcess()) _exit(EXIT_FAILURE);
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationLog& log) {
  VkDebugUtilsMessengerCreateInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                     VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  info.pfnUserCallback = onMessage;
  info.pUserData = &log;
  return info;
}

bool layerPresent(const char* name) {
  uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(),
                     [&](const VkLayerProperties& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

bool extensionPresent(const char* layer, const char* name) {
  uint32_t count = 0;
  vkEnumerateInstanceExtensionProperties(layer, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data());
  return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, name) == 0;
  });
}

}  // namespace

void ValidationLog::add(std::string text) {
  m_count.fetch_add(1);
  const std::lock_guard lock(m_mutex);
  if (m_texts.size() < kKeptTexts) m_texts.push_back(std::move(text));
}

std::vector<std::string> ValidationLog::texts() const {
  const std::lock_guard lock(m_mutex);
  return m_texts;
}

Result<std::unique_ptr<Instance>> Instance::create(bool wanted) {
  const bool forced = testEnvironment().validation, validation = wanted || forced;
  if (validation && !layerPresent(kValidationLayer)) {
    return Error{"unsupported", std::string(kValidationLayer) + " is not installed", ""};
  }
  std::unique_ptr<Instance> instance(new Instance);
  if (forced) instance->m_log->endProcessAtMessages();
  instance->m_debugUtils = extensionPresent(nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) ||
                           (validation && extensionPresent(kValidationLayer, VK_EXT_DEBUG_UTILS_EXTENSION_NAME));

  std::vector<const char*> extensions;
  if (instance->m_debugUtils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  auto application = typed<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
  application.pApplicationName = "limn";
  application.apiVersion = VK_API_VERSION_1_3;
  auto info = typed<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
  info.pApplicationInfo = &application;

  VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(*instance->m_log);
  auto checks = typed<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
  const std::array enabled{VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  if (validation) {
    checks.enabledValidationFeatureCount = uint32_t(enabled.size());
    checks.pEnabledValidationFeatures = enabled.data();
    if (extensionPresent(kValidationLayer, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME)) {
      extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
      messenger.pNext = &checks;
    }
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
    if (instance->m_debugUtils) info.pNext = &messenger;
  }
  info.enabledExtensionCount = uint32_t(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  if (const VkResult r = vkCreateInstance(&info, nullptr, &instance->m_handle); r != VK_SUCCESS) {
    return deviceError(r, "vkCreateInstance");
  }
  if (validation) {
    if (auto made = instance->createMessenger(); !made) return made.error();
  }
  return instance;
}

Result<void> Instance::createMessenger() {
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(m_handle, "vkCreateDebugUtilsMessengerEXT"));
  if (!create) return Error{"unsupported", "validation needs VK_EXT_debug_utils", ""};
  const VkDebugUtilsMessengerCreateInfoEXT info = messengerInfo(*m_log);
  const VkResult r = create(m_handle, &info, nullptr, &m_messenger);
  if (r != VK_SUCCESS) return deviceError(r, "vkCreateDebugUtilsMessengerEXT");
  return {};
}

Instance::~Instance() {
  if (m_messenger) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(m_handle, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(m_handle, m_messenger, nullptr);
  }
  if (m_handle) vkDestroyInstance(m_handle, nullptr);
}

Result<std::vector<VkPhysicalDevice>> Instance::physicalDevices() const {
  uint32_t count = 0;
  if (const VkResult r = vkEnumeratePhysicalDevices(m_handle, &count, nullptr); r != VK_SUCCESS) {
    return deviceError(r, "vkEnumeratePhysicalDevices");
  }
  std::vector<VkPhysicalDevice> devices(count);
  const VkResult r = vkEnumeratePhysicalDevices(m_handle, &count, devices.data());
  if (r != VK_SUCCESS && r != VK_INCOMPLETE) return deviceError(r, "vkEnumeratePhysicalDevices");
  devices.resize(count);
  return devices;
}

}  // namespace limn::vk
