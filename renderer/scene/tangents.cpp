#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "renderer/base/hash.hpp"
#include "renderer/scene/mesh_repair.hpp"

namespace limn {
namespace {

/// Position, normal, uv and side of a vertex: what makes two vertices one.
using VertexKey = std::array<float, 9>;
struct KeyHash {
  size_t operator()(const VertexKey& key) const { return size_t(fnv1a(key.data(), sizeof key)); }
};

/// The direction on a triangle in which u grows, and whether the texture lies mirrored on it.
struct TriangleFrame {
  glm::dvec3 alongU{0.0};
  bool mirrored = false;
  bool usable = false;
};

TriangleFrame frameOf(const Primitive& p, const std::vector<glm::vec2>& uv, size_t t) {
  const uint32_t i = p.indices[t], j = p.indices[t + 1], k = p.indices[t + 2];
  const glm::dvec3 a(p.positions[i]), e1 = glm::dvec3(p.positions[j]) - a, e2 = glm::dvec3(p.positions[k]) - a;
  const glm::dvec2 d1 = glm::dvec2(uv[j]) - glm::dvec2(uv[i]), d2 = glm::dvec2(uv[k]) - glm::dvec2(uv[i]);
  const double area = d1.x * d2.y - d2.x * d1.y;
  // d(position)/du = (d2.y e1 - d1.y e2) / area; only its direction matters.
  const glm::dvec3 alongU = (e1 * d2.y - e2 * d1.y) * (area < 0.0 ? -1.0 : 1.0);
  const double length = glm::length(alongU);
  const bool usable = area != 0.0 && std::isfinite(length) && length > 0.0;
  return {usable ? alongU / length : glm::dvec3(0.0), area > 0.0, usable};
}

double cornerAngle(const Primitive& p, size_t t, size_t c) {
  const glm::dvec3 at(p.positions[p.indices[t + c]]);
  const glm::dvec3 a = glm::dvec3(p.positions[p.indices[t + (c + 1) % 3]]) - at,
                   b = glm::dvec3(p.positions[p.indices[t + (c + 2) % 3]]) - at;
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Vertices that mirrored and unmirrored triangles share get a twin for the mirrored ones. Gives each vertex's side.
std::vector<bool> splitMirrored(Primitive& p, std::vector<glm::vec2>& uv, const std::vector<TriangleFrame>& frames) {
  constexpr uint32_t kUnseen = ~0u;
  std::vector<uint32_t> source(p.positions.size());
  for (uint32_t i = 0; i < source.size(); ++i) source[i] = i;
  std::vector<int8_t> side(source.size(), -1);
  std::vector<uint32_t> twin(source.size(), kUnseen);
  for (size_t t = 0; t < p.indices.size(); t += 3) {
    if (!frames[t / 3].usable) continue;
    const int8_t mirrored = frames[t / 3].mirrored;
    for (size_t c = 0; c < 3; ++c) {
      uint32_t& index = p.indices[t + c];
      if (side[index] < 0) side[index] = mirrored;
      if (side[index] == mirrored) continue;
      if (twin[index] == kUnseen) {
        twin[index] = uint32_t(source.size());
        source.push_back(index);
        side.push_back(mirrored);
      }
      index = twin[index];
    }
  }
  if (source.size() > uv.size()) {
    gatherVertices(p, source);
    for (size_t i = uv.size(); i < source.size(); ++i) uv.push_back(uv[source[i]]);
  }
  std::vector<bool> mirroredVertex(side.size());
  for (size_t i = 0; i < side.size(); ++i) mirroredVertex[i] = side[i] == 1;
  return mirroredVertex;
}

}  // namespace

void generateTangents(Primitive& primitive, std::vector<glm::vec2> uv) {
  std::vector<TriangleFrame> frames;
  for (size_t t = 0; t < primitive.indices.size(); t += 3) frames.push_back(frameOf(primitive, uv, t));
  primitive.tangents.clear();
  const std::vector<bool> mirrored = splitMirrored(primitive, uv, frames);

  std::unordered_map<VertexKey, uint32_t, KeyHash> groups;
  std::vector<uint32_t> groupOf(primitive.positions.size());
  for (size_t i = 0; i < groupOf.size(); ++i) {
    const glm::vec3 &p = primitive.positions[i], &n = primitive.normals[i];
    VertexKey key{p.x, p.y, p.z, n.x, n.y, n.z, uv[i].x, uv[i].y, mirrored[i] ? 1.0f : 0.0f};
    for (float& v : key) v += 0.0f;  // minus zero becomes zero: keys are compared as numbers and hashed as bytes
    groupOf[i] = groups.try_emplace(key, uint32_t(groups.size())).first->second;
  }

  std::vector<glm::dvec3> sums(groups.size(), glm::dvec3(0.0));
  for (size_t t = 0; t < primitive.indices.size(); t += 3) {
    for (size_t c = 0; c < 3; ++c) {
      const uint32_t vertex = primitive.indices[t + c];
      const glm::dvec3 n(primitive.normals[vertex]),
          along = frames[t / 3].alongU - n * glm::dot(n, frames[t / 3].alongU);
      const double length = glm::length(along);
      if (length > 1e-12) sums[groupOf[vertex]] += along * (cornerAngle(primitive, t, c) / length);
    }
  }
  primitive.tangents.resize(primitive.positions.size());
  for (size_t i = 0; i < groupOf.size(); ++i) {
    const glm::dvec3 sum = sums[groupOf[i]];
    const double length = glm::length(sum);
    const glm::vec3 direction = length > 1e-12 ? glm::vec3(sum / length) : anyPerpendicular(primitive.normals[i]);
    primitive.tangents[i] = glm::vec4(direction, mirrored[i] ? -1.0f : 1.0f);
  }
}

}  // namespace limn
