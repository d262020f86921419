#pragma once
#include "renderer/gpu/scene_memory.hpp"

namespace limn {

/// Adds what SceneBvh will hold: owner "visibility" on the device, "bvh" on the host. How many nodes a hierarchy has is
/// known only once it is built; they are about a fifth of its memory. Nothing is said of a device that traces with
/// acceleration structures of its own.
void addBvhMemory(gpu::MemoryPrediction& memory, std::span<const BlockSize> blocks);

}  // namespace limn
