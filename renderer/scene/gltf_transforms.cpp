#include <algorithm>
#include <cmath>

#include "renderer/scene/gltf_accessors.hpp"
#include "renderer/scene/gltf_nodes.hpp"

namespace limn::gltf {
namespace {

/// Three perpendicular unit vectors near the columns; columns without length or direction are made up.
glm::dmat3 orthonormal(const glm::dmat3& m) {
  const auto unitOr = [](const glm::dvec3& v, const glm::dvec3& other) {
    const double length = glm::length(v);
    return length > 1e-150 ? v / length : other;
  };
  const glm::dvec3 x = unitOr(m[0], glm::dvec3(1, 0, 0));
  const glm::dvec3 aside = std::abs(x.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 fallback = glm::normalize(aside - x * glm::dot(x, aside));
  const glm::dvec3 rest = m[1] - x * glm::dot(x, m[1]);
  const glm::dvec3 y = glm::length(rest) > 1e-9 * glm::length(m[1]) ? unitOr(rest, fallback) : fallback;
  return {x, y, glm::cross(x, y)};
}

double largest(const glm::dmat3& m) {
  double v = 0.0;
  for (int c = 0; c < 3; ++c) v = std::max({v, std::abs(m[c].x), std::abs(m[c].y), std::abs(m[c].z)});
  return v;
}

struct InstanceData {
  std::vector<float> translation, rotation, scale;
  size_t count = 0;
};

InstanceData readInstances(const Document& document, const Value& attributes) {
  InstanceData data;
  const auto read = [&](const char* name, uint32_t components, const char* type) -> std::vector<float> {
    const int32_t index = attributes.indexOr(name, document.model.accessors.size(), "accessor");
    if (index < 0) return {};
    const Value accessor = document.root().list("accessors")[size_t(index)];
    if (accessor.need("type").asString() != type)
      attributes.need(name).fail("bad-file", std::string(name) + " must be of type " + type);
    const uint64_t count = countOf(document, index);
    if (data.count != 0 && data.count != count)
      attributes.need(name).fail("bad-file", "instance attributes differ in their counts");
    if (count > document.limits.maxNodes)
      attributes.need(name).fail("limit", "there are more instances than nodes are allowed");
    data.count = count;
    std::vector<float> values = readFloats(document, index, components);
    const bool finite = std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
    if (!finite) attributes.need(name).fail("bad-file", std::string(name) + " holds a value that is not finite");
    return values;
  };
  data.translation = read("TRANSLATION", 3, "VEC3");
  data.rotation = read("ROTATION", 4, "VEC4");
  data.scale = read("SCALE", 3, "VEC3");
  return data;
}

}  // namespace

Transform transformFromMatrix(const glm::dmat4& matrix) {
  const glm::dmat3 m(matrix);
  glm::dmat3 axes = orthonormal(m);
  Transform t;
  t.translation = glm::dvec3(matrix[3]);
  t.scale = {glm::dot(axes[0], m[0]), glm::dot(axes[1], m[1]),
             glm::dot(axes[2], m[2])};  // the last is negative when mirrored
  t.rotation = glm::normalize(glm::quat_cast(axes));
  const glm::dmat3 difference = glm::dmat3(t.toMatrix()) - m;
  if (largest(difference) > 1e-5 * largest(m)) t.matrix = matrix;
  return t;
}

std::vector<Transform> instancesOf(const Document& document, const Value& node) {
  const auto extension = node.extension("EXT_mesh_gpu_instancing");
  if (!extension || !node.has("mesh")) return {};
  const InstanceData data = readInstances(document, extension->need("attributes").object());
  std::vector<Transform> instances(data.count);
  for (size_t i = 0; i < data.count; ++i) {
    Transform& t = instances[i];
    if (!data.translation.empty())
      t.translation = {data.translation[3 * i], data.translation[3 * i + 1], data.translation[3 * i + 2]};
    if (!data.scale.empty()) t.scale = {data.scale[3 * i], data.scale[3 * i + 1], data.scale[3 * i + 2]};
    if (data.rotation.empty()) continue;
    const float* q = &data.rotation[4 * i];
    const glm::dquat rotation{double(q[3]), double(q[0]), double(q[1]), double(q[2])};
    if (glm::length(rotation) > 1e-6) t.rotation = glm::normalize(rotation);
  }
  return instances;
}

}  // namespace limn::gltf
