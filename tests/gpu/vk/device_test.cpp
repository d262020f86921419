#include "tests/gpu/vk/vk_fixture.hpp"

#include <algorithm>
#include <cctype>

#include "renderer/vk/physical_device.hpp"

namespace limn::vk {
namespace {

DeviceInfo named(uint32_t index, const char* name, const char* type, const char* refusal = "") {
  DeviceInfo info;
  info.index = index;
  info.name = name;
  info.type = type;
  info.refusal = refusal;
  return info;
}

const std::vector<DeviceInfo> kMachine{named(0, "llvmpipe (LLVM 15)", "cpu"), named(1, "Iris Xe", "integrated"),
                                       named(2, "GeForce Old", "discrete", "it speaks Vulkan 1.1"),
                                       named(3, "GeForce New", "discrete")};

TEST(ChooseDevice, PrefersADiscreteDeviceThatWorks) { EXPECT_EQ(must(chooseDevice(kMachine, "")), 3u); }

TEST(ChooseDevice, TakesAnIndex) { EXPECT_EQ(must(chooseDevice(kMachine, "1")), 1u); }

TEST(ChooseDevice, TakesPartOfANameInAnyCase) { EXPECT_EQ(must(chooseDevice(kMachine, "LLVMpipe")), 0u); }

TEST(ChooseDevice, SaysWhyANamedDeviceIsRefused) {
  const auto chosen = chooseDevice(kMachine, "geforce old");
  ASSERT_FALSE(chosen.ok());
  EXPECT_EQ(chosen.error().code, "unsupported");
  EXPECT_NE(chosen.error().message.find("Vulkan 1.1"), std::string::npos);
}

TEST(ChooseDevice, ListsWhatThereIsWhenNothingMatches) {
  for (const char* select : {"radeon", "4", "-1", "1x"}) {
    const auto chosen = chooseDevice(kMachine, select);
    ASSERT_FALSE(chosen.ok()) << select;
    EXPECT_EQ(chosen.error().code, "no-device");
    EXPECT_NE(chosen.error().message.find("1 = Iris Xe"), std::string::npos) << chosen.error().message;
  }
  EXPECT_EQ(chooseDevice({}, "").error().code, "no-device");
}

TEST(DeviceErrors, HaveStableCodes) {
  EXPECT_EQ(deviceError(VK_ERROR_DEVICE_LOST, "vkQueueSubmit2").code, "device-lost");
  EXPECT_EQ(deviceError(VK_ERROR_OUT_OF_DEVICE_MEMORY, "vkAllocateMemory").code, "out-of-memory");
  EXPECT_EQ(deviceError(VK_ERROR_LAYER_NOT_PRESENT, "vkCreateInstance").code, "unsupported");
  EXPECT_EQ(deviceError(VK_ERROR_INITIALIZATION_FAILED, "vkCreateDevice").text(),
            "vkCreateDevice failed with VK_ERROR_INITIALIZATION_FAILED");
}

TEST(DeviceList, DescribesEveryDevice) {
  const auto devices = must(Device::list());
  ASSERT_FALSE(devices.empty());
  for (size_t i = 0; i < devices.size(); ++i) {
    EXPECT_EQ(devices[i].index, i);
    EXPECT_FALSE(devices[i].name.empty());
    EXPECT_FALSE(devices[i].driver.empty());
    EXPECT_FALSE(devices[i].heaps.empty());
    EXPECT_EQ(std::count(devices[i].apiVersion.begin(), devices[i].apiVersion.end(), '.'), 2);
  }
}

TEST(DeviceOpen, ByIndexAndByNameIsTheSameDevice) {
  const auto devices = must(Device::list());
  const auto usable = std::find_if(devices.begin(), devices.end(), [](const auto& d) { return d.refusal.empty(); });
  ASSERT_NE(usable, devices.end());
  DeviceOptions options;
  options.select = std::to_string(usable->index);
  EXPECT_EQ(ValidatedDevice(options)->info().name, usable->name);
  options.select = usable->name;
  std::transform(options.select.begin(), options.select.end(), options.select.begin(), toupper);
  EXPECT_EQ(ValidatedDevice(options)->info().name, usable->name);
}

TEST(DeviceOpen, AWrongNameIsAnError) {
  DeviceOptions options;
  options.select = "no such device";
  const auto device = Device::open(options);
  ASSERT_FALSE(device.ok());
  EXPECT_EQ(device.error().code, "no-device");
  EXPECT_NE(device.error().message.find("no such device"), std::string::npos);
}

TEST(DeviceOpen, KnowsItsLimits) {
  const ValidatedDevice device;
  const DeviceLimits& limits = device->limits();
  // The least that Vulkan 1.3 promises.
  EXPECT_GE(limits.maxStorageBufferRange, 1u << 27);
  EXPECT_GE(limits.maxUniformBufferRange, 16384u);
  EXPECT_GE(limits.maxTexelBufferElements, 65536u);
  EXPECT_GE(limits.maxMemoryAllocationSize, 1u << 30);
  EXPECT_GE(limits.maxBufferSize, 1u << 30);
  EXPECT_GE(limits.maxSharedMemory, 16384u);
  EXPECT_GE(limits.maxWorkGroupInvocations, 128u);
  EXPECT_GE(limits.maxPushConstants, 128u);
  EXPECT_GE(limits.subgroupSize, 1u);
  for (int axis = 0; axis < 3; ++axis) EXPECT_GE(limits.maxWorkGroupCount[size_t(axis)], 65535u);
  EXPECT_GE(limits.maxPushDescriptors, device->features().pushDescriptors ? 32u : 0u);
  EXPECT_EQ(device->hasRayQuery(), device->info().rayQuery);
}

TEST(DeviceOpen, CountsWhatTheValidationLayerSays) {
  DeviceOptions options;
  options.validation = true;
  const auto device = must(Device::open(options));
  EXPECT_EQ(device->validationMessageCount(), 0u);
  auto info = typed<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;  // size 0 is the mistake
  VkBuffer buffer = VK_NULL_HANDLE;
  if (vkCreateBuffer(device->handle(), &info, nullptr, &buffer) == VK_SUCCESS) {
    vkDestroyBuffer(device->handle(), buffer, nullptr);
  }
  EXPECT_GE(device->validationMessageCount(), 1u);
  ASSERT_FALSE(device->validationMessages().empty());
  EXPECT_NE(device->validationMessages()[0].find("size"), std::string::npos);
}

}  // namespace
}  // namespace limn::vk
