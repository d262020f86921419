#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/vk/vulkan.hpp"

namespace limn::vk {

/// Which device to open, and how.
struct DeviceOptions {
  std::string select;            ///< index in Device::list() or part of the name; "" prefers discrete, integrated, CPU
  bool validation = false;       ///< Khronos validation layer on, synchronization checks included; messages are counted
  std::string cacheDir;          ///< where the pipeline cache is kept between runs; "" keeps none
  bool assumeDiscrete = false;   ///< device-local memory is never mapped, as on a discrete GPU (tests the staging path)
  uint64_t largestBuffer = 0;    ///< [byte] lowers the device's own limit; 0 does not (tests what a small device refuses)
  bool pushDescriptors = true;   ///< false takes descriptors from pools even where push descriptors exist
};

struct MemoryHeapInfo {
  uint64_t bytes = 0;
  bool deviceLocal = false;
};

/// One physical device as `limn devices` shows it.
struct DeviceInfo {
  uint32_t index = 0;         ///< the number --device takes
  std::string name;
  std::string type;           ///< "discrete", "integrated", "virtual", "cpu", "other"
  std::string driver;         ///< "llvmpipe, Mesa 22.3.6 (LLVM 15.0.6)"
  std::string driverVersion;  ///< as the driver numbers itself, vendor-specific encoding left alone
  std::string apiVersion;     ///< "1.3.230"
  std::vector<MemoryHeapInfo> heaps;
  bool rayQuery = false;      ///< hardware ray traversal from compute shaders
  std::string refusal;        ///< why Limn cannot run on it; empty when it can
};

/// Limits the layers above plan with. Bytes unless said otherwise.
struct DeviceLimits {
  uint64_t maxMemoryAllocationSize = 0;
  uint64_t maxBufferSize = 0;
  uint64_t maxStorageBufferRange = 0;
  uint64_t maxUniformBufferRange = 0;
  uint64_t maxTexelBufferElements = 0;  ///< elements of a texel buffer
  uint32_t maxMemoryAllocationCount = 0;
  uint32_t maxSharedMemory = 0;             ///< of one workgroup
  uint32_t maxWorkGroupInvocations = 0;
  std::array<uint32_t, 3> maxWorkGroupCount{};
  std::array<uint32_t, 3> maxWorkGroupSize{};
  uint32_t maxPushConstants = 0;
  uint32_t maxPushDescriptors = 0;          ///< in one set; 0 without the extension
  uint32_t storageOffsetAlignment = 1;
  uint32_t uniformOffsetAlignment = 1;
  uint32_t subgroupSize = 0;                ///< invocations; shaders must not rely on a value
};

/// What the opened device has switched on. Everything here is optional; what Limn needs always is not listed.
struct DeviceFeatures {
  bool pushDescriptors = false;
  bool rayQuery = false;               ///< VK_KHR_ray_query, acceleration structures and buffer device addresses
  bool bufferFloat32AtomicAdd = false; ///< atomicAdd on float in storage buffers
  bool sharedFloat32AtomicAdd = false;
  bool int64 = false;
  bool bufferInt64Atomics = false;
  bool sharedInt64Atomics = false;
  bool float64 = false;
  bool storage8 = false;               ///< 8-bit types in storage buffers
  bool storage16 = false;              ///< 16-bit types in storage buffers
};

}  // namespace limn::vk
