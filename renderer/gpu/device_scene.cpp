#include "renderer/gpu/device_scene.hpp"

#include <algorithm>

#include "renderer/gpu/environment_table.hpp"
#include "renderer/gpu/material_table.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"

namespace limn::gpu {
namespace {

/// What a table holds, for the statistics of memory.
constexpr const char *kScene = "scene", *kTextures = "textures", *kLights = "lights", *kEnvironment = "environment";

vk::BufferDesc describe(const char* owner, const char* name, VkFormat texelFormat = VK_FORMAT_UNDEFINED) {
  vk::BufferDesc desc;
  desc.name = std::string("scene.") + name;
  desc.owner = owner;
  desc.texelFormat = texelFormat;
  desc.usage = texelFormat == VK_FORMAT_UNDEFINED ? vk::BufferUsage::storage : vk::BufferUsage::texel;
  return desc;
}

/// Replaces `buffer` by one that holds `values`; an empty array becomes one zero element, for a binding must exist.
template <class T>
Result<void> replace(vk::Device& device, vk::Buffer& buffer, const vk::BufferDesc& desc, const std::vector<T>& values) {
  static const std::vector<T> kPlaceholder(4);
  const std::vector<T>& held = values.empty() ? kPlaceholder : values;
  if (buffer && buffer.size() == held.size() * sizeof(T)) return vk::uploadArray(device, buffer, std::span<const T>(held));
  buffer = {};
  auto made = vk::createBufferWith(device, desc, std::span<const T>(held));
  if (!made) return made.error();
  buffer = made.take();
  return {};
}

std::vector<uint32_t> blocksOfNodes(const std::vector<GeometryBlock>& blocks, const std::vector<uint32_t>& nodes) {
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < blocks.size(); ++i)
    if (std::binary_search(nodes.begin(), nodes.end(), blocks[i].node)) found.push_back(i);
  return found;
}

}  // namespace

bool DeviceScene::anyAlpha() const {
  return std::any_of(m_blockAlpha.begin(), m_blockAlpha.end(), [](uint8_t a) { return a != 0; });
}

uint64_t DeviceScene::hostBytes() const {
  uint64_t bytes = m_lightTable.lights.size() * sizeof(shared::LightData) + m_lightTable.lightOfTriangle.size() * 4 +
                   m_lightTable.tree.size() * sizeof(shared::LightNode);
  for (const GeometryBlock& block : m_blocks)
    bytes += sizeof block + (block.corners.size() + block.positions.size() + block.triangles.size()) * sizeof(glm::vec3);
  return bytes;
}

bool DeviceScene::updateOrigin(const Scene& scene) {
  const Bounds bounds = worldBounds(scene);
  m_radius = std::max(bounds.radius(), 1e-30);
  const glm::dvec3 origin = renderOriginOf(bounds);
  const bool moved = origin != m_renderOrigin;
  m_renderOrigin = origin;
  return moved;
}

Result<SyncReport> DeviceScene::sync(const Scene& scene, const ChangeSet& changes) {
  SyncReport report;
  bool originMoved = false;
  if (changes.everything || !changes.nodes.empty()) originMoved = updateOrigin(scene);
  if (changes.everything || originMoved) {
    report.reloaded = report.lightsChanged = true;
    if (auto done = reload(scene); !done) return done.error();
    return report;
  }
  if (!changes.nodes.empty()) {
    report.movedBlocks = blocksOfNodes(m_blocks, changes.nodes);
    if (auto done = moveBlocks(scene, report.movedBlocks); !done) return done.error();
  }
  if (!changes.materials.empty()) {
    const std::vector<uint8_t> before = m_blockAlpha;
    if (auto done = writeMaterials(scene); !done) return done.error();
    for (uint32_t i = 0; i < before.size(); ++i)
      if (before[i] != m_blockAlpha[i]) report.alphaBlocks.push_back(i);
  }
  if (changes.environmentImage)
    if (auto done = writeEnvironment(scene); !done) return done.error();
  report.lightsChanged = !changes.lights.empty() || !changes.emissive.empty() || !changes.nodes.empty() || changes.environment;
  if (report.lightsChanged)
    if (auto done = writeLights(scene); !done) return done.error();
  return report;
}

Result<void> DeviceScene::reload(const Scene& scene) {
  m_blocks = listBlocks(scene);
  const std::vector<glm::dmat4> worlds = scene.worldFromNodes();
  std::vector<glm::uvec4> triangles;
  std::vector<glm::vec4> positions;
  std::vector<PackedVertex> vertices;
  for (GeometryBlock& block : m_blocks) {
    placeBlock(scene, worlds[block.node], m_renderOrigin, block);
    for (const glm::uvec3& t : block.triangles) triangles.push_back({t, block.material});
    for (const glm::vec3& p : block.positions) positions.push_back({p, 0.0f});
    vertices.insert(vertices.end(), block.vertices.begin(), block.vertices.end());
    block.vertices = {};
  }
  m_triangleCount = triangles.size();
  constexpr VkFormat kWords = VK_FORMAT_R32G32B32A32_UINT, kFloats = VK_FORMAT_R32G32B32A32_SFLOAT;
  if (auto r = replace(m_device, m_triangles, describe(kScene, "triangles", kWords), triangles); !r) return r;
  if (auto r = replace(m_device, m_positions, describe(kScene, "positions", kFloats), positions); !r) return r;
  if (auto r = replace(m_device, m_vertices, describe(kScene, "vertices", kWords), vertices); !r) return r;
  const TexelHeap heap = buildTexelHeap(scene);
  if (auto r = replace(m_device, m_images, describe(kTextures, "images"), heap.images); !r) return r;
  if (auto r = replace(m_device, m_texels, describe(kTextures, "texels", VK_FORMAT_R32_UINT), heap.texels); !r) return r;
  if (auto r = writeMaterials(scene); !r) return r;
  if (auto r = writeEnvironment(scene); !r) return r;
  return writeLights(scene);
}

Result<void> DeviceScene::moveBlocks(const Scene& scene, const std::vector<uint32_t>& moved) {
  const std::vector<glm::dmat4> worlds = scene.worldFromNodes();
  for (const uint32_t index : moved) {
    GeometryBlock& block = m_blocks[index];
    placeBlock(scene, worlds[block.node], m_renderOrigin, block);
    std::vector<glm::uvec4> triangles;
    for (const glm::uvec3& t : block.triangles) triangles.push_back({t, block.material});
    std::vector<glm::vec4> positions;
    for (const glm::vec3& p : block.positions) positions.push_back({p, 0.0f});
    const auto put = [&]<class T>(vk::Buffer& buffer, const std::vector<T>& values, size_t first) {
      return vk::uploadArray(m_device, buffer, std::span<const T>(values), first * sizeof(T));
    };
    if (auto r = put(m_triangles, triangles, block.firstTriangle); !r) return r;
    if (auto r = put(m_positions, positions, block.firstVertex); !r) return r;
    if (auto r = put(m_vertices, block.vertices, block.firstVertex); !r) return r;
    block.vertices = {};
  }
  return {};
}

Result<void> DeviceScene::writeMaterials(const Scene& scene) {
  m_blockAlpha.assign(m_blocks.size(), 0);
  for (size_t i = 0; i < m_blocks.size(); ++i)
    m_blockAlpha[i] = m_blocks[i].material > 0 && needsAlphaTest(scene.materials[m_blocks[i].material - 1]);
  const MaterialTable table = buildMaterialTable(scene);
  if (auto r = replace(m_device, m_textureSlots, describe(kScene, "textureSlots"), table.slots); !r) return r;
  return replace(m_device, m_materials, describe(kScene, "materials"), table.materials);
}

Result<void> DeviceScene::writeEnvironment(const Scene& scene) {
  const EnvironmentTable table = buildEnvironmentTable(scene);
  m_info.distributionWidth = table.width;
  m_info.distributionHeight = table.height;
  m_info.environmentWidth = m_info.environmentHeight = 0;
  std::vector<glm::vec4> texels;
  if (scene.environment.image) {
    const Image& image = *scene.environment.image;
    m_info.environmentWidth = image.width;
    m_info.environmentHeight = image.height;
    texels.resize(size_t(image.width) * image.height);
    for (size_t i = 0; i < texels.size(); ++i)
      texels[i] = {image.rgbaF[4 * i], image.rgbaF[4 * i + 1], image.rgbaF[4 * i + 2], 1.0f};
  }
  const auto ofTexels = describe(kEnvironment, "environment", VK_FORMAT_R32G32B32A32_SFLOAT);
  if (auto r = replace(m_device, m_environment, ofTexels, texels); !r) return r;
  const auto ofEntries = describe(kEnvironment, "environmentTable", VK_FORMAT_R32G32B32A32_UINT);
  return replace(m_device, m_environmentTable, ofEntries, table.entries);
}

Result<void> DeviceScene::checkEnvironment(const Image& image) const {
  vk::BufferDesc desc = describe(kEnvironment, "environment", VK_FORMAT_R32G32B32A32_SFLOAT);
  desc.size = size_t(image.width) * image.height * sizeof(glm::vec4);
  const auto room = vk::Buffer::create(m_device, desc);
  return room ? Result<void>() : Result<void>(room.error());
}

Result<void> DeviceScene::writeLights(const Scene& scene) {
  m_lightTable = buildLightTable(scene, m_blocks, m_renderOrigin, m_radius);
  m_info.lightCount = uint32_t(m_lightTable.lights.size());
  m_info.environmentLight = m_lightTable.environmentLight;
  m_info.environmentRadiance = scene.environment.radiance;
  m_info.environmentRotation = scene.environment.rotation;
  m_info.sceneRadius = float(m_radius);
  m_info.triangleCount = uint32_t(m_triangleCount);
  m_info.lightTreeShare = m_lightTable.treeShare;
  if (auto r = replace(m_device, m_lights, describe(kLights, "lights"), m_lightTable.lights); !r) return r;
  const auto ofTree = describe(kLights, "lightTree", VK_FORMAT_R32G32B32A32_UINT);
  if (auto r = replace(m_device, m_lightTree, ofTree, m_lightTable.tree); !r) return r;
  const auto ofTriangles = describe(kLights, "triangleLights", VK_FORMAT_R32_UINT);
  if (auto r = replace(m_device, m_triangleLights, ofTriangles, m_lightTable.lightOfTriangle); !r) return r;
  return replace(m_device, m_sceneInfo, describe(kScene, "info"), std::vector<shared::SceneInfo>{m_info});
}

std::vector<vk::Binding> DeviceScene::bindings() const {
  return {vk::texel(BINDING_TRIANGLES, m_triangles),
          vk::texel(BINDING_POSITIONS, m_positions),
          vk::texel(BINDING_VERTICES, m_vertices),
          vk::texel(BINDING_TRIANGLE_LIGHTS, m_triangleLights),
          vk::texel(BINDING_LIGHT_TREE, m_lightTree),
          vk::storage(BINDING_MATERIALS, m_materials),
          vk::storage(BINDING_LIGHTS, m_lights),
          vk::storage(BINDING_IMAGES, m_images),
          vk::texel(BINDING_TEXELS, m_texels),
          vk::texel(BINDING_ENVIRONMENT, m_environment),
          vk::texel(BINDING_ENVIRONMENT_TABLE, m_environmentTable),
          vk::storage(BINDING_SCENE_INFO, m_sceneInfo),
          vk::storage(BINDING_TEXTURE_SLOTS, m_textureSlots)};
}

}  // namespace limn::gpu
