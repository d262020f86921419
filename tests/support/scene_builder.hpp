#pragma once
#include <string>

#include "renderer/scene/scene.hpp"

namespace limn::test {

/// Builds small scenes in code, for tests whose answer is known in closed form. Every add returns an index.
class SceneBuilder {
 public:
  Scene scene;

  /// Lambert: no specular reflection at all.
  uint32_t diffuse(const glm::vec3& albedo);
  uint32_t metal(const glm::vec3& color, float roughness);
  uint32_t emitter(const glm::vec3& radiance);
  uint32_t material(const Material& material);

  /// Node with a mesh of its own. Corners counter-clockwise seen from the front.
  uint32_t quad(uint32_t material, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d);
  uint32_t box(uint32_t material, glm::vec3 low, glm::vec3 high);
  /// Latitude-longitude sphere with `segments` steps from pole to pole; normals point outwards, or inwards when told.
  uint32_t sphere(uint32_t material, glm::vec3 center, float radius, uint32_t segments, bool inwards = false);
  uint32_t mesh(const Primitive& primitive);

  uint32_t pointLight(glm::vec3 position, glm::vec3 color, float intensity);
  uint32_t directionalLight(glm::vec3 direction, glm::vec3 color, float irradiance);
  uint32_t spotLight(glm::vec3 position, glm::vec3 direction, float intensity, float inner, float outer);

  void look(glm::dvec3 eye, glm::dvec3 target, float yfov, glm::dvec3 up = {0.0, 1.0, 0.0});

 private:
  uint32_t addNode(const std::string& name);
};

/// A closed room with two blocks, an area light under the ceiling and coloured walls; about 1 m wide.
SceneBuilder cornellLike();

}  // namespace limn::test
