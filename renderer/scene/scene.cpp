#include "renderer/scene/scene.hpp"

#include <algorithm>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "renderer/base/check.hpp"
#include "renderer/scene/node_order.hpp"

namespace limn {
namespace {

/// Above this many vertex transforms a mesh is bounded by the corners of its own box, which is looser but never too
/// small.
constexpr uint64_t kMaxExactBoundsWork = 20'000'000;

struct LocalBox {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  void add(const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
  bool empty() const { return !(low.x <= high.x); }
};

uint64_t indexCount(const Mesh& mesh) {
  uint64_t count = 0;
  for (const Primitive& primitive : mesh.primitives) count += primitive.indices.size();
  return count;
}

void addVertices(LocalBox& box, const Mesh& mesh, const glm::dmat4& worldFromLocal) {
  for (const Primitive& primitive : mesh.primitives) {
    for (const uint32_t index : primitive.indices) {
      box.add(glm::dvec3(worldFromLocal * glm::dvec4(primitive.positions[index], 1.0)));
    }
  }
}

void addCorners(LocalBox& box, const LocalBox& local, const glm::dmat4& worldFromLocal) {
  if (local.empty()) return;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p{corner & 1 ? local.high.x : local.low.x, corner & 2 ? local.high.y : local.low.y,
                       corner & 4 ? local.high.z : local.low.z};
    box.add(glm::dvec3(worldFromLocal * glm::dvec4(p, 1.0)));
  }
}

/// The up direction nearest to `wanted` that is perpendicular to the unit vector `axis`.
glm::dvec3 perpendicularUp(const glm::dvec3& axis, const glm::dvec3& wanted) {
  const glm::dvec3 up = wanted - axis * glm::dot(axis, wanted);
  if (glm::length(up) > 1e-9) return glm::normalize(up);
  const glm::dvec3 other = std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  return glm::normalize(other - axis * glm::dot(axis, other));
}

}  // namespace

glm::dmat4 Transform::toMatrix() const {
  if (matrix) return *matrix;
  glm::dmat4 m = glm::mat4_cast(rotation);
  m[0] *= scale.x;
  m[1] *= scale.y;
  m[2] *= scale.z;
  m[3] = glm::dvec4(translation, 1.0);
  return m;
}

std::vector<uint32_t> parentsFirst(const std::vector<Node>& nodes) {
  std::vector<uint32_t> order;
  order.reserve(nodes.size());
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent == kNone) order.push_back(i);
  }
  for (size_t at = 0; at < order.size(); ++at) {
    const std::vector<uint32_t>& children = nodes[order[at]].children;
    order.insert(order.end(), children.begin(), children.end());
  }
  LIMN_CHECK_EQ(order.size(), nodes.size());
  return order;
}

std::vector<glm::dmat4> Scene::worldFromNodes() const {
  std::vector<glm::dmat4> world(nodes.size(), glm::dmat4(1.0));
  for (const uint32_t i : parentsFirst(nodes)) {
    const glm::dmat4 local = nodes[i].parentFromLocal.toMatrix();
    world[i] = nodes[i].parent == kNone ? local : world[size_t(nodes[i].parent)] * local;
  }
  return world;
}

std::optional<View> Scene::viewOfCamera(uint32_t index) const {
  if (index >= cameras.size()) return std::nullopt;
  const auto carrier =
      std::find_if(nodes.begin(), nodes.end(), [&](const Node& n) { return n.camera == int32_t(index); });
  if (carrier == nodes.end()) return std::nullopt;

  const glm::dmat4 world = worldFromNodes()[size_t(carrier - nodes.begin())];
  const Bounds bounds = worldBounds(*this);
  const double backLength = glm::length(glm::dvec3(world[2]));
  const glm::dvec3 axis = backLength > 0.0 ? glm::dvec3(world[2]) / -backLength : glm::dvec3(0, 0, -1);
  const glm::dvec3 eye(world[3]);
  const double reach = glm::length(bounds.center() - eye);
  View result;
  result.eye = eye;
  result.target = eye + axis * (reach > 1e-3 * bounds.radius() ? reach : std::max(bounds.radius(), 1e-6));
  result.up = perpendicularUp(axis, glm::dvec3(world[1]));
  result.lens = cameras[index];
  return result;
}

Bounds worldBounds(const Scene& scene) {
  std::vector<uint64_t> uses(scene.meshes.size(), 0);
  for (const Node& node : scene.nodes) {
    if (node.mesh != kNone) ++uses[size_t(node.mesh)];
  }
  std::vector<LocalBox> local(scene.meshes.size());
  std::vector<bool> exact(scene.meshes.size(), true);
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    exact[m] = uses[m] * indexCount(scene.meshes[m]) <= kMaxExactBoundsWork;
    if (!exact[m]) addVertices(local[m], scene.meshes[m], glm::dmat4(1.0));
  }

  const std::vector<glm::dmat4> world = scene.worldFromNodes();
  LocalBox box;
  for (size_t n = 0; n < scene.nodes.size(); ++n) {
    const int32_t mesh = scene.nodes[n].mesh;
    if (mesh == kNone) continue;
    if (exact[size_t(mesh)]) addVertices(box, scene.meshes[size_t(mesh)], world[n]);
    else addCorners(box, local[size_t(mesh)], world[n]);
  }
  if (box.empty()) return {glm::dvec3(-0.5), glm::dvec3(0.5)};
  return {box.low, box.high};
}

Bounds worldBounds(const Mesh& mesh, const glm::dmat4& worldFromNode) {
  LocalBox box;
  addVertices(box, mesh, worldFromNode);
  if (box.empty()) return {glm::dvec3(worldFromNode[3]), glm::dvec3(worldFromNode[3])};
  return {box.low, box.high};
}

View framingView(const Bounds& bounds, const Camera& lens) {
  const double radius = std::max(bounds.radius(), 1e-9 * (1.0 + glm::length(bounds.center())));
  // A little from the right and above, at the distance where the bounding sphere fits the smaller field of view.
  const glm::dvec3 fromCenter = glm::normalize(glm::dvec3(0.35, 0.3, 1.0));
  const double halfAngle = std::clamp(double(lens.yfov) * 0.5, 0.05, 1.4);
  const double distance = lens.perspective ? radius / std::sin(halfAngle) : 2.0 * radius;
  View view;
  view.target = bounds.center();
  view.eye = view.target + fromCenter * distance;
  view.up = perpendicularUp(-fromCenter, glm::dvec3(0, 1, 0));
  view.lens = lens;
  view.lens.ymag = float(radius);
  view.lens.znear = float(std::min(double(lens.znear), distance * 1e-3));
  return view;
}

}  // namespace limn
