#include <algorithm>
#include <initializer_list>

#include "renderer/scene/gltf_document.hpp"

namespace limn::gltf {
namespace {

constexpr const char* kLists[] = {"buffers", "bufferViews", "accessors", "meshes",   "nodes",  "skins",     "scenes",
                                  "cameras", "materials",   "textures",  "samplers", "images", "animations"};

void checkVersion(const Value& root) {
  const Value asset = root.need("asset").object();
  const Value version = asset.need("version");
  if (!version.asString().starts_with("2."))
    version.fail("unsupported", "glTF \"" + version.asString() + "\" is not 2.x");
  const std::string least = asset.stringOr("minVersion", "2.0");
  if (least != "2.0") asset.need("minVersion").fail("unsupported", "a loader of glTF " + least + " is asked for");
}

void checkRequiredExtensions(const Value& root) {
  const Value required = root.list("extensionsRequired"), used = root.list("extensionsUsed");
  for (size_t i = 0; i < used.size(); ++i) used[i].asString();
  for (size_t i = 0; i < required.size(); ++i) {
    if (supportsExtension(required[i].asString())) continue;
    required[i].fail("unsupported",
                     "the file cannot be shown without \"" + required[i].asString() + "\", which is not supported");
  }
}

bool oneOf(const std::string& text, std::initializer_list<const char*> allowed) {
  return std::any_of(allowed.begin(), allowed.end(), [&](const char* a) { return text == a; });
}

struct AttributeRule {
  const char* prefix;  ///< of the semantic: "TEXCOORD_" stands for TEXCOORD_0, TEXCOORD_1 ...
  std::initializer_list<const char*> types;
};
const AttributeRule kAttributeRules[] = {{"POSITION", {"VEC3"}},  {"NORMAL", {"VEC3"}},         {"TANGENT", {"VEC4"}},
                                         {"TEXCOORD_", {"VEC2"}}, {"COLOR_", {"VEC3", "VEC4"}}, {"JOINTS_", {"VEC4"}},
                                         {"WEIGHTS_", {"VEC4"}}};

/// One attribute: its accessor exists, has the type of its name and `vertices` elements (0: whatever it has). Gives the
/// count.
uint64_t checkAttribute(const Value& index, const std::string& name, const Value& accessors, uint64_t vertices,
                        bool isTarget) {
  const Value accessor = accessors[index.asIndex(accessors.size(), "accessor")];
  const uint64_t count = accessor.need("count").asUnsigned();
  const std::string& type = accessor.need("type").asString();
  for (const AttributeRule& rule : kAttributeRules) {
    if (!name.starts_with(rule.prefix)) continue;
    const bool good = isTarget && name == "TANGENT" ? type == "VEC3" : oneOf(type, rule.types);
    if (!good) index.fail("bad-file", name + " cannot be of type " + type);
    const uint64_t component = accessor.need("componentType").asUnsigned();
    const bool joints = name.starts_with("JOINTS_");
    if (joints && component != 5121 && component != 5123)
      index.fail("bad-file", "joints must be unsigned bytes or shorts");
    if (!joints && component == 5125) index.fail("bad-file", name + " cannot have components of type unsigned int");
  }
  if (vertices != 0 && count != vertices) {
    index.fail("bad-file",
               name + " has " + std::to_string(count) + " elements, POSITION has " + std::to_string(vertices));
  }
  return count;
}

void checkAttributes(const Value& attributes, const Value& accessors, uint64_t vertices, bool isTarget) {
  for (const auto& [name, unused] : attributes.object().json().items()) {
    checkAttribute(attributes.need(name.c_str()), name, accessors, vertices, isTarget);
  }
}

void checkIndices(const Value& index, const Value& accessors) {
  const Value accessor = accessors[index.asIndex(accessors.size(), "accessor")];
  const uint64_t component = accessor.need("componentType").asUnsigned();
  const bool good =
      accessor.need("type").asString() == "SCALAR" && (component == 5121 || component == 5123 || component == 5125);
  if (!good) index.fail("bad-file", "indices must be unsigned integers");
  if (!accessor.has("bufferView")) index.fail("unsupported", "indices without a bufferView are not supported");
}

void checkPrimitive(const Value& primitive, const Value& root) {
  const Value accessors = root.list("accessors");
  const Value attributes = primitive.need("attributes").object();
  const auto position = attributes.find("POSITION");
  const uint64_t vertices = position ? checkAttribute(*position, "POSITION", accessors, 0, false) : 0;
  checkAttributes(attributes, accessors, vertices, false);
  if (const auto indices = primitive.find("indices")) checkIndices(*indices, accessors);
  primitive.indexOr("material", root.list("materials").size(), "material");
  primitive.unsignedOr("mode", 4, 0, 6);
  const Value targets = primitive.list("targets");
  for (size_t i = 0; i < targets.size(); ++i) checkAttributes(targets[i], accessors, vertices, true);
}

void checkWeights(const Value& owner) {
  if (const auto weights = owner.find("weights")) owner.numbers("weights", weights->array().size());
}

void checkMeshes(const Value& root) {
  const Value meshes = root.list("meshes");
  for (size_t i = 0; i < meshes.size(); ++i) {
    const Value primitives = meshes[i].need("primitives").array(1);
    for (size_t j = 0; j < primitives.size(); ++j) checkPrimitive(primitives[j], root);
    const size_t targets = primitives[0].list("targets").size();
    for (size_t j = 1; j < primitives.size(); ++j) {
      if (primitives[j].list("targets").size() != targets)
        primitives[j].fail("bad-file", "primitives differ in their number of morph targets");
    }
    checkWeights(meshes[i]);
  }
}

void checkSkins(const Value& root) {
  const Value skins = root.list("skins"), accessors = root.list("accessors");
  const size_t nodes = root.list("nodes").size();
  for (size_t i = 0; i < skins.size(); ++i) {
    const Value joints = skins[i].need("joints").array(1);
    for (size_t j = 0; j < joints.size(); ++j) joints[j].asIndex(nodes, "node");
    const auto matrices = skins[i].find("inverseBindMatrices");
    if (!matrices) continue;
    const Value accessor = accessors[matrices->asIndex(accessors.size(), "accessor")];
    const bool good = accessor.need("type").asString() == "MAT4" && accessor.need("componentType").asUnsigned() == 5126;
    if (!good) matrices->fail("bad-file", "inverse bind matrices must be float MAT4");
    if (accessor.need("count").asUnsigned() < joints.size())
      matrices->fail("bad-file", "there are fewer matrices than joints");
  }
}

void checkTransform(const Value& node) {
  const std::vector<double> matrix = node.numbers("matrix", 16);
  node.numbers("translation", 3);
  node.numbers("rotation", 4);
  node.numbers("scale", 3);
  if (matrix.empty()) return;
  if (node.has("translation") || node.has("rotation") || node.has("scale")) {
    node.need("matrix").fail("bad-file", "a node has either a matrix or translation, rotation and scale");
  }
  const bool affine = matrix[3] == 0.0 && matrix[7] == 0.0 && matrix[11] == 0.0 && matrix[15] == 1.0;
  if (!affine) node.need("matrix").fail("bad-file", "the last row must be 0 0 0 1");
}

void checkNode(const Value& node, const Document& document) {
  node.indexOr("mesh", document.count("meshes"), "mesh");
  node.indexOr("camera", document.count("cameras"), "camera");
  if (node.indexOr("skin", document.count("skins"), "skin") >= 0 && !node.has("mesh")) {
    node.need("skin").fail("bad-file", "a node with a skin needs a mesh");
  }
  checkTransform(node);
  checkWeights(node);
}

/// Every node has one parent at most, and following parents ends. Iterative: a chain of a million nodes is fine.
void checkForest(const Value& nodes) {
  std::vector<bool> hasParent(nodes.size(), false), reached(nodes.size(), false);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const Value children = nodes[i].list("children");
    for (size_t k = 0; k < children.size(); ++k) {
      const uint32_t child = children[k].asIndex(nodes.size(), "node");
      if (child == i) children[k].fail("bad-file", "the node is its own child");
      if (hasParent[child]) children[k].fail("bad-file", "node " + std::to_string(child) + " already has a parent");
      hasParent[child] = true;
    }
  }
  std::vector<uint32_t> open;
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    if (!hasParent[i]) open.push_back(i);
  }
  while (!open.empty()) {
    const uint32_t i = open.back();
    open.pop_back();
    reached[i] = true;
    const Value children = nodes[i].list("children");
    for (size_t k = 0; k < children.size(); ++k) open.push_back(children[k].asIndex(nodes.size(), "node"));
  }
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (!reached[i] && nodes[i].has("children"))
      nodes[i].need("children").fail("bad-file", "the node is part of a cycle");
  }
}

void checkScenes(const Value& root) {
  const Value scenes = root.list("scenes"), nodes = root.list("nodes");
  root.indexOr("scene", scenes.size(), "scene");
  std::vector<bool> isChild(nodes.size(), false);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const Value children = nodes[i].list("children");
    for (size_t k = 0; k < children.size(); ++k) isChild[children[k].asIndex(nodes.size(), "node")] = true;
  }
  for (size_t i = 0; i < scenes.size(); ++i) {
    const Value listed = scenes[i].object().list("nodes");
    std::vector<bool> seen(nodes.size(), false);
    for (size_t k = 0; k < listed.size(); ++k) {
      const uint32_t node = listed[k].asIndex(nodes.size(), "node");
      if (isChild[node]) listed[k].fail("bad-file", "the node is another node's child and cannot be a root");
      if (seen[node]) listed[k].fail("bad-file", "the node is listed twice");
      seen[node] = true;
    }
  }
}

}  // namespace

void checkGraph(const Document& document) {
  const Value root = document.root(), nodes = root.list("nodes");
  if (nodes.size() > document.limits.maxNodes) {
    nodes.fail("limit", std::to_string(nodes.size()) + " nodes are more than the limit of " +
                            std::to_string(document.limits.maxNodes));
  }
  checkMeshes(root);
  for (size_t i = 0; i < nodes.size(); ++i) checkNode(nodes[i], document);
  checkSkins(root);
  checkForest(nodes);
  checkScenes(root);
}

void checkStructure(const Document& document) {
  const Value root = document.root().object();
  checkVersion(root);
  checkRequiredExtensions(root);
  for (const char* name : kLists) {
    const Value list = root.list(name);
    for (size_t i = 0; i < list.size(); ++i) list[i].object().stringOr("name", "");
  }
  checkBuffers(document);
  checkGraph(document);
}

}  // namespace limn::gltf
