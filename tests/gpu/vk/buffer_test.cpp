#include "tests/gpu/vk/vk_fixture.hpp"

#include <cstring>
#include <numeric>

namespace limn::vk {
namespace {

std::vector<uint32_t> countUp(size_t count, uint32_t first) {
  std::vector<uint32_t> values(count);
  std::iota(values.begin(), values.end(), first);
  return values;
}

class BufferTest : public OnEveryPath {};
INSTANTIATE_TEST_SUITE_P(Paths, BufferTest, testing::ValuesIn(kDevicePaths), pathName);

TEST_P(BufferTest, BytesComeBackFromEveryKindOfMemory) {
  for (const MemoryKind kind : {MemoryKind::deviceLocal, MemoryKind::upload, MemoryKind::readback}) {
    BufferDesc desc = storageDesc(4096, "round trip");
    desc.memory = kind;
    Buffer buffer = must(Buffer::create(*device, desc));
    must(fill(*device, buffer, 0, 4096, 0xabababab));
    const auto values = countUp(512, 7);
    must(uploadArray<uint32_t>(*device, buffer, values, 1024));
    const auto all = must(readBackArray<uint32_t>(*device, buffer, 1024));
    EXPECT_EQ(all[255], 0xababababu);
    EXPECT_TRUE(std::equal(values.begin(), values.end(), all.begin() + 256));
    EXPECT_EQ(all[768], 0xababababu);
    EXPECT_EQ(must(readBackArray<uint32_t>(*device, buffer, 2, 1028)), (std::vector<uint32_t>{8, 9}));
  }
}

TEST_P(BufferTest, HostMemoryIsMappedAndDeviceMemoryOnlyWhereItIsTheHosts) {
  for (const MemoryKind kind : {MemoryKind::upload, MemoryKind::readback}) {
    BufferDesc desc = storageDesc(256, "mapped");
    desc.memory = kind;
    EXPECT_NE(must(Buffer::create(*device, desc)).mapped(), nullptr);
  }
  const Buffer local = must(Buffer::create(*device, storageDesc(256, "local")));
  if (GetParam().assumeDiscrete || device->info().type == "discrete") {
    EXPECT_EQ(local.mapped(), nullptr);
  } else if (device->info().type == "cpu") {
    EXPECT_NE(local.mapped(), nullptr);
  }
}

TEST_P(BufferTest, WhatTheHostWritesToMappedMemoryTheDeviceReads) {
  BufferDesc desc = storageDesc(64, "written by the host");
  desc.memory = MemoryKind::upload;
  const Buffer source = must(Buffer::create(*device, desc));
  const Buffer target = must(Buffer::create(*device, storageDesc(64, "target")));
  for (uint32_t i = 0; i < 16; ++i) source.as<uint32_t>()[i] = i * i;
  CommandRecorder recorder(*device);
  recorder.begin();
  recorder.copyBuffer(source, 0, target, 0, 64);
  finish(*device, recorder);
  EXPECT_EQ(must(readBackArray<uint32_t>(*device, target, 16))[15], 225u);
}

TEST_P(BufferTest, MoreThanTheStagingBufferHoldsIsCopiedInParts) {
  const size_t count = (size_t(33) << 20) / 4 + 3;
  const auto values = countUp(count, 1);
  const Buffer buffer = must(createBufferWith<uint32_t>(*device, storageDesc(0, "large"), values));
  EXPECT_EQ(buffer.size(), count * 4);
  EXPECT_TRUE(must(readBackArray<uint32_t>(*device, buffer, count)) == values);
}

TEST_P(BufferTest, MemoryIsCountedByOwnerAndGoesBackToTheBaseline) {
  ASSERT_EQ(device->memory().totalBytes(), 0u);
  {
    BufferDesc desc = storageDesc(1 << 20, "points");
    desc.owner = "cache";
    const Buffer points = must(Buffer::create(*device, desc));
    desc.owner = "film";
    Buffer mean = must(Buffer::create(*device, desc));
    const Buffer other = must(Buffer::create(*device, desc));
    EXPECT_GE(device->memory().ofOwner("cache"), size_t(1) << 20);
    EXPECT_GE(device->memory().ofOwner("film"), size_t(2) << 20);
    EXPECT_EQ(device->memory().totalBytes(), device->memory().ofOwner("cache") + device->memory().ofOwner("film"));
    EXPECT_EQ(device->memory().allocationCount(), 3u);
    const Buffer moved = std::move(mean);
    EXPECT_EQ(device->memory().allocationCount(), 3u);
    mean = must(Buffer::create(*device, desc));
    EXPECT_EQ(device->memory().allocationCount(), 4u);
  }
  EXPECT_EQ(device->memory().totalBytes(), 0u);
  EXPECT_EQ(device->memory().allocationCount(), 0u);
  EXPECT_TRUE(device->memory().byOwner().empty());
}

class BufferLimits : public testing::Test {
 protected:
  void expectRefused(const BufferDesc& desc, const char* code, const char* word) {
    const auto buffer = Buffer::create(*device, desc);
    ASSERT_FALSE(buffer.ok());
    EXPECT_EQ(buffer.error().code, code);
    EXPECT_NE(buffer.error().message.find(word), std::string::npos) << buffer.error().message;
    EXPECT_NE(buffer.error().message.find(desc.name), std::string::npos) << buffer.error().message;
    EXPECT_EQ(device->memory().allocationCount(), 0u);
  }
  ValidatedDevice device;
};

TEST_F(BufferLimits, StorageOverTheRangeIsRefused) {
  expectRefused(storageDesc(device->limits().maxStorageBufferRange + 4, "wide"), "limit", "maxStorageBufferRange");
}

TEST_F(BufferLimits, TexelsOverTheElementLimitAreRefused) {
  BufferDesc desc = storageDesc(device->limits().maxTexelBufferElements + 1, "many", BufferUsage::texel);
  desc.texelFormat = VK_FORMAT_R8_UINT;
  expectRefused(desc, "limit", "maxTexelBufferElements");
}

TEST_F(BufferLimits, MoreThanOneAllocationHoldsIsRefused) {
  const DeviceLimits& limits = device->limits();
  const size_t most = std::min(limits.maxMemoryAllocationSize, limits.maxBufferSize);
  expectRefused(storageDesc(most + 4, "huge", BufferUsage::none), "limit", "the device's max");
  expectRefused(storageDesc(~size_t(0) - 3, "absurd", BufferUsage::none), "limit", "maxBufferSize");
}

TEST_F(BufferLimits, ATexelBufferMayBeLargerThanAStorageRange) {
  // The least range Vulkan promises is 128 MiB; a texel buffer of 144 MiB is refused on none that has the elements.
  BufferDesc desc = storageDesc(size_t(144) << 20, "table", BufferUsage::texel);
  desc.texelFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  const auto buffer = Buffer::create(*device, desc);
  EXPECT_EQ(buffer.ok(), device->limits().maxTexelBufferElements >= desc.size / 16);
}

}  // namespace
}  // namespace limn::vk
