#include "renderer/scene/gltf_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "renderer/scene/gltf_accessors.hpp"
#include "renderer/scene/gltf_meshes.hpp"
#include "renderer/scene/reach.hpp"

namespace limn::gltf {
namespace {

/// The roots of the scene that is shown: the default one, else the first, else every node without a parent.
std::vector<uint32_t> shownRoots(Document& document) {
  const Value root = document.root(), scenes = root.list("scenes"), nodes = root.list("nodes");
  std::vector<uint32_t> roots;
  if (scenes.size() > 0) {
    const int32_t chosen = root.indexOr("scene", scenes.size(), "scene");
    const Value listed = scenes[size_t(std::max(chosen, 0))].list("nodes");
    for (size_t i = 0; i < listed.size(); ++i) roots.push_back(listed[i].asIndex(nodes.size(), "node"));
    return roots;
  }
  std::vector<bool> isChild(nodes.size(), false);
  for (const tinygltf::Node& node : document.model.nodes) {
    for (const int child : node.children) isChild[size_t(child)] = true;
  }
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    if (!isChild[i]) roots.push_back(i);
  }
  if (!roots.empty()) document.reporter.note("the file names no scene: all its nodes are shown");
  return roots;
}

glm::dquat rotationOf(Document& document, const std::vector<double>& r) {
  if (r.empty()) return {1.0, 0.0, 0.0, 0.0};
  const glm::dquat q{r[3], r[0], r[1], r[2]};
  const double length = glm::length(q);
  if (!(length > 1e-6)) {
    document.reporter.count("rotations of zero length were replaced by none", 1);
    return {1.0, 0.0, 0.0, 0.0};
  }
  return std::abs(glm::dot(q, q) - 1.0) < 1e-12 ? q : glm::normalize(q);
}

Transform transformOf(Document& document, const Value& node) {
  if (const std::vector<double> m = node.numbers("matrix", 16); !m.empty()) {
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = m[size_t(i)];
    return transformFromMatrix(matrix);
  }
  Transform t;
  const std::vector<double> translation = node.numbers("translation", 3), scale = node.numbers("scale", 3);
  if (!translation.empty()) t.translation = {translation[0], translation[1], translation[2]};
  if (!scale.empty()) t.scale = {scale[0], scale[1], scale[2]};
  t.rotation = rotationOf(document, node.numbers("rotation", 4));
  return t;
}

/// Volume that the matrix leaves of a cube, relative to its columns: 0 when it flattens.
bool flattens(const glm::dmat4& m) {
  const glm::dmat3 a(m);
  const double size = glm::length(a[0]) * glm::length(a[1]) * glm::length(a[2]);
  return !(std::abs(glm::determinant(a)) > 1e-9 * size) || !(size > 0.0);
}

class NodeReader {
 public:
  NodeReader(Document& document, Scene& scene)
      : m_document(document), m_scene(scene), m_nodes(document.root().list("nodes")) {}

  void read() {
    readAllTransforms();
    const std::vector<uint32_t> order = reachable();
    for (const uint32_t i : order) m_newIndex[i] = uint32_t(m_scene.nodes.size()), m_scene.nodes.emplace_back();
    for (const uint32_t i : order) readNode(i);
    for (const uint32_t root : m_roots) m_scene.roots.push_back(m_newIndex[root]);
    for (const uint32_t i : order) readMeshOf(i);
  }

 private:
  /// Local and world matrices of all nodes of the file, because joints may lie outside the shown scene.
  void readAllTransforms() {
    m_local.resize(m_nodes.size());
    m_parent.assign(m_nodes.size(), -1);
    for (size_t i = 0; i < m_nodes.size(); ++i) {
      m_local[i] = transformOf(m_document, m_nodes[i]);
      for (const int child : m_document.model.nodes[i].children) m_parent[size_t(child)] = int32_t(i);
    }
    m_world.resize(m_nodes.size());
    std::vector<uint32_t> open;
    for (uint32_t i = 0; i < m_nodes.size(); ++i) {
      if (m_parent[i] < 0) open.push_back(i);
    }
    while (!open.empty()) {
      const uint32_t i = open.back();
      open.pop_back();
      m_world[i] = m_parent[i] < 0 ? m_local[i].toMatrix() : m_world[size_t(m_parent[i])] * m_local[i].toMatrix();
      if (!withinReach(m_world[i]))
        m_nodes[i].fail("out-of-range", "the node's place or size in the world is beyond 1e15");
      for (const int child : m_document.model.nodes[i].children) open.push_back(uint32_t(child));
    }
  }

  /// Nodes of the shown scene, in the file's order.
  std::vector<uint32_t> reachable() {
    m_roots = shownRoots(m_document);
    std::vector<uint32_t> order = m_roots;
    for (size_t at = 0; at < order.size(); ++at) {
      const std::vector<int>& children = m_document.model.nodes[order[at]].children;
      order.insert(order.end(), children.begin(), children.end());
    }
    std::sort(order.begin(), order.end());
    return order;
  }

  void readNode(uint32_t i) {
    const tinygltf::Node& source = m_document.model.nodes[i];
    Node& node = m_scene.nodes[m_newIndex[i]];
    node.name = source.name;
    node.parentFromLocal = m_local[i];
    node.parent = m_parent[i] < 0 ? kNone : int32_t(m_newIndex[size_t(m_parent[i])]);
    for (const int child : source.children) node.children.push_back(m_newIndex[size_t(child)]);
    node.camera = source.camera;
    if (const auto light = m_nodes[i].extension("KHR_lights_punctual")) {
      light->need("light");
      node.light = light->indexOr("light", m_scene.lights.size(), "light");
    }
  }

  void readMeshOf(uint32_t i) {
    const tinygltf::Node& source = m_document.model.nodes[i];
    if (source.mesh < 0) return;
    if (flattens(m_world[i])) {
      m_document.reporter.count("nodes whose scale is zero in some direction show no mesh", 1);
      return;
    }
    const std::vector<Transform> instances = instancesOf(m_document, m_nodes[i]);
    const int32_t mesh = meshFor(i, source);
    if (mesh == kNone) return;
    if (instances.empty()) m_scene.nodes[m_newIndex[i]].mesh = mesh;
    else addInstances(m_newIndex[i], mesh, instances, m_nodes[i]);
  }

  void addInstances(uint32_t parent, int32_t mesh, const std::vector<Transform>& instances, const Value& place) {
    if (m_scene.nodes.size() + instances.size() > m_document.limits.maxNodes) {
      place.fail("limit",
                 "with its instances the scene has more than " + std::to_string(m_document.limits.maxNodes) + " nodes");
    }
    const glm::dmat4 world = m_scene.nodes[parent].parentFromLocal.toMatrix();
    for (size_t k = 0; k < instances.size(); ++k) {
      if (flattens(world * instances[k].toMatrix())) continue;
      Node node;
      node.name = m_scene.nodes[parent].name + "[" + std::to_string(k) + "]";
      node.parent = int32_t(parent);
      node.parentFromLocal = instances[k];
      node.mesh = mesh;
      m_scene.nodes[parent].children.push_back(uint32_t(m_scene.nodes.size()));
      m_scene.nodes.push_back(std::move(node));
    }
  }

  /// The node's mesh in the scene, read when it is new: by index and morph weights, or for this node alone when it has
  /// a skin.
  int32_t meshFor(uint32_t i, const tinygltf::Node& source) {
    const uint32_t index = uint32_t(source.mesh);
    Deformation deformation;
    deformation.morphWeights = source.weights.empty() ? m_document.model.meshes[index].weights : source.weights;
    const bool still = std::all_of(deformation.morphWeights.begin(), deformation.morphWeights.end(),
                                   [](double w) { return w == 0.0; });
    if (still) deformation.morphWeights.clear();
    if (source.skin >= 0) {
      deformation.localFromBind = jointMatrices(i, uint32_t(source.skin));
      return store(index, deformation);
    }
    const auto [entry, isNew] = m_meshes.try_emplace({index, deformation.morphWeights}, kNone);
    if (isNew) entry->second = store(index, deformation);
    return entry->second;
  }

  int32_t store(uint32_t index, const Deformation& deformation) {
    Mesh mesh = readMesh(m_document, m_scene, index, deformation);
    if (mesh.primitives.empty()) return kNone;
    m_scene.meshes.push_back(std::move(mesh));
    return int32_t(m_scene.meshes.size()) - 1;
  }

  /// glTF places a skinned mesh by its joints alone; undoing the node's own matrix keeps the mesh on its node.
  std::vector<glm::dmat4> jointMatrices(uint32_t i, uint32_t skinIndex) {
    const tinygltf::Skin& skin = m_document.model.skins[skinIndex];
    m_document.spend(skin.joints.size(), pointerOf("nodes", i, "skin"));
    std::vector<float> inverseBind;
    if (skin.inverseBindMatrices >= 0) inverseBind = readFloats(m_document, skin.inverseBindMatrices, 16);
    const glm::dmat4 localFromWorld = glm::inverse(m_world[i]);
    std::vector<glm::dmat4> matrices;
    for (size_t j = 0; j < skin.joints.size(); ++j) {
      glm::dmat4 bind(1.0);
      for (int k = 0; k < 16 && !inverseBind.empty(); ++k) bind[k / 4][k % 4] = double(inverseBind[j * 16 + size_t(k)]);
      matrices.push_back(localFromWorld * m_world[size_t(skin.joints[j])] * bind);
    }
    return matrices;
  }

  Document& m_document;
  Scene& m_scene;
  const Value m_nodes;
  std::vector<Transform> m_local;           // by node of the file
  std::vector<glm::dmat4> m_world;          // by node of the file
  std::vector<int32_t> m_parent;            // by node of the file
  std::vector<uint32_t> m_roots;            // nodes of the file
  std::map<uint32_t, uint32_t> m_newIndex;  // node of the file -> node of the scene
  std::map<std::pair<uint32_t, std::vector<double>>, int32_t>
      m_meshes;  // not skinned: (mesh, weights) -> mesh of the scene
};

}  // namespace

void readNodes(Document& document, Scene& scene) { NodeReader(document, scene).read(); }

}  // namespace limn::gltf
