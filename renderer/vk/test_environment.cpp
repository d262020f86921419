#include "renderer/vk/test_environment.hpp"

#include <charconv>
#include <cstdlib>
#include <string_view>

namespace limn::vk {

TestEnvironment testEnvironment() {
  TestEnvironment asked;
  if (const char* text = std::getenv("LIMN_VALIDATION")) asked.validation = std::string_view(text) == "1";
  if (const char* text = std::getenv("LIMN_LOSE_DEVICE_AT")) {
    const std::string_view digits = text;
    uint64_t number = 0;
    if (std::from_chars(digits.begin(), digits.end(), number).ec == std::errc()) asked.loseDeviceAt = number;
  }
  return asked;
}

}  // namespace limn::vk
