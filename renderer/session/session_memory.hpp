#pragma once
#include "renderer/gpu/scene_memory.hpp"
#include "renderer/session/session.hpp"

namespace limn {

/// What a session over the scene will hold, by owner, as Status.memory and Status.hostMemory say it afterwards; within
/// 15 % (tests/techniques/memory_test.cpp) on a device that traces by walking. Needs no device.
gpu::MemoryPrediction predictMemory(const Scene& scene, const SessionConfig& config);

}  // namespace limn
