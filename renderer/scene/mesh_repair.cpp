#include "renderer/scene/mesh_repair.hpp"

#include <cmath>
#include <numeric>

namespace limn {
namespace {

glm::dvec3 crossOf(const Primitive& p, size_t triangle) {
  const glm::dvec3 a(p.positions[p.indices[triangle]]), b(p.positions[p.indices[triangle + 1]]),
      c(p.positions[p.indices[triangle + 2]]);
  return glm::cross(b - a, c - a);
}

bool degenerate(const Primitive& p, size_t triangle) {
  const uint32_t i = p.indices[triangle], j = p.indices[triangle + 1], k = p.indices[triangle + 2];
  if (i == j || j == k || k == i) return true;
  const glm::dvec3 a(p.positions[i]), b(p.positions[j]), c(p.positions[k]);
  // The sine of the corner. Differences of floats and their products are exact in double up to about 1e-16.
  constexpr double kSmallestSine = 1e-14;
  return glm::length(glm::cross(b - a, c - a)) <= kSmallestSine * glm::length(b - a) * glm::length(c - a);
}

bool usable(const glm::vec3& v) {
  const float length2 = glm::dot(v, v);
  return std::isfinite(length2) && length2 > 1e-24f;
}

template <class T>
void gather(std::vector<T>& data, const std::vector<uint32_t>& source) {
  if (data.empty()) return;
  std::vector<T> out(source.size());
  for (size_t i = 0; i < source.size(); ++i) out[i] = data[source[i]];
  data = std::move(out);
}

}  // namespace

glm::vec3 anyPerpendicular(const glm::vec3& n) {
  const glm::vec3 other = std::abs(n.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  return glm::normalize(other - n * glm::dot(n, other));
}

void gatherVertices(Primitive& primitive, const std::vector<uint32_t>& source) {
  gather(primitive.positions, source);
  gather(primitive.restPositions, source);
  gather(primitive.normals, source);
  gather(primitive.tangents, source);
  gather(primitive.uv0, source);
  gather(primitive.uv1, source);
  gather(primitive.colors, source);
}

uint64_t dropDegenerateTriangles(Primitive& primitive) {
  size_t kept = 0;
  for (size_t t = 0; t + 3 <= primitive.indices.size(); t += 3) {
    if (degenerate(primitive, t)) continue;
    for (size_t c = 0; c < 3; ++c) primitive.indices[kept + c] = primitive.indices[t + c];
    kept += 3;
  }
  const uint64_t dropped = (primitive.indices.size() - kept) / 3;
  primitive.indices.resize(kept);
  return dropped;
}

void unshareWithFlatNormals(Primitive& primitive) {
  gatherVertices(primitive, primitive.indices);
  std::iota(primitive.indices.begin(), primitive.indices.end(), 0u);
  primitive.positions.resize(primitive.indices.size());
  primitive.normals.resize(primitive.indices.size());
  for (size_t t = 0; t < primitive.indices.size(); t += 3) {
    const glm::vec3 normal(glm::normalize(crossOf(primitive, t)));
    for (size_t c = 0; c < 3; ++c) primitive.normals[t + c] = normal;
  }
}

NormalRepair repairNormals(Primitive& primitive) {
  NormalRepair repair;
  std::vector<bool> broken(primitive.normals.size(), false);
  for (size_t i = 0; i < primitive.normals.size(); ++i) {
    glm::vec3& n = primitive.normals[i];
    if (!usable(n)) {
      broken[i] = true;
      ++repair.replaced;
      continue;
    }
    const float length = glm::length(n);
    repair.rescaled += std::abs(length - 1.0f) > 0.01f;
    if (std::abs(length - 1.0f) > 1e-6f) n /= length;
  }
  if (repair.replaced == 0) return repair;

  std::vector<glm::dvec3> sums(primitive.normals.size(), glm::dvec3(0.0));
  for (size_t t = 0; t < primitive.indices.size(); t += 3) {
    const glm::dvec3 cross = crossOf(primitive, t);
    for (size_t c = 0; c < 3; ++c) sums[primitive.indices[t + c]] += cross;
  }
  for (size_t i = 0; i < broken.size(); ++i) {
    if (!broken[i]) continue;
    const double length = glm::length(sums[i]);
    primitive.normals[i] = length > 0.0 ? glm::vec3(sums[i] / length) : glm::vec3(0, 0, 1);
  }
  return repair;
}

uint64_t repairTangents(Primitive& primitive) {
  uint64_t replaced = 0;
  for (size_t i = 0; i < primitive.tangents.size(); ++i) {
    glm::vec4& t = primitive.tangents[i];
    const glm::vec3 direction(t);
    const bool good = usable(direction);
    replaced += !good;
    t = glm::vec4(good ? glm::normalize(direction) : anyPerpendicular(primitive.normals[i]), t.w < 0.0f ? -1.0f : 1.0f);
  }
  return replaced;
}

}  // namespace limn
