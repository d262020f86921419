#include "renderer/scene/scene_estimate.hpp"

namespace limn {
namespace {

// Bytes a flattened triangle: indices, hierarchy triangle (three texels), about one hierarchy node, light index.
constexpr uint64_t kDeviceTriangle = 16 + 48 + 48 + 4;
constexpr uint64_t kDeviceVertex = 16 + 32;              // position, packed attributes
constexpr uint64_t kMirrorTriangle = 36 + 12 + 48 + 48;  // corners, indices, the hierarchy's copy and node
constexpr uint64_t kMirrorVertex = 12 + 32;

template <class T>
uint64_t bytesOf(const std::vector<T>& data) {
  return data.size() * sizeof(T);
}

uint64_t bytesOf(const Primitive& p) {
  return sizeof p + bytesOf(p.positions) + bytesOf(p.restPositions) + bytesOf(p.normals) + bytesOf(p.tangents) +
         bytesOf(p.uv0) + bytesOf(p.uv1) + bytesOf(p.colors) + bytesOf(p.indices);
}

}  // namespace

SceneEstimate estimateScene(const Scene& scene) {
  SceneEstimate estimate;
  estimate.sceneBytes = bytesOf(scene.materials) + bytesOf(scene.nodes) + bytesOf(scene.lights);
  for (const Mesh& mesh : scene.meshes) {
    for (const Primitive& primitive : mesh.primitives) estimate.sceneBytes += bytesOf(primitive);
  }
  uint64_t texelBytes = 0;
  for (const Image& image : scene.images) texelBytes += bytesOf(image.rgba8) + bytesOf(image.rgbaF);
  for (const Node& node : scene.nodes) {
    if (node.mesh == kNone) continue;
    for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives) {
      estimate.instancedTriangles += primitive.indices.size() / 3;
      estimate.instancedVertices += primitive.positions.size();
    }
  }
  const uint64_t triangles = estimate.instancedTriangles, vertices = estimate.instancedVertices;
  estimate.sceneBytes += texelBytes;
  estimate.mirrorBytes = triangles * kMirrorTriangle + vertices * kMirrorVertex;
  estimate.deviceBytes = triangles * kDeviceTriangle + vertices * kDeviceVertex + texelBytes;
  return estimate;
}

}  // namespace limn
