#include "renderer/scene/gltf_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/scene/gltf_accessors.hpp"
#include "renderer/scene/mesh_repair.hpp"

namespace limn::gltf {
namespace {

constexpr float kFarthest = 1e15f;  ///< [m]; squares and products of three stay inside float's range only below
constexpr const char* kModeNames[] = {"POINTS",    "LINES",          "LINE_LOOP",   "LINE_STRIP",
                                      "TRIANGLES", "TRIANGLE_STRIP", "TRIANGLE_FAN"};

std::string materialLabel(const Scene& scene, int material) {
  if (material < 0) return "";
  const std::string& name = scene.materials[size_t(material)].name;
  return name.empty() ? "#" + std::to_string(material) : name;
}

uint64_t trianglesIn(int mode, uint64_t corners) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return corners / 3;
  return corners < 3 ? 0 : corners - 2;
}

/// Counts the primitive towards the limits before anything of it is read.
void spend(Document& document, const tinygltf::Primitive& source, const std::string& pointer) {
  LoadReport& report = document.reporter.report();
  const uint64_t vertices = countOf(document, source.attributes.at("POSITION"));
  const uint64_t corners = source.indices >= 0 ? countOf(document, source.indices) : vertices;
  const uint64_t triangles = trianglesIn(source.mode, corners);
  const bool flat = !source.attributes.contains("NORMAL");
  report.triangles += triangles;
  report.vertices += flat ? std::max(vertices, triangles * 3) : vertices;
  if (report.triangles > document.limits.maxTriangles) {
    fail("limit", "more than " + std::to_string(document.limits.maxTriangles) + " triangles", pointer);
  }
  if (report.vertices > document.limits.maxVertices) {
    fail("limit", "more than " + std::to_string(document.limits.maxVertices) + " vertices", pointer);
  }
}

std::vector<uint32_t> readIndices(const Document& document, const tinygltf::Primitive& source, uint64_t vertices,
                                  const std::string& pointer) {
  if (source.indices < 0) {
    std::vector<uint32_t> all(vertices);
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }
  std::vector<uint32_t> indices = readUnsigned(document, source.indices, 1);
  for (size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] < vertices) continue;
    const std::string what = "index " + std::to_string(i) + " is " + std::to_string(indices[i]);
    fail("out-of-range", what + ", there are " + std::to_string(vertices) + " vertices", pointer + "/indices");
  }
  return indices;
}

/// Strips and fans as single triangles that keep the winding.
std::vector<uint32_t> asTriangles(int mode, std::vector<uint32_t> corners) {
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    corners.resize(corners.size() / 3 * 3);
    return corners;
  }
  std::vector<uint32_t> out;
  out.reserve(trianglesIn(mode, corners.size()) * 3);
  for (size_t i = 0; i + 2 < corners.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) out.insert(out.end(), {corners[i + 1], corners[i + 2], corners[0]});
    else out.insert(out.end(), {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
  }
  return out;
}

template <class Vec>
std::vector<Vec> grouped(const std::vector<float>& flat) {
  std::vector<Vec> out(flat.size() / size_t(Vec::length()));
  for (size_t i = 0; i < flat.size(); ++i) out[i / size_t(Vec::length())][int(i % size_t(Vec::length()))] = flat[i];
  return out;
}

/// NaN and infinity become 0; gives their number.
uint64_t clean(std::vector<float>& values) {
  uint64_t broken = 0;
  for (float& v : values) {
    if (std::isfinite(v)) continue;
    v = 0.0f;
    ++broken;
  }
  return broken;
}

std::vector<glm::vec3> readPositions(const Document& document, int accessor) {
  const std::vector<float> flat = readFloats(document, accessor, 3);
  for (size_t i = 0; i < flat.size(); ++i) {
    if (std::abs(flat[i]) <= kFarthest) continue;
    const char* what = std::isfinite(flat[i]) ? " is farther than 1e15 from the origin" : " is not finite";
    fail(std::isfinite(flat[i]) ? "out-of-range" : "bad-file", "the position of vertex " + std::to_string(i / 3) + what,
         pointerOf("accessors", accessor));
  }
  return grouped<glm::vec3>(flat);
}

/// How many values were outside 0 to 1. [glTF 2.0 §3.9.2]
uint64_t clampToUnit(std::vector<float>& values) {
  uint64_t outside = 0;
  for (float& value : values) {
    const float inside = std::clamp(value, 0.0f, 1.0f);
    outside += value != inside;
    value = inside;
  }
  return outside;
}

std::vector<glm::vec4> readColors(Document& document, int accessor) {
  const bool alpha = document.model.accessors[size_t(accessor)].type == TINYGLTF_TYPE_VEC4;
  std::vector<float> flat = readFloats(document, accessor, alpha ? 4 : 3, Integers::normalized);
  document.reporter.count("vertex colour components that were not finite became 0", clean(flat));
  document.reporter.count("vertex colour components outside 0 to 1 were cut off there", clampToUnit(flat));
  if (alpha) return grouped<glm::vec4>(flat);
  std::vector<glm::vec4> colors;
  for (const glm::vec3& rgb : grouped<glm::vec3>(flat)) colors.emplace_back(rgb, 1.0f);
  return colors;
}

std::vector<glm::vec2> readUvs(Document& document, int accessor) {
  // KHR_mesh_quantization allows unnormalised integers, plain glTF does not.
  std::vector<float> flat = readFloats(document, accessor, 2);
  document.reporter.count("texture coordinates that were not finite became 0", clean(flat));
  return grouped<glm::vec2>(flat);
}

Attributes readAttributes(Document& document, const Scene& scene, const tinygltf::Primitive& source) {
  Attributes out;
  for (const auto& [name, accessor] : source.attributes) {
    if (name == "POSITION") out.vertices.positions = readPositions(document, accessor);
    else if (name == "NORMAL") out.vertices.normals = grouped<glm::vec3>(readFloats(document, accessor, 3));
    else if (name == "TANGENT") out.vertices.tangents = grouped<glm::vec4>(readFloats(document, accessor, 4));
    else if (name == "TEXCOORD_0") out.vertices.uv0 = readUvs(document, accessor);
    else if (name == "TEXCOORD_1") out.vertices.uv1 = readUvs(document, accessor);
    else if (name == "COLOR_0") out.vertices.colors = readColors(document, accessor);
    else if (name.starts_with("COLOR_"))
      document.reporter.unsupported(name, "only the first vertex colour is used",
                                    materialLabel(scene, source.material));
  }
  for (int set = 0;; ++set) {
    const auto joints = source.attributes.find("JOINTS_" + std::to_string(set));
    const auto weights = source.attributes.find("WEIGHTS_" + std::to_string(set));
    if (joints == source.attributes.end() || weights == source.attributes.end()) break;
    out.joints.push_back(readUnsigned(document, joints->second, 4));
    out.weights.push_back(readFloats(document, weights->second, 4, Integers::normalized));
  }
  return out;
}

/// The texture coordinates that the material's normal maps use, or null when it has no normal map.
const TextureRef* normalMap(const Scene& scene, int material) {
  if (material < 0) return nullptr;
  const Material& m = scene.materials[size_t(material)];
  if (m.normalTexture.present()) return &m.normalTexture;
  return m.clearcoatNormalTexture.present() ? &m.clearcoatNormalTexture : nullptr;
}

void finishNormals(Document& document, Primitive& primitive) {
  if (primitive.normals.empty()) {
    primitive.tangents.clear();
    unshareWithFlatNormals(primitive);
    document.reporter.count("primitives without normals got flat ones", 1);
    return;
  }
  const NormalRepair repair = repairNormals(primitive);
  document.reporter.count("zero or broken normals were replaced", repair.replaced);
  document.reporter.count("normals were not of unit length and were normalised", repair.rescaled);
}

void finishTangents(Document& document, const Scene& scene, Primitive& primitive) {
  const TextureRef* const map = normalMap(scene, primitive.material);
  if (!map) {
    primitive.tangents.clear();
    return;
  }
  if (!primitive.tangents.empty()) {
    document.reporter.count("zero or broken tangents were replaced", repairTangents(primitive));
    return;
  }
  std::vector<glm::vec2> uv = map->texCoord == 0 ? primitive.uv0 : primitive.uv1;
  if (uv.empty()) {
    document.reporter.count("primitives have a normal map but no texture coordinates for it", 1);
    uv.resize(primitive.positions.size());
  }
  generateTangents(primitive, std::move(uv));
  document.reporter.count("primitives with a normal map but without tangents got generated ones", 1);
}

Primitive readPrimitive(Document& document, const Scene& scene, const tinygltf::Primitive& source,
                        const Deformation& deformation, const std::string& pointer) {
  spend(document, source, pointer);
  Attributes attributes = readAttributes(document, scene, source);
  deform(document, source, deformation, pointer, attributes);
  for (const glm::vec3& p : attributes.vertices.positions) {
    if (glm::length(p) <= 2.0f * kFarthest) continue;
    fail("out-of-range", "morphing and skinning move a vertex out of the range of numbers", pointer);
  }
  Primitive primitive = std::move(attributes.vertices);
  primitive.material = source.material;
  primitive.indices = asTriangles(source.mode, readIndices(document, source, primitive.positions.size(), pointer));

  LoadReport& report = document.reporter.report();
  const uint64_t dropped = dropDegenerateTriangles(primitive);
  report.degenerateTriangles += dropped;
  finishNormals(document, primitive);
  finishTangents(document, scene, primitive);
  return primitive;
}

}  // namespace

Mesh readMesh(Document& document, const Scene& scene, uint32_t index, const Deformation& deformation) {
  const tinygltf::Mesh& source = document.model.meshes[index];
  Mesh mesh;
  mesh.name = source.name;
  for (size_t i = 0; i < source.primitives.size(); ++i) {
    const tinygltf::Primitive& primitive = source.primitives[i];
    const std::string label = materialLabel(scene, primitive.material);
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
      document.reporter.unsupported(std::string("primitive mode ") + kModeNames[primitive.mode],
                                    "points and lines are left out", label);
    } else if (!primitive.attributes.contains("POSITION")) {
      document.reporter.count("primitives without positions were left out", 1);
    } else {
      Primitive read =
          readPrimitive(document, scene, primitive, deformation, pointerOf("meshes", index, "primitives", i));
      if (!read.indices.empty()) mesh.primitives.push_back(std::move(read));
    }
  }
  return mesh;
}

}  // namespace limn::gltf
