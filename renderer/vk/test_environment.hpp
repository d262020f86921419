#pragma once
#include <cstdint>
#include <optional>

namespace limn::vk {

/// What a test asks of the programs that it starts, through their environment. Nothing else sets these variables.
struct TestEnvironment {
  bool validation = false;               ///< LIMN_VALIDATION=1: the layer is on; its first message ends the process, exit 1
  std::optional<uint64_t> loseDeviceAt;  ///< LIMN_LOSE_DEVICE_AT=N: submission N, from 1, finds the device lost
};

TestEnvironment testEnvironment();

}  // namespace limn::vk
