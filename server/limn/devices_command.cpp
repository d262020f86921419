#include <cstdio>

#include "renderer/vk/device.hpp"
#include "server/limn/commands.hpp"

namespace limn {
namespace {

double deviceLocalGiB(const vk::DeviceInfo& device) {
  uint64_t bytes = 0;
  for (const vk::MemoryHeapInfo& heap : device.heaps)
    if (heap.deviceLocal) bytes += heap.bytes;
  return double(bytes) / double(1ull << 30);
}

Result<void> run(const Arguments&) {
  const Result<std::vector<vk::DeviceInfo>> devices = vk::Device::list();
  if (!devices) return devices.error();
  if (devices->empty()) return Error{"no-device", "this machine has no Vulkan device", ""};
  for (const vk::DeviceInfo& device : *devices) {
    std::printf("%u  %s\n", device.index, device.name.c_str());
    std::printf("   %s; driver %s; Vulkan %s; %.1f GiB of its own memory; ray query: %s\n", device.type.c_str(),
                device.driver.c_str(), device.apiVersion.c_str(), deviceLocalGiB(device),
                device.rayQuery ? "yes" : "no");
    if (!device.refusal.empty()) std::printf("   not usable: %s\n", device.refusal.c_str());
  }
  return {};
}

}  // namespace

Command devicesCommand() {
  return {{"limn devices", "Lists the Vulkan devices of this machine, numbered as limnd --device takes them.", {}, {}},
          run};
}

}  // namespace limn
