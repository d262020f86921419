#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <vector>

#include "tests/gpu/vk/vk_fixture.hpp"

namespace limn::test {

using vk::must;

/// The one device of a test program, under the validation layer; whoever keeps objects of it says how they are dropped.
/// The program fails if the layer said anything, the device's own end included.
class SharedDevice : public testing::Environment {
 public:
  static vk::Device& get() {
    if (!s_device) s_device = std::make_unique<vk::ValidatedDevice>();
    return **s_device;
  }
  static void atEnd(std::function<void()> drop) { s_drops.push_back(std::move(drop)); }

  void TearDown() override {
    for (const auto& drop : s_drops) drop();
    s_drops.clear();
    s_device.reset();
  }

 private:
  static inline std::unique_ptr<vk::ValidatedDevice> s_device;
  static inline std::vector<std::function<void()>> s_drops;
};

inline testing::Environment* const kSharedDevice = testing::AddGlobalTestEnvironment(new SharedDevice);

}  // namespace limn::test
