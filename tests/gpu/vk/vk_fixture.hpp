#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "renderer/vk/command_recorder.hpp"
#include "renderer/vk/device.hpp"
#include "renderer/vk/instance.hpp"
#include "renderer/vk/transfer.hpp"

namespace limn::vk {

/// The value, or a failed test that shows the error.
template <class T>
T must(Result<T> result) {
  if (!result) {
    ADD_FAILURE() << result.error().code << ": " << result.error().text();
    std::abort();
  }
  return result.take();
}
inline void must(Result<void> result) {
  ASSERT_TRUE(result.ok()) << result.error().code << ": " << result.error().text();
}

/// A directory that is empty at first and gone afterwards.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "limn_vk_XXXXXX").string();
    m_path = mkdtemp(pattern.data());
  }
  ~TemporaryDirectory() { std::filesystem::remove_all(m_path); }
  const std::string& path() const { return m_path; }

 private:
  std::string m_path;
};

/// A device under the validation layer; the test fails if the layer said anything, the device's own end included.
class ValidatedDevice {
 public:
  explicit ValidatedDevice(DeviceOptions options = {}) {
    options.validation = true;
    m_device = must(Device::open(options));
    m_log = m_device->validationLog();
  }
  ~ValidatedDevice() {
    m_device.reset();
    std::string texts;
    for (const std::string& text : m_log->texts()) texts += "\n" + text;
    EXPECT_EQ(m_log->count(), 0u) << texts;
  }
  Device& operator*() const { return *m_device; }
  Device* operator->() const { return m_device.get(); }

 private:
  std::unique_ptr<Device> m_device;
  std::shared_ptr<const ValidationLog> m_log;
};

/// The ways through the layer that differ between devices; each test that matters runs on all.
struct DevicePath {
  const char* name;
  bool assumeDiscrete;
  bool pushDescriptors;
};

inline void PrintTo(const DevicePath& path, std::ostream* out) { *out << path.name; }

inline const std::vector<DevicePath> kDevicePaths{
    {"AsItIs", false, true}, {"Discrete", true, true}, {"DescriptorPools", true, false}};

class OnEveryPath : public testing::TestWithParam<DevicePath> {
 protected:
  static DeviceOptions options() {
    DeviceOptions options;
    options.assumeDiscrete = GetParam().assumeDiscrete;
    options.pushDescriptors = GetParam().pushDescriptors;
    return options;
  }
  ValidatedDevice device{options()};
};

inline std::string pathName(const testing::TestParamInfo<DevicePath>& info) { return info.param.name; }

inline BufferDesc storageDesc(size_t size, const std::string& name, BufferUsage usage = BufferUsage::storage) {
  BufferDesc desc;
  desc.size = size;
  desc.usage = usage;
  desc.name = name;
  desc.owner = "test";
  return desc;
}

/// Ends, submits, waits.
inline void finish(Device& device, CommandRecorder& recorder) { must(submitAndWait(device, recorder)); }

}  // namespace limn::vk
