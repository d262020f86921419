#pragma once
#include <string>
#include <utility>

#include "renderer/gpu/scene_memory.hpp"

namespace limn {

/// What the memory of a picture depends on.
struct PictureSettings {
  uint32_t width = 0, height = 0;  ///< [pixel]
  std::string technique;
  std::vector<std::pair<std::string, double>> parameters;  ///< other than the defaults
  bool allNeeds = false;           ///< as TechniqueContext's
};

/// Adds what the film and its statistics will hold on the device, owner "film".
void addFilmMemory(vk::MemoryUse& device, uint32_t width, uint32_t height);

/// Adds what the technique will hold on the device, under its parts' owners. Every technique of the registry is known.
void addTechniqueMemory(vk::MemoryUse& device, const Scene& scene, std::span<const BlockSize> blocks,
                        const PictureSettings& settings);

}  // namespace limn
