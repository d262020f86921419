#include "renderer/gpu/scene_memory.hpp"

#include "renderer/gpu/environment_table.hpp"
#include "renderer/gpu/geometry.hpp"
#include "renderer/gpu/light_tree.hpp"
#include "renderer/gpu/material_table.hpp"
#include "renderer/scene/scene_needs.hpp"

namespace limn::gpu {
namespace {

constexpr uint64_t kPlaceholder = 4;  // elements of a table that is empty, device_scene.cpp

template <class T>
uint64_t tableBytes(uint64_t count) {
  return (count > 0 ? count : kPlaceholder) * sizeof(T);
}

bool shines(const glm::vec3& v) { return v.x > 0.0f || v.y > 0.0f || v.z > 0.0f; }

bool isEmitter(const Scene& scene, const BlockSize& block) {
  if (block.material == kNone) return false;
  const Material& material = scene.materials[size_t(block.material)];
  return !material.unlit && shines(material.emission);
}

/// Entries of the light table, and of its tree.
struct LightCounts {
  uint64_t placed = 0;    ///< points, spots, emissive triangles
  uint64_t infinite = 0;  ///< directional lights and the environment
  uint64_t all() const { return placed + infinite; }
  uint64_t nodes() const { return placed > kFewLights ? lightTreeNodes(placed) : 0; }
};
LightCounts lightCounts(const Scene& scene, std::span<const BlockSize> blocks) {
  LightCounts counts;
  counts.infinite = shines(scene.environment.radiance) ? 1 : 0;
  for (const Node& node : scene.nodes) {
    if (node.light == kNone) continue;
    const Light& light = scene.lights[size_t(node.light)];
    if (!(light.intensity > 0.0f && shines(light.color))) continue;
    ++(light.type == LightType::directional ? counts.infinite : counts.placed);
  }
  for (const BlockSize& block : blocks)
    if (isEmitter(scene, block)) counts.placed += block.solidTriangles;
  return counts;
}

uint64_t texelCount(const Scene& scene) {
  const std::vector<bool> sampled = sampledImages(scene);
  uint64_t texels = 0;
  for (size_t i = 0; i < scene.images.size(); ++i)
    if (sampled[i]) texels += scene.images[i].rgba8.size() / 4;
  return texels;
}

void addEnvironment(vk::MemoryUse& device, const Scene& scene) {
  uint64_t texels = 0, cells = 0;
  if (scene.environment.image) {
    const Image& image = *scene.environment.image;
    const glm::uvec2 table = environmentCells(image);
    texels = uint64_t(image.width) * image.height;
    cells = uint64_t(table.x) * table.y;
  }
  device.add("environment", tableBytes<glm::vec4>(texels) + tableBytes<glm::uvec4>(cells));
}

}  // namespace

void addSceneMemory(MemoryPrediction& memory, const Scene& scene, std::span<const BlockSize> blocks) {
  uint64_t triangles = 0, vertices = 0;
  for (const BlockSize& block : blocks) triangles += block.triangles, vertices += block.vertices;
  const MaterialTable materials = buildMaterialTable(scene);
  const LightCounts lights = lightCounts(scene, blocks);

  memory.device.add("scene", tableBytes<glm::uvec4>(triangles) + tableBytes<glm::vec4>(vertices) +
                                 tableBytes<PackedVertex>(vertices) + sizeof(shared::SceneInfo) +
                                 tableBytes<shared::MaterialData>(materials.materials.size()) +
                                 tableBytes<shared::TextureSlot>(materials.slots.size()));
  memory.device.add("textures", tableBytes<shared::ImageInfo>(scene.images.size()) +
                                    tableBytes<uint32_t>(texelCount(scene)));
  memory.device.add("lights", tableBytes<shared::LightData>(lights.all()) +
                                  tableBytes<shared::LightNode>(lights.nodes()) + tableBytes<uint32_t>(triangles));
  addEnvironment(memory.device, scene);

  // Corners, indices and positions of every block, and what is known of the lights.
  memory.host.add("mirror", blocks.size() * sizeof(GeometryBlock) + (4 * triangles + vertices) * sizeof(glm::vec3) +
                                lights.all() * sizeof(shared::LightData) + lights.nodes() * sizeof(shared::LightNode) +
                                triangles * sizeof(uint32_t));
}

}  // namespace limn::gpu
