#pragma once
#include <span>

#include "renderer/scene/scene_estimate.hpp"
#include "renderer/vk/memory_use.hpp"

namespace limn::gpu {

/// Predicted memory, by the owners that a device's own account names. Each buffer's rounding is left aside, which is
/// under a kilobyte.
struct MemoryPrediction {
  vk::MemoryUse device, host;
};

/// Adds what DeviceScene will hold of a scene: owners "scene", "textures", "lights" and "environment" on the device,
/// "mirror" on the host. `blocks` are the scene's own.
void addSceneMemory(MemoryPrediction& memory, const Scene& scene, std::span<const BlockSize> blocks);

}  // namespace limn::gpu
