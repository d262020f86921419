#pragma once
#include "tests/support/scene_builder.hpp"

namespace limn::test {

/// Where the parts of richScene() are.
struct RichScene {
  Scene scene;
  uint32_t floor = 0, glass = 0, cutout = 0, coated = 0, lamp = 0, metal = 0;  ///< materials
  uint32_t point = 0, spot = 1, sun = 2;                                       ///< lights
  uint32_t group = 0, glassNode = 0, metalNode = 0, lampNode = 0;              ///< nodes
};

/// A few triangles that use everything: textures with alpha, a normal map, vertex colours, glass with a volume, clearcoat, an
/// area light, a point light, a spot, a sun, an environment image, and a node hierarchy.
RichScene richScene();

/// A small sky, brightest in texel `sun`, below 32; its name holds the number.
std::shared_ptr<const Image> skyImage(uint32_t sun);

/// Three diffuse walls under a point light: the least a scene can need.
Scene plainScene();

}  // namespace limn::test
