// What the environment of a program that a test starts can ask of it: server/README.md, "For tests".
#include "renderer/vk/test_environment.hpp"

#include "tests/gpu/vk/vk_fixture.hpp"
#include "tests/support/environment_variable.hpp"

namespace limn::vk {
namespace {

TEST(TestEnvironment, NothingIsAskedWithoutTheVariables) {
  EXPECT_FALSE(testEnvironment().validation);
  EXPECT_FALSE(testEnvironment().loseDeviceAt);
}

/// Ends the process, if the layer has anything to say of a buffer of no bytes.
[[noreturn]] void makeAMistake() {
  const test::EnvironmentVariable variable("LIMN_VALIDATION", "1");
  const auto device = must(Device::open({}));
  auto info = typed<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  VkBuffer buffer = VK_NULL_HANDLE;
  (void)vkCreateBuffer(device->handle(), &info, nullptr, &buffer);
  std::_Exit(0);
}

TEST(TestEnvironmentDeathTest, UnderValidationTheFirstMessageEndsTheProcessWithExit1) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(makeAMistake(), testing::ExitedWithCode(1), "validation: .*size");
}

TEST(TestEnvironment, TheDeviceIsLostAtTheSubmissionThatWasAskedFor) {
  const test::EnvironmentVariable variable("LIMN_LOSE_DEVICE_AT", "3");
  ValidatedDevice device;
  for (int submission = 1; submission <= 4; ++submission) {
    CommandRecorder recorder(*device);
    recorder.begin();
    const Result<void> done = submitAndWait(*device, recorder);
    EXPECT_EQ(done.ok() ? "" : done.error().code, submission < 3 ? "" : "device-lost") << submission;
    EXPECT_EQ(device->lost(), submission >= 3);
  }
}

}  // namespace
}  // namespace limn::vk
