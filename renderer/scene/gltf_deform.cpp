#include <glm/gtc/matrix_inverse.hpp>

#include "renderer/scene/gltf_accessors.hpp"
#include "renderer/scene/gltf_meshes.hpp"

namespace limn::gltf {
namespace {

/// values += weight * the target's attribute, if the target has it.
template <class Vec>
void addTarget(const Document& document, const std::map<std::string, int>& target, const char* name, double weight,
               std::vector<Vec>& values) {
  const auto found = target.find(name);
  if (found == target.end() || values.empty()) return;
  const std::vector<float> deltas = readFloats(document, found->second, 3);
  for (size_t i = 0; i < values.size(); ++i) {
    for (int c = 0; c < 3; ++c) values[i][c] += float(weight * double(deltas[i * 3 + size_t(c)]));
  }
}

void morph(Document& document, const tinygltf::Primitive& source, const std::vector<double>& weights,
           const std::string& pointer, Primitive& vertices) {
  for (size_t t = 0; t < source.targets.size() && t < weights.size(); ++t) {
    if (weights[t] == 0.0) continue;
    document.spend(vertices.positions.size(), pointer + "/targets");
    addTarget(document, source.targets[t], "POSITION", weights[t], vertices.positions);
    addTarget(document, source.targets[t], "NORMAL", weights[t], vertices.normals);
    addTarget(document, source.targets[t], "TANGENT", weights[t], vertices.tangents);
  }
}

/// The vertex's own matrix: the weighted mean of its joints'. Weights are taken relative to their sum.
glm::dmat4 blend(const Attributes& attributes, const std::vector<glm::dmat4>& joints, size_t vertex,
                 const std::string& pointer) {
  glm::dmat4 sum(0.0);
  double total = 0.0;
  for (size_t set = 0; set < attributes.joints.size(); ++set) {
    for (size_t c = 0; c < 4; ++c) {
      const double weight = double(attributes.weights[set][vertex * 4 + c]);
      if (!(weight > 0.0) || !std::isfinite(weight)) continue;
      const uint32_t joint = attributes.joints[set][vertex * 4 + c];
      if (joint >= joints.size()) {
        fail("out-of-range",
             "vertex " + std::to_string(vertex) + " hangs on joint " + std::to_string(joint) + " of " +
                 std::to_string(joints.size()),
             pointer + "/attributes/JOINTS_" + std::to_string(set));
      }
      sum += joints[joint] * weight;
      total += weight;
    }
  }
  return total > 0.0 ? sum * (1.0 / total) : glm::dmat4(1.0);
}

void skin(const std::vector<glm::dmat4>& joints, const std::string& pointer, Attributes& attributes) {
  Primitive& v = attributes.vertices;
  for (size_t i = 0; i < v.positions.size(); ++i) {
    const glm::dmat4 m = blend(attributes, joints, i, pointer);
    v.positions[i] = glm::vec3(m * glm::dvec4(glm::dvec3(v.positions[i]), 1.0));
    // The cofactor matrix turns normals as the inverse transpose does, and also works when the matrix has no inverse.
    const glm::dmat3 a(m);
    const glm::dmat3 cofactor(glm::cross(a[1], a[2]), glm::cross(a[2], a[0]), glm::cross(a[0], a[1]));
    if (!v.normals.empty()) {
      const glm::dvec3 n = cofactor * glm::dvec3(v.normals[i]);
      const double length = glm::length(n);
      v.normals[i] = length > 0.0 ? glm::vec3(n / length) : glm::vec3(0.0f);
    }
    if (!v.tangents.empty()) v.tangents[i] = glm::vec4(glm::vec3(a * glm::dvec3(v.tangents[i])), v.tangents[i].w);
  }
}

}  // namespace

void deform(Document& document, const tinygltf::Primitive& source, const Deformation& deformation,
            const std::string& pointer, Attributes& attributes) {
  const bool skinned = !deformation.localFromBind.empty() && !attributes.joints.empty();
  const bool morphed = !deformation.morphWeights.empty() && !source.targets.empty();
  if (skinned || morphed) attributes.vertices.restPositions = attributes.vertices.positions;
  if (morphed) morph(document, source, deformation.morphWeights, pointer, attributes.vertices);
  if (skinned) skin(deformation.localFromBind, pointer, attributes);
}

}  // namespace limn::gltf
