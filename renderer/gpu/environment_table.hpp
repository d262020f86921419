#pragma once
#include <vector>

#include <glm/glm.hpp>

#include "renderer/scene/scene.hpp"

namespace limn::gpu {

/// Importance of an environment image: cells of equal solid angle (equal steps in azimuth and in the cosine of the polar
/// angle), an alias table over them. shaders/lib/environment.glsl samples it.
struct EnvironmentTable {
  uint32_t width = 0, height = 0;    ///< cells; 0: the environment is constant
  std::vector<glm::uvec4> entries;   ///< share bits, alias, probability bits, 0
};
/// Cells of the table of an image: columns, rows.
glm::uvec2 environmentCells(const Image& image);
EnvironmentTable buildEnvironmentTable(const Scene& scene);

}  // namespace limn::gpu
