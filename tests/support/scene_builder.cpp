#include "tests/support/scene_builder.hpp"

#include <cmath>
#include <numbers>

namespace limn::test {
namespace {

/// A rotation that turns -z into `direction`.
glm::dquat facing(const glm::vec3& direction) {
  const glm::dvec3 d = glm::normalize(glm::dvec3(direction));
  const glm::dvec3 forward(0.0, 0.0, -1.0);
  if (glm::dot(forward, d) < -0.999999) return {0.0, 0.0, 1.0, 0.0};
  const glm::dvec3 axis = glm::cross(forward, d);
  return glm::normalize(glm::dquat(1.0 + glm::dot(forward, d), axis.x, axis.y, axis.z));
}

void addQuad(Primitive& p, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  const uint32_t first = uint32_t(p.positions.size());
  const glm::vec3 n = glm::normalize(glm::cross(b - a, d - a));
  for (const glm::vec3& corner : {a, b, c, d}) {
    p.positions.push_back(corner);
    p.normals.push_back(n);
  }
  for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(first + i);
}

}  // namespace

uint32_t SceneBuilder::material(const Material& m) {
  scene.materials.push_back(m);
  return uint32_t(scene.materials.size() - 1);
}

uint32_t SceneBuilder::diffuse(const glm::vec3& albedo) {
  Material m;
  m.name = "diffuse";
  m.baseColor = glm::vec4(albedo, 1.0f);
  m.metallic = 0.0f;
  m.specular = 0.0f;
  return material(m);
}

uint32_t SceneBuilder::metal(const glm::vec3& color, float roughness) {
  Material m;
  m.name = "metal";
  m.baseColor = glm::vec4(color, 1.0f);
  m.metallic = 1.0f;
  m.roughness = roughness;
  return material(m);
}

uint32_t SceneBuilder::emitter(const glm::vec3& radiance) {
  const uint32_t index = diffuse(glm::vec3(0.0f));
  scene.materials[index].name = "emitter";
  scene.materials[index].emission = radiance;
  return index;
}

uint32_t SceneBuilder::addNode(const std::string& name) {
  Node node;
  node.name = name;
  scene.nodes.push_back(node);
  const uint32_t index = uint32_t(scene.nodes.size() - 1);
  scene.roots.push_back(index);
  return index;
}

uint32_t SceneBuilder::mesh(const Primitive& primitive) {
  scene.meshes.push_back({"mesh", {primitive}});
  const uint32_t node = addNode("object");
  scene.nodes[node].mesh = int32_t(scene.meshes.size() - 1);
  return node;
}

uint32_t SceneBuilder::quad(uint32_t m, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  Primitive p;
  p.material = int32_t(m);
  addQuad(p, a, b, c, d);
  return mesh(p);
}

uint32_t SceneBuilder::box(uint32_t m, glm::vec3 l, glm::vec3 h) {
  Primitive p;
  p.material = int32_t(m);
  addQuad(p, {l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z});
  addQuad(p, {h.x, l.y, l.z}, {l.x, l.y, l.z}, {l.x, h.y, l.z}, {h.x, h.y, l.z});
  addQuad(p, {l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z});
  addQuad(p, {h.x, l.y, h.z}, {h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z});
  addQuad(p, {l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}, {l.x, h.y, l.z});
  addQuad(p, {l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z});
  return mesh(p);
}

uint32_t SceneBuilder::sphere(uint32_t m, glm::vec3 center, float radius, uint32_t segments, bool inwards) {
  Primitive p;
  p.material = int32_t(m);
  const uint32_t columns = 2 * segments;
  for (uint32_t i = 0; i <= segments; ++i)
    for (uint32_t j = 0; j <= columns; ++j) {
      const double theta = std::numbers::pi * i / segments, phi = 2.0 * std::numbers::pi * j / columns;
      const glm::vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
      p.positions.push_back(center + n * radius);
      p.normals.push_back(inwards ? -n : n);
    }
  const auto at = [&](uint32_t i, uint32_t j) { return i * (columns + 1) + j; };
  const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
    for (const uint32_t i : {a, inwards ? c : b, inwards ? b : c}) p.indices.push_back(i);
  };
  for (uint32_t i = 0; i < segments; ++i)
    for (uint32_t j = 0; j < columns; ++j) {
      if (i > 0) triangle(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + 1 < segments) triangle(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
    }
  return mesh(p);
}

uint32_t SceneBuilder::pointLight(glm::vec3 position, glm::vec3 color, float intensity) {
  Light light;
  light.color = color;
  light.intensity = intensity;
  scene.lights.push_back(light);
  const uint32_t node = addNode("point light");
  scene.nodes[node].light = int32_t(scene.lights.size() - 1);
  scene.nodes[node].parentFromLocal.translation = position;
  return node;
}

uint32_t SceneBuilder::directionalLight(glm::vec3 direction, glm::vec3 color, float irradiance) {
  const uint32_t node = pointLight({0.0f, 0.0f, 0.0f}, color, irradiance);
  scene.lights.back().type = LightType::directional;
  scene.nodes[node].parentFromLocal.rotation = facing(direction);
  return node;
}

uint32_t SceneBuilder::spotLight(glm::vec3 position, glm::vec3 direction, float intensity, float inner, float outer) {
  const uint32_t node = pointLight(position, glm::vec3(1.0f), intensity);
  scene.lights.back().type = LightType::spot;
  scene.lights.back().innerConeAngle = inner;
  scene.lights.back().outerConeAngle = outer;
  scene.nodes[node].parentFromLocal.rotation = facing(direction);
  return node;
}

void SceneBuilder::look(glm::dvec3 eye, glm::dvec3 target, float yfov, glm::dvec3 up) {
  scene.view.eye = eye;
  scene.view.target = target;
  scene.view.up = up;
  scene.view.lens.yfov = yfov;
  scene.view.lens.znear = 1e-4f;
}

SceneBuilder cornellLike() {
  SceneBuilder b;
  const uint32_t white = b.diffuse({0.73f, 0.73f, 0.73f}), red = b.diffuse({0.63f, 0.06f, 0.05f}), green = b.diffuse({0.14f, 0.45f, 0.09f});
  const uint32_t light = b.emitter({17.0f, 12.0f, 4.0f});
  b.quad(white, {-1, -1, 1}, {1, -1, 1}, {1, -1, -1}, {-1, -1, -1});
  b.quad(white, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});
  b.quad(white, {-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1});
  b.quad(red, {-1, -1, 1}, {-1, -1, -1}, {-1, 1, -1}, {-1, 1, 1});
  b.quad(green, {1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1});
  b.box(white, {-0.6f, -1.0f, -0.6f}, {-0.05f, 0.25f, -0.1f});
  b.sphere(white, {0.45f, -0.6f, 0.25f}, 0.4f, 24);
  b.quad(light, {-0.3f, 0.99f, -0.3f}, {0.3f, 0.99f, -0.3f}, {0.3f, 0.99f, 0.3f}, {-0.3f, 0.99f, 0.3f});
  b.look({0.0, 0.0, 3.9}, {0.0, 0.0, 0.0}, 0.68f);
  return b;
}

}  // namespace limn::test
