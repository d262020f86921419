#include "renderer/session/session_memory.hpp"

#include "renderer/techniques/technique_info.hpp"
#include "renderer/techniques/technique_memory.hpp"
#include "renderer/visibility/bvh_memory.hpp"
#include "shaders/shared/g_buffer_shared.h"
#include "shaders/shared/scene_shared.h"

namespace limn {

gpu::MemoryPrediction predictMemory(const Scene& scene, const SessionConfig& config) {
  const std::string& technique = config.technique.empty() ? techniqueInfos().front().name : config.technique;
  const PictureSettings settings{config.width, config.height, technique, config.parameters, config.allNeeds};
  const std::vector<BlockSize> blocks = blockSizes(scene);
  gpu::MemoryPrediction memory;
  gpu::addSceneMemory(memory, scene, blocks);
  addBvhMemory(memory, blocks);
  addFilmMemory(memory.device, config.width, config.height);
  addTechniqueMemory(memory.device, scene, blocks, settings);
  memory.device.add("session", sizeof(shared::CameraData) + sizeof(shared::GBufferTexel));
  memory.host.add("scene", hostBytes(scene));
  return memory;
}

}  // namespace limn
