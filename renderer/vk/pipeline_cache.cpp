#include "renderer/vk/pipeline_cache.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "renderer/base/hash.hpp"
#include "renderer/base/log.hpp"

namespace limn::vk {
namespace {

constexpr uint64_t kMagic = 0x3143504e4d494cull;  // "LIMNPC1"

/// Before the driver's bytes in the file: drivers check little, and a torn file must not reach one.
struct FileHeader {
  uint64_t magic = kMagic;
  uint64_t payloadBytes = 0;
  uint64_t payloadHash = 0;
};

std::string hex(const uint8_t* bytes, size_t count) {
  std::string text;
  for (size_t i = 0; i < count; ++i) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", unsigned(bytes[i]));
    text += digits;
  }
  return text;
}

struct DriverKey {
  VkPhysicalDeviceProperties base{};
  std::string fileName;
};

DriverKey driverKey(VkPhysicalDevice physical) {
  // The UUIDs should change with the driver; lavapipe's do not, so its own version words are in the name as well.
  auto driver = typed<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
  auto ids = typed<VkPhysicalDeviceIDProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES);
  auto properties = typed<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
  properties.pNext = &ids;
  ids.pNext = &driver;
  vkGetPhysicalDeviceProperties2(physical, &properties);
  DriverKey key;
  key.base = properties.properties;
  const uint64_t versionHash = fnv1a(std::string(driver.driverInfo) + std::to_string(key.base.driverVersion));
  uint8_t version[sizeof versionHash];
  std::memcpy(version, &versionHash, sizeof version);
  char numbers[32];
  std::snprintf(numbers, sizeof numbers, "%08x_%08x_", key.base.vendorID, key.base.deviceID);
  key.fileName = "pipelines_" + std::string(numbers) + hex(ids.driverUUID, VK_UUID_SIZE) + "_" +
                 hex(key.base.pipelineCacheUUID, VK_UUID_SIZE) + "_" + hex(version, sizeof version) + ".bin";
  return key;
}

/// The driver's bytes, or nothing when the file is absent, damaged or another driver's.
std::vector<char> readPayload(const std::string& path, const VkPhysicalDeviceProperties& device) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  FileHeader header;
  bool whole = bytes.size() >= sizeof header + sizeof(VkPipelineCacheHeaderVersionOne);
  if (whole) {
    std::memcpy(&header, bytes.data(), sizeof header);
    whole = header.magic == kMagic && header.payloadBytes == bytes.size() - sizeof header &&
            header.payloadHash == fnv1a(bytes.data() + sizeof header, bytes.size() - sizeof header);
  }
  if (whole) {
    VkPipelineCacheHeaderVersionOne driver;
    std::memcpy(&driver, bytes.data() + sizeof header, sizeof driver);
    whole = driver.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && driver.vendorID == device.vendorID &&
            driver.deviceID == device.deviceID &&
            std::memcmp(driver.pipelineCacheUUID, device.pipelineCacheUUID, VK_UUID_SIZE) == 0;
  }
  if (!whole) {
    logWarning("pipeline cache " + path + " is damaged or not this driver's; it is ignored");
    return {};
  }
  return {bytes.begin() + sizeof header, bytes.end()};
}

Error ioError(const std::string& what, const std::string& path) { return {"io", what, path}; }

}  // namespace

Result<std::unique_ptr<PipelineCache>> PipelineCache::create(Device& device, const std::string& directory) {
  std::unique_ptr<PipelineCache> cache(new PipelineCache(device));
  std::vector<char> payload;
  if (!directory.empty()) {
    const DriverKey key = driverKey(device.physical());
    cache->m_path = (std::filesystem::path(directory) / key.fileName).string();
    payload = readPayload(cache->m_path, key.base);
  }
  auto info = typed<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
  info.initialDataSize = payload.size();
  info.pInitialData = payload.data();
  if (const VkResult r = vkCreatePipelineCache(device.handle(), &info, nullptr, &cache->m_handle); r != VK_SUCCESS) {
    return deviceError(r, "vkCreatePipelineCache");
  }
  cache->m_loaded = !payload.empty();
  return cache;
}

PipelineCache::~PipelineCache() { vkDestroyPipelineCache(m_device.handle(), m_handle, nullptr); }

Result<void> PipelineCache::save() const {
  if (m_path.empty()) return {};
  size_t size = 0;
  VkResult r = vkGetPipelineCacheData(m_device.handle(), m_handle, &size, nullptr);
  std::vector<char> payload(size);
  if (r == VK_SUCCESS) r = vkGetPipelineCacheData(m_device.handle(), m_handle, &size, payload.data());
  if (r != VK_SUCCESS) return deviceError(r, "vkGetPipelineCacheData");
  payload.resize(size);

  std::error_code failed;
  std::filesystem::create_directories(std::filesystem::path(m_path).parent_path(), failed);
  if (failed) return ioError("the cache directory cannot be made: " + failed.message(), m_path);
  const std::string temporary = m_path + "." + std::to_string(getpid());
  const FileHeader header{kMagic, payload.size(), fnv1a(payload.data(), payload.size())};
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(&header), sizeof header);
  file.write(payload.data(), std::streamsize(payload.size()));
  file.close();
  if (!file) {
    std::filesystem::remove(temporary, failed);
    return ioError("the pipeline cache cannot be written", temporary);
  }
  std::filesystem::rename(temporary, m_path, failed);
  if (failed) return ioError("the pipeline cache cannot be renamed: " + failed.message(), m_path);
  return {};
}

}  // namespace limn::vk
