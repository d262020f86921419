#include "renderer/session/warm_up_scene.hpp"

#include <numeric>
#include <set>

namespace limn {
namespace {

constexpr uint32_t kSide = 16;  ///< [pixel]

Primitive pointOf(int32_t material) {
  Primitive p;
  p.material = material;
  p.positions.assign(3, glm::vec3(0.0f));
  p.normals.assign(3, {0.0f, 0.0f, 1.0f});
  p.indices = {0, 1, 2};
  return p;
}

std::set<int32_t> materialsInUse(const Scene& scene) {
  std::set<int32_t> used;
  for (const Node& node : scene.nodes) {
    if (node.mesh == kNone) continue;
    for (const Primitive& p : scene.meshes[size_t(node.mesh)].primitives)
      if (!p.indices.empty()) used.insert(p.material);
  }
  return used;
}

Scene standIn(const Scene& scene) {
  Image white;
  white.width = white.height = 1;
  white.rgba8.assign(4, 255);
  Scene small;
  small.images.assign(scene.images.size(), white);
  small.materials = scene.materials;
  Mesh& mesh = small.meshes.emplace_back();
  for (const int32_t material : materialsInUse(scene)) mesh.primitives.push_back(pointOf(material));
  small.nodes.emplace_back().mesh = 0;
  small.roots = {0};
  return small;
}

}  // namespace

Result<std::unique_ptr<WarmUpScene>> WarmUpScene::create(vk::Device& device, const Scene& scene) {
  auto made = std::make_unique<WarmUpScene>(device);
  made->description = standIn(scene);
  made->needs = sceneNeeds(scene);
  ChangeSet all;
  all.everything = true;
  if (auto synced = made->mirror.sync(made->description, all); !synced) return synced.error();
  std::vector<TriangleBlock> blocks;
  for (size_t i = 0; i < made->mirror.blocks().size(); ++i) {
    const gpu::GeometryBlock& block = made->mirror.blocks()[i];
    blocks.push_back({block.corners, block.firstTriangle, made->mirror.blockNeedsAlpha(i)});
  }
  std::vector<uint32_t> changed(blocks.size());
  std::iota(changed.begin(), changed.end(), 0u);
  if (auto done = made->tracer.update(device, blocks, changed); !done) return done.error();
  auto film = Film::create(device, kSide, kSide);
  if (!film) return film.error();
  made->film = film.take();
  return made;
}

}  // namespace limn
