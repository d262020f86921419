#include "renderer/gpu/geometry.hpp"

#include <cmath>

namespace limn::gpu {

std::vector<GeometryBlock> listBlocks(const Scene& scene) {
  std::vector<GeometryBlock> blocks;
  uint32_t triangle = 0, vertex = 0;
  for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
    if (scene.nodes[node].mesh == kNone) continue;
    const uint32_t mesh = uint32_t(scene.nodes[node].mesh);
    const std::vector<Primitive>& primitives = scene.meshes[mesh].primitives;
    for (uint32_t primitive = 0; primitive < primitives.size(); ++primitive) {
      const Primitive& p = primitives[primitive];
      if (p.indices.empty()) continue;
      GeometryBlock& block = blocks.emplace_back();
      block.node = node;
      block.mesh = mesh;
      block.primitive = primitive;
      block.material = uint32_t(p.material + 1);
      block.firstTriangle = triangle;
      block.firstVertex = vertex;
      triangle += uint32_t(p.indices.size() / 3);
      vertex += uint32_t(p.positions.size());
    }
  }
  return blocks;
}

namespace {

glm::vec3 directionOr(const glm::dvec3& v, const glm::vec3& fallback) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
}

/// Columns of the cofactor matrix: the inverse transpose without its division, so that flattened nodes keep normals.
glm::dmat3 normalMatrix(const glm::dmat3& m) {
  const double sign = glm::determinant(m) < 0.0 ? -1.0 : 1.0;
  return sign * glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
}

PackedVertex packVertex(const Primitive& p, size_t i, const glm::dmat3& linear, const glm::dmat3& normals) {
  PackedVertex v;
  v.normal = octEncode(directionOr(normals * glm::dvec3(p.normals[i]), {0.0f, 0.0f, 1.0f}));
  if (!p.tangents.empty())
    v.tangent = packTangent(directionOr(linear * glm::dvec3(p.tangents[i]), {1.0f, 0.0f, 0.0f}),
                            glm::determinant(linear) < 0.0 ? -p.tangents[i].w : p.tangents[i].w);
  else
    v.tangent = packTangent({1.0f, 0.0f, 0.0f}, 1.0f);
  if (!p.uv0.empty()) v.u0 = p.uv0[i].x, v.v0 = p.uv0[i].y;
  if (!p.uv1.empty()) v.u1 = p.uv1[i].x, v.v1 = p.uv1[i].y;
  const glm::vec4 color = p.colors.empty() ? glm::vec4(1.0f) : p.colors[i];
  v.colorRg = glm::packHalf2x16({color.r, color.g});
  v.colorBa = glm::packHalf2x16({color.b, color.a});
  return v;
}

}  // namespace

void placeBlock(const Scene& scene, const glm::dmat4& worldFromNode, const glm::dvec3& renderOrigin, GeometryBlock& block) {
  const Primitive& p = scene.meshes[block.mesh].primitives[block.primitive];
  const glm::dmat3 linear(worldFromNode);
  const glm::dmat3 normals = normalMatrix(linear);
  const glm::dvec3 translation = glm::dvec3(worldFromNode[3]) - renderOrigin;
  const bool mirrored = glm::determinant(linear) < 0.0;

  const size_t vertexCount = p.positions.size(), triangleCount = p.indices.size() / 3;
  block.positions.resize(vertexCount);
  block.vertices.resize(vertexCount);
  for (size_t i = 0; i < vertexCount; ++i) {
    block.positions[i] = glm::vec3(linear * glm::dvec3(p.positions[i]) + translation);
    block.vertices[i] = packVertex(p, i, linear, normals);
  }
  block.triangles.resize(triangleCount);
  block.corners.resize(triangleCount * 3);
  for (size_t t = 0; t < triangleCount; ++t) {
    glm::uvec3 corner(p.indices[3 * t], p.indices[3 * t + 1], p.indices[3 * t + 2]);
    if (mirrored) std::swap(corner.y, corner.z);
    for (int k = 0; k < 3; ++k) block.corners[3 * t + size_t(k)] = block.positions[corner[k]];
    block.triangles[t] = corner + block.firstVertex;
  }
}

glm::dvec3 renderOriginOf(const Bounds& bounds) {
  const double radius = bounds.radius();
  if (!(radius > 0.0)) return glm::dvec3(0.0);
  const double cell = 4.0 * std::exp2(std::ceil(std::log2(radius)));
  return glm::round(bounds.center() / cell) * cell;
}

}  // namespace limn::gpu
