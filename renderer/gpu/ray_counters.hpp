#pragma once
#include <string>

#include "renderer/vk/transfer.hpp"
#include "shaders/shared/film_shared.h"

namespace limn::gpu {

/// What shaders that trace rays count into, all 0 and mapped; film_shared.h names the words. Errors as Buffer::create
/// and fill.
inline Result<vk::Buffer> makeRayCounters(vk::Device& device, const std::string& owner, const std::string& name) {
  vk::BufferDesc desc;
  desc.owner = owner;
  desc.name = name;
  desc.size = shared::kCounterWords * sizeof(uint32_t);
  desc.memory = vk::MemoryKind::readback;
  auto counters = vk::Buffer::create(device, desc);
  if (!counters) return counters.error();
  if (auto cleared = vk::fill(device, *counters, 0, desc.size, 0); !cleared) return cleared.error();
  return counters;
}

inline uint64_t countedRays(const vk::Buffer& counters) {
  const auto words = counters.as<uint32_t>();
  return uint64_t(words[shared::kCounterRays]) | uint64_t(words[shared::kCounterRays + 1]) << 32;
}

/// Samples that were thrown away because they were not finite, or negative.
inline uint64_t countedDiscards(const vk::Buffer& counters) { return counters.as<uint32_t>()[shared::kCounterDiscarded]; }

}  // namespace limn::gpu
