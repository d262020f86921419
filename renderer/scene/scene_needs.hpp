#pragma once
#include <span>
#include <string>
#include <vector>

#include "renderer/scene/scene.hpp"

namespace limn {

/// What a scene contains that costs work; computed once a ChangeSet. Selects passes, caches and specialization
/// constants.
struct SceneNeeds {
  bool punctualLights = false;
  bool emissiveTriangles = false;
  bool environment = false;  ///< any non-zero radiance from outside
  bool environmentImage = false;
  bool textures = false;  ///< any material that a node uses samples an image
  bool normalMaps = false;
  bool alpha = false;  ///< MASK or BLEND materials in use
  bool transmission = false;
  bool panes = false;  ///< transmission that bends no light: shadow rays go on behind it
  bool clearcoat = false;
  bool glossy = false;  ///< any specular reflection that is not rough diffuse
  bool mirror = false;  ///< roughness below the delta limit, or smooth transmission
  bool sharp = false;   ///< a lobe too narrow for splats: roughness that may fall below kSharpRoughness, transmission, a coat
  bool vertexColors = false;
  bool manyLights = false;  ///< more than kFewLights: one is chosen by what it may bring, not by power alone
  bool operator==(const SceneNeeds&) const = default;
};

/// Perceptual roughness under which a lobe counts as sharp; its square is kSplatAlpha of the shaders.
constexpr float kSharpRoughness = 0.4473f;

/// Point lights, spots and emissive triangles, up to which it does not pay to look at each place which of them matter.
constexpr uint64_t kFewLights = 16;

SceneNeeds sceneNeeds(const Scene& scene);

/// One flag of SceneNeeds, for whoever goes over all of them.
struct SceneNeedFlag {
  const char* name;
  bool SceneNeeds::*flag;
};
std::span<const SceneNeedFlag> sceneNeedFlags();

/// Names of the set flags, for statistics and logs.
std::vector<std::string> describe(const SceneNeeds& needs);

}  // namespace limn
