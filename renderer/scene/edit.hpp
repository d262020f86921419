#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/scene/scene.hpp"

namespace limn {

/// What an edit costs, cheapest first. DESIGN.md section 3.
enum class CostClass : uint32_t { none, displayOnly, relight, regather, rebuild, reload };
const char* costClassName(CostClass cost);  ///< "none", "display-only", "relight", "re-gather", "rebuild", "reload"

enum class ToneMap : uint32_t { pbrNeutral, aces, agx, linear };
std::optional<ToneMap> toneMapFromName(std::string_view name);  ///< "pbr-neutral", "aces", "agx", "linear"
const char* toneMapName(ToneMap map);

/// What of the film is shown. Beauty, direct and indirect are radiance and tone-mapped.
enum class ResolveView : uint32_t { beauty, direct, indirect, albedo, normal, depth, samples, placement };
std::optional<ResolveView> resolveViewFromName(std::string_view name);
const char* resolveViewName(ResolveView view);  ///< "beauty", "direct", ...

/// How radiance becomes display values; never restarts sampling.
struct ResolveSettings {
  float exposure = 0.0f;            ///< [EV], radiance is multiplied by 2^exposure
  ToneMap toneMap = ToneMap::pbrNeutral;
  ResolveView view = ResolveView::beauty;
  bool operator==(const ResolveSettings&) const = default;
};

/// Absent fields keep their value. Ranges are checked by validate().
struct SetMaterial {
  uint32_t material = 0;
  std::optional<glm::vec4> baseColor;
  std::optional<float> metallic, roughness;
  std::optional<glm::vec3> emission;
  std::optional<float> ior, transmission, thickness, attenuationDistance;
  std::optional<glm::vec3> attenuationColor;
  std::optional<float> specular;
  std::optional<glm::vec3> specularColor;
  std::optional<float> clearcoat, clearcoatRoughness, normalScale, alphaCutoff;
  std::optional<AlphaMode> alphaMode;
};
struct SetLight {
  uint32_t light = 0;
  std::optional<glm::vec3> color;
  std::optional<float> intensity, range, innerConeAngle, outerConeAngle;
};
struct SetNodeTransform {
  uint32_t node = 0;
  std::optional<glm::dvec3> translation;
  std::optional<glm::dquat> rotation;   ///< normalised on application
  std::optional<glm::dvec3> scale;
};
struct SetEnvironment {
  std::optional<glm::vec3> radiance;
  std::optional<float> rotation;
  std::optional<std::shared_ptr<const Image>> image;  ///< null: none any more
};
struct SetView { View view; };
struct SetResolve {
  std::optional<float> exposure;
  std::optional<ToneMap> toneMap;
  std::optional<ResolveView> view;
};
/// Technique and its parameters by announced name; the session checks them against the registry.
struct SetTechnique {
  std::optional<std::string> technique;
  std::vector<std::pair<std::string, double>> parameters;
};
struct SetImageSize { uint32_t width = 0, height = 0; };  ///< [pixel]

using Edit = std::variant<SetMaterial, SetLight, SetNodeTransform, SetEnvironment, SetView, SetResolve, SetTechnique,
                          SetImageSize>;

/// What a batch of edits changed, as the derived data need to know it.
struct ChangeSet {
  bool everything = false;             ///< a new scene
  std::vector<uint32_t> materials;     ///< shading data changed
  std::vector<uint32_t> emissive;      ///< materials whose emission changed (the light list changes)
  std::vector<uint32_t> lights;
  std::vector<uint32_t> nodes;         ///< nodes whose world matrix changed, descendants included; sorted, unique
  bool environment = false;
  bool environmentImage = false;       ///< its texels; then environment is set too
  bool view = false;
  bool resolve = false;
  bool empty() const;
  /// The dearest class among the changes of the scene.
  CostClass cost() const;
};

/// Checks one edit of the scene (indices in range, finite numbers, ranges of glTF) and says the field that is wrong
/// in Error::place ("material", "roughness", ...). SetResolve and SetView are checked too; SetTechnique and
/// SetImageSize are the session's.
Result<void> validate(const Scene& scene, const Edit& edit);

/// The same of one edit of a batch, against the scene as the edits before it, which must be valid, would leave it.
Result<void> validate(const Scene& scene, std::span<const Edit> batch, size_t index);

/// What a batch of edits found where it wrote.
struct Overwritten {
  std::map<uint32_t, Material> materials;     ///< by index, as the others
  std::map<uint32_t, Light> lights;
  std::map<uint32_t, Transform> transforms;   ///< of nodes
  Environment environment;
  View view;
  ResolveSettings resolve;
};

struct AppliedEdits {
  ChangeSet changes;
  Overwritten before;
};

/// Applies the scene part of a batch. All edits were validated. Values that equal the present ones change nothing and
/// are not in the ChangeSet. Sequential: the later edit of one field wins.
AppliedEdits apply(Scene& scene, ResolveSettings& resolve, const std::vector<Edit>& edits);

/// The part of apply() that moves a node.
void change(Transform& parentFromLocal, const SetNodeTransform& edit);

/// Puts back what the batch that was applied last overwrote.
void takeBack(Scene& scene, ResolveSettings& resolve, const Overwritten& before);

}  // namespace limn
