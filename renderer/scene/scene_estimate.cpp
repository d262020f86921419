#include "renderer/scene/scene_estimate.hpp"

namespace limn {
namespace {

template <class T>
uint64_t bytesOf(const std::vector<T>& data) {
  return data.size() * sizeof(T);
}

uint64_t bytesOf(const Primitive& p) {
  return sizeof p + bytesOf(p.positions) + bytesOf(p.restPositions) + bytesOf(p.normals) + bytesOf(p.tangents) +
         bytesOf(p.uv0) + bytesOf(p.uv1) + bytesOf(p.colors) + bytesOf(p.indices);
}

bool hasArea(const Primitive& p, size_t triangle) {
  const glm::dvec3 a(p.positions[p.indices[3 * triangle]]);
  const glm::dvec3 ab = glm::dvec3(p.positions[p.indices[3 * triangle + 1]]) - a;
  const glm::dvec3 ac = glm::dvec3(p.positions[p.indices[3 * triangle + 2]]) - a;
  return glm::cross(ab, ac) != glm::dvec3(0.0);
}

BlockSize sizeOf(const Primitive& p) {
  BlockSize size{p.material, p.indices.size() / 3, p.positions.size(), 0};
  for (size_t t = 0; t < size.triangles; ++t) size.solidTriangles += hasArea(p, t);
  return size;
}

}  // namespace

std::vector<BlockSize> blockSizes(const Scene& scene) {
  std::vector<std::vector<BlockSize>> ofMesh(scene.meshes.size());
  for (size_t m = 0; m < scene.meshes.size(); ++m)
    for (const Primitive& p : scene.meshes[m].primitives)
      if (!p.indices.empty()) ofMesh[m].push_back(sizeOf(p));
  std::vector<BlockSize> blocks;
  for (const Node& node : scene.nodes) {
    if (node.mesh == kNone) continue;
    const std::vector<BlockSize>& shown = ofMesh[size_t(node.mesh)];
    blocks.insert(blocks.end(), shown.begin(), shown.end());
  }
  return blocks;
}

uint64_t instancedTriangles(const Scene& scene) {
  uint64_t triangles = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh == kNone) continue;
    for (const Primitive& p : scene.meshes[size_t(node.mesh)].primitives) triangles += p.indices.size() / 3;
  }
  return triangles;
}

uint64_t hostBytes(const Scene& scene) {
  uint64_t bytes = bytesOf(scene.materials) + bytesOf(scene.nodes) + bytesOf(scene.lights) + bytesOf(scene.cameras);
  for (const Mesh& mesh : scene.meshes)
    for (const Primitive& primitive : mesh.primitives) bytes += bytesOf(primitive);
  for (const Image& image : scene.images) bytes += bytesOf(image.rgba8) + bytesOf(image.rgbaF);
  if (scene.environment.image) bytes += bytesOf(scene.environment.image->rgbaF);
  return bytes;
}

}  // namespace limn
