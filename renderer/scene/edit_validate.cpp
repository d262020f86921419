#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/scene/edit.hpp"
#include "renderer/scene/reach.hpp"

namespace limn {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::max();
constexpr float kMaxExposure = 64.0f;
constexpr float kHalfPi = 1.5707964f;
constexpr float kPi = 3.1415927f;

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Collects the first complaint.
class Checker {
 public:
  void fail(const char* field, std::string message) {
    if (m_result.ok()) m_result = Error{"out-of-range", std::move(message), field};
  }
  void require(bool good, const char* field, const char* message) {
    if (!good) fail(field, message);
  }
  bool index(uint32_t i, size_t count, const char* field) {
    if (i < count) return true;
    fail(field, std::string("there is no ") + field + " " + std::to_string(i) + ", there are " + std::to_string(count));
    return false;
  }
  void range(const std::optional<float>& v, float low, float high, const char* field) {
    if (v) number(*v, low, high, field);
  }
  template <int N>
  void range(const std::optional<glm::vec<N, float>>& v, float low, float high, const char* field) {
    for (int i = 0; v && i < N; ++i) number((*v)[i], low, high, field);
  }
  void place(const glm::dvec3& v, const char* field) {
    require(finite(v) && glm::length(v) <= kFarthest, field, "must be finite and within 1e15 m of the origin");
  }
  Result<void> take() { return std::move(m_result); }

 private:
  void number(float v, float low, float high, const char* field) {
    if (std::isfinite(v) && v >= low && v <= high) return;
    std::string allowed = high == kUnbounded   ? "at least " + std::to_string(low)
                          : low == -kUnbounded ? "finite"
                                               : "from " + std::to_string(low) + " to " + std::to_string(high);
    fail(field, std::string(field) + " is " + std::to_string(v) + " and must be " + allowed);
  }

  Result<void> m_result;
};

struct Validator {
  const Scene& scene;
  std::span<const Edit> earlier;  ///< of the same batch
  Checker check;

  void operator()(const SetMaterial& e) {
    if (!check.index(e.material, scene.materials.size(), "material")) return;
    check.range(e.baseColor, 0.0f, 1.0f, "baseColor");
    check.range(e.metallic, 0.0f, 1.0f, "metallic");
    check.range(e.roughness, 0.0f, 1.0f, "roughness");
    check.range(e.emission, 0.0f, kUnbounded, "emission");
    if (e.ior)
      check.require(*e.ior == 0.0f || (std::isfinite(*e.ior) && *e.ior >= 1.0f), "ior", "ior must be 0 or at least 1");
    check.range(e.transmission, 0.0f, 1.0f, "transmission");
    check.range(e.thickness, 0.0f, kUnbounded, "thickness");
    check.range(e.attenuationDistance, 0.0f, kUnbounded, "attenuationDistance");
    check.range(e.attenuationColor, 0.0f, 1.0f, "attenuationColor");
    check.range(e.specular, 0.0f, 1.0f, "specular");
    check.range(e.specularColor, 0.0f, kUnbounded, "specularColor");
    check.range(e.clearcoat, 0.0f, 1.0f, "clearcoat");
    check.range(e.clearcoatRoughness, 0.0f, 1.0f, "clearcoatRoughness");
    check.range(e.normalScale, -kUnbounded, kUnbounded, "normalScale");
    check.range(e.alphaCutoff, 0.0f, kUnbounded, "alphaCutoff");
    if (e.alphaMode)
      check.require(*e.alphaMode <= AlphaMode::blend, "alphaMode", "alphaMode must be opaque, mask or blend");
  }

  void operator()(const SetLight& e) {
    if (!check.index(e.light, scene.lights.size(), "light")) return;
    check.range(e.color, 0.0f, 1.0f, "color");
    check.range(e.intensity, 0.0f, kUnbounded, "intensity");
    check.range(e.range, 0.0f, kUnbounded, "range");
    check.range(e.outerConeAngle, 0.0f, kHalfPi, "outerConeAngle");
    check.range(e.innerConeAngle, 0.0f, kHalfPi, "innerConeAngle");
    if (!e.innerConeAngle && !e.outerConeAngle) return;
    float inner = scene.lights[e.light].innerConeAngle, outer = scene.lights[e.light].outerConeAngle;
    for (const Edit& edit : earlier) {
      const auto* before = std::get_if<SetLight>(&edit);
      if (!before || before->light != e.light) continue;
      inner = before->innerConeAngle.value_or(inner);
      outer = before->outerConeAngle.value_or(outer);
    }
    check.require(e.innerConeAngle.value_or(inner) < e.outerConeAngle.value_or(outer), e.innerConeAngle ? "innerConeAngle" : "outerConeAngle",
                  "innerConeAngle must be smaller than outerConeAngle");
  }

  void operator()(const SetNodeTransform& e) {
    if (!check.index(e.node, scene.nodes.size(), "node")) return;
    if (e.translation) check.place(*e.translation, "translation");
    if (e.rotation) {
      const double norm = glm::length(*e.rotation);
      check.require(norm > 1e-6 && norm < 1e6, "rotation", "rotation must be a finite quaternion that is not zero");
    }
    if (!e.scale) return;
    const glm::dvec3 size = glm::abs(*e.scale);
    const bool good =
        finite(size) && std::min({size.x, size.y, size.z}) >= 1e-12 && std::max({size.x, size.y, size.z}) <= 1e12;
    check.require(good, "scale", "the size of each scale must be from 1e-12 to 1e12");
  }

  void operator()(const SetEnvironment& e) {
    check.range(e.radiance, 0.0f, kUnbounded, "radiance");
    check.range(e.rotation, -kUnbounded, kUnbounded, "rotation");
  }

  void operator()(const SetView& e) {
    const View& v = e.view;
    check.place(v.eye, "view/eye");
    check.place(v.target, "view/target");
    check.require(finite(v.up) && glm::length(v.up) > 1e-12, "view/up", "up must be finite and not zero");
    const glm::dvec3 axis = v.target - v.eye;
    check.require(glm::length(axis) > 1e-12, "view/target", "target must not be the eye");
    const double sine = glm::length(glm::cross(axis, v.up)) / (glm::length(axis) * glm::length(v.up));
    check.require(sine > 1e-6, "view/up", "up must not be parallel to the direction of view");
    if (v.lens.perspective) {
      check.require(v.lens.yfov >= 1e-4f && v.lens.yfov <= kPi - 1e-3f, "view/yfov", "yfov must be from 0.0001 to below pi");
    } else {
      check.require(std::isfinite(v.lens.ymag) && v.lens.ymag > 0.0f, "view/ymag", "ymag must be finite and above 0");
    }
    check.require(std::isfinite(v.lens.znear) && v.lens.znear >= 0.0f, "view/znear",
                  "znear must be finite and not negative");
  }

  void operator()(const SetResolve& e) {
    check.range(e.exposure, -kMaxExposure, kMaxExposure, "exposure");
    if (e.toneMap) check.require(*e.toneMap <= ToneMap::linear, "toneMap", "unknown tone map");
    if (e.view) check.require(*e.view <= ResolveView::placement, "view", "unknown view");
  }

  void operator()(const SetTechnique&) {}
  void operator()(const SetImageSize&) {}
};

}  // namespace

Result<void> validate(const Scene& scene, const Edit& edit) { return validate(scene, std::span(&edit, 1), 0); }

Result<void> validate(const Scene& scene, std::span<const Edit> batch, size_t index) {
  Validator validator{scene, batch.first(index), {}};
  std::visit(validator, batch[index]);
  return validator.check.take();
}

}  // namespace limn
