#pragma once
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "shaders/shared/scene_shared.h"
#include "tests/gpu/bsdf.spv.hpp"
#include "tests/gpu/kernel.hpp"
#include "tests/gpu/shaders/bsdf_cases.h"

namespace limn::test {

struct NamedBsdf {
  std::string name;
  shared::BsdfCase data;
};
inline void PrintTo(const NamedBsdf& bsdf, std::ostream* out) { *out << bsdf.name; }
inline std::string bsdfName(const testing::TestParamInfo<NamedBsdf>& info) { return info.param.name; }

/// Normal of all cases: no axis, so that frames matter.
inline const glm::vec3 kCaseNormal = glm::normalize(glm::vec3(0.3f, -0.5f, 0.8f));
/// A unit vector at this cosine to `normal`, turned somewhere about it.
inline glm::vec3 atCosine(const glm::vec3& normal, float cosine, float turn = 0.9f) {
  const glm::vec3 t = glm::normalize(glm::cross(normal, glm::vec3(0.1f, 1.0f, 0.2f))), b = glm::cross(normal, t);
  return std::sqrt(1 - cosine * cosine) * (std::cos(turn) * t + std::sin(turn) * b) + cosine * normal;
}

/// White Lambert seen under this cosine.
inline shared::BsdfCase whiteCase(float cosine) {
  shared::BsdfCase c{};
  c.geometricNormal = c.normal = c.clearcoatNormal = c.axis = kCaseNormal;
  c.woW = glm::normalize(atCosine(kCaseNormal, cosine));
  c.concentration = 1.0f;
  c.baseColor = c.specularColor = glm::vec3(1.0f);
  c.alpha = c.clearcoatAlpha = 1.0f;
  c.ior = 1.5f;
  c.frontFace = 1;
  return c;
}
inline shared::BsdfCase metalCase(float cosine, float alpha) {
  shared::BsdfCase c = whiteCase(cosine);
  c.metallic = 1.0f;
  c.alpha = alpha;
  c.specular = 1.0f;
  return c;
}
inline shared::BsdfCase dielectricCase(float cosine, float alpha) {
  shared::BsdfCase c = whiteCase(cosine);
  c.alpha = alpha;
  c.specular = 1.0f;
  return c;
}
inline shared::BsdfCase glassCase(float cosine, float alpha, bool entering) {
  shared::BsdfCase c = dielectricCase(cosine, alpha);
  c.transmission = 1.0f;
  c.frontFace = entering ? 1 : 0;
  return c;
}
inline shared::BsdfCase thinCase(float cosine, float alpha) {
  shared::BsdfCase c = glassCase(cosine, alpha, true);
  c.flags = shared::kMaterialThin;
  return c;
}
inline shared::BsdfCase coatedCase(float cosine, float alpha, float coatAlpha) {
  shared::BsdfCase c = dielectricCase(cosine, alpha);
  c.clearcoat = 1.0f;
  c.clearcoatAlpha = coatAlpha;
  return c;
}

inline std::vector<glm::vec4> runBsdf(const shared::BsdfCase& c, uint32_t mode, uint32_t count, uint32_t vectors,
                                      uint32_t seed) {
  const vk::Buffer in = inputOf<shared::BsdfCase>({c});
  return runKernel<glm::vec4>(bsdfSpirv, {vk::storage(1, in)}, shared::BsdfPush{mode, count, seed},
                              size_t(count) * vectors, groupsFor(count));
}

struct BsdfDraw {
  glm::vec3 dirW;
  float pdf;
  glm::vec3 weight;
  float kind;  ///< 1: mirror, + 2: transmitted
  glm::vec3 value;
  float evaluatedPdf;
  bool mirror() const { return int(kind) & 1; }
  bool transmitted() const { return int(kind) & 2; }
};
static_assert(sizeof(BsdfDraw) == 48);

inline std::vector<BsdfDraw> drawBsdf(const shared::BsdfCase& c, uint32_t count, uint32_t seed) {
  const vk::Buffer in = inputOf<shared::BsdfCase>({c});
  return runKernel<BsdfDraw>(bsdfSpirv, {vk::storage(1, in)}, shared::BsdfPush{shared::kBsdfSample, count, seed}, count,
                             groupsFor(count));
}

}  // namespace limn::test
