#include <bit>
#include <cmath>
#include <random>

#include "renderer/gpu/packing.hpp"
#include "renderer/scene/edit.hpp"
#include "tests/gpu/formulas.spv.hpp"
#include "tests/gpu/kernel.hpp"
#include "tests/gpu/shaders/formulas.h"
#include "tests/support/closed_form.hpp"

namespace limn::test {
namespace {

std::vector<glm::vec4> evaluate(uint32_t formula, const std::vector<glm::vec4>& values) {
  const vk::Buffer in = inputOf(values);
  return runKernel<glm::vec4>(formulasSpirv, {vk::storage(0, in)},
                              shared::FormulasPush{formula, uint32_t(values.size())}, values.size(),
                              groupsFor(values.size()));
}

/// Unit vectors everywhere, with those on axes, planes and octants' borders among them.
std::vector<glm::vec3> unitVectors() {
  std::vector<glm::vec3> list;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x || y || z) list.push_back(glm::normalize(glm::vec3(x, y, z)));
  std::mt19937 engine(17);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 20000; ++i)
    list.push_back(glm::normalize(glm::vec3(normal(engine), normal(engine), normal(engine))));
  for (const float tiny : {1e-3f, 1e-6f, -1e-6f}) list.push_back(glm::normalize(glm::vec3(tiny, -tiny, -1.0f)));
  return list;
}

TEST(Formula, OctahedralCoordinatesComeBack) {
  const std::vector<glm::vec3> vectors = unitVectors();
  std::vector<glm::vec4> packed;
  for (const glm::vec3& v : vectors) packed.push_back({std::bit_cast<float>(gpu::octEncode(v)), 0, 0, 0});
  const auto decoded = evaluate(shared::kFormulaOctDecode, packed);
  for (size_t i = 0; i < vectors.size(); ++i) {
    const double apart = glm::length(glm::dvec3(decoded[i]) - glm::dvec3(vectors[i]));
    EXPECT_LT(apart, 7e-5) << vectors[i].x << ' ' << vectors[i].y << ' ' << vectors[i].z;
  }
}

TEST(Formula, FramesAreOrthonormal) {
  std::vector<glm::vec4> normals;
  for (const glm::vec3& v : unitVectors()) normals.push_back({v, 0});
  const auto errors = evaluate(shared::kFormulaFrame, normals);
  for (size_t i = 0; i < normals.size(); ++i) {
    EXPECT_LT(errors[i].x, 2e-6f) << normals[i].x << ' ' << normals[i].y << ' ' << normals[i].z;
    EXPECT_NEAR(errors[i].y, 1.0f, 1e-6f);
    EXPECT_NEAR(errors[i].z, 1.0f, 1e-6f);
  }
}

TEST(Formula, RemaindersAreExactBelow2ToThe22) {
  const auto word = [](uint32_t w) { return std::bit_cast<float>(w); };
  std::vector<glm::uvec2> pairs;
  for (const uint32_t n : {1u, 2u, 3u, 7u, 32u, 511u, 512u, 513u, 16383u, 16384u})
    for (const uint32_t whole : {0u, 1u, 2u, 100u, ((1u << 22) - 1) / n})
      for (const uint32_t a : {whole * n, whole * n + n - 1, whole > 0 ? whole * n - 1 : 0u})
        if (a < 1u << 22) pairs.push_back({a, n});
  std::vector<glm::vec4> values;
  for (const glm::uvec2& p : pairs) values.push_back({word(p.x), word(p.y), 0, 0});
  const auto rests = evaluate(shared::kFormulaRemainder, values);
  for (size_t i = 0; i < pairs.size(); ++i)
    EXPECT_EQ(uint32_t(rests[i].x), pairs[i].x % pairs[i].y) << pairs[i].x << " mod " << pairs[i].y;
}

std::vector<glm::vec4> colours() {
  std::vector<glm::vec4> list{
      {0, 0, 0, 0},          {1, 1, 1, 0},          {0.18f, 0.18f, 0.18f, 0}, {1, 0, 0, 0},
      {0, 1, 0, 0},          {0, 0, 1, 0},          {0.08f, 0.08f, 0.08f, 0}, {0.76f, 0.76f, 0.76f, 0},
      {0.8f, 0.4f, 0.0f, 0}, {1e4f, 1e4f, 1e4f, 0}, {1e-4f, 2e-4f, 0, 0}};
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> exponent(-10, 6);
  for (int i = 0; i < 2000; ++i)
    list.push_back({std::exp2(exponent(engine)), std::exp2(exponent(engine)), std::exp2(exponent(engine)), 0});
  return list;
}

void expectClose(uint32_t formula, glm::dvec3 (*reference)(glm::dvec3)) {
  const auto in = colours();
  const auto out = evaluate(formula, in);
  for (size_t i = 0; i < in.size(); ++i) {
    const glm::dvec3 expected = reference(glm::dvec3(in[i]));
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(out[i][k], expected[k], 1e-3)
          << "of " << in[i].x << ' ' << in[i].y << ' ' << in[i].z << ", channel " << k;
  }
}

/// A matrix as the papers print it, row by row.
glm::dmat3 rows(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) { return glm::transpose(glm::dmat3(a, b, c)); }

// [KhronosGroup/ToneMapping, PBR_Neutral/README.md]
glm::dvec3 neutral(glm::dvec3 c) {
  const double f90 = 0.04, ks = 0.8 - f90, kd = 0.15;
  const double x = std::min({c.r, c.g, c.b}), f = x <= 2 * f90 ? x - x * x / (4 * f90) : f90;
  c -= f;
  const double p = std::max({c.r, c.g, c.b});
  if (p <= ks) return c;
  const double pn = 1 - (1 - ks) * (1 - ks) / (p + 1 - 2 * ks), g = 1 / (kd * (p - pn) + 1);
  return c * (pn / p) * g + pn * (1 - g);
}

// [S. Hill, BakingLab/ACES.hlsl]
glm::dvec3 aces(glm::dvec3 c) {
  const glm::dvec3 v = rows({0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}) * c;
  const glm::dvec3 fit = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  return glm::clamp(
      rows({1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}) * fit, 0.0,
      1.0);
}

// [T. Sobotka's AgX; the polynomial of B. Wrensch, "Minimal AgX Implementation"]
glm::dvec3 agx(glm::dvec3 c) {
  const glm::dmat3 inset = rows({0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                {0.0423756549057051, 0.0784336, 0.879142973793104});
  glm::dvec3 v = inset * c;
  for (int k = 0; k < 3; ++k) {
    const double t =
        (std::clamp(std::log2(std::max(v[k], 1e-10)), -12.47393, 4.026069) + 12.47393) / (4.026069 + 12.47393);
    v[k] = ((((((15.5 * t - 40.14) * t + 31.96) * t - 6.868) * t + 0.4298) * t + 0.1191) * t) - 0.00232;
  }
  v = glm::clamp(glm::inverse(inset) * v, 0.0, 1.0);
  return {std::pow(v.r, 2.2), std::pow(v.g, 2.2), std::pow(v.b, 2.2)};
}

// [IEC 61966-2-1]
glm::dvec3 srgb(glm::dvec3 c) {
  for (int k = 0; k < 3; ++k) {
    const double v = std::clamp(c[k], 0.0, 1.0);
    c[k] = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
  }
  return c;
}

TEST(Formula, PbrNeutralIsTheSpecificationsOwn) {
  expectClose(shared::kFormulaToneMap + uint32_t(ToneMap::pbrNeutral), neutral);
}
TEST(Formula, AcesIsTheFit) { expectClose(shared::kFormulaToneMap + uint32_t(ToneMap::aces), aces); }
TEST(Formula, AgxIsThePolynomial) { expectClose(shared::kFormulaToneMap + uint32_t(ToneMap::agx), agx); }
TEST(Formula, SrgbIsTheStandards) { expectClose(shared::kFormulaSrgb, srgb); }
TEST(Formula, LinearChangesNothing) {
  const auto in = colours();
  const auto out = evaluate(shared::kFormulaToneMap + uint32_t(ToneMap::linear), in);
  for (size_t i = 0; i < in.size(); ++i) EXPECT_EQ(glm::vec3(out[i]), glm::vec3(in[i]));
}

TEST(Formula, AlbedosOfGgxAreItsIntegrals) {
  const auto weight = [](double c) { return schlick(c, 0.0); };
  const auto full = [](double) { return 1.0; };
  constexpr int kCosines = 8, kDirections = 400;
  for (const double roughness : {0.0, 0.02, 0.1, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0}) {
    const Ggx ggx{roughness * roughness};
    std::vector<glm::vec4> at;
    for (int i = 0; i < kCosines; ++i) at.push_back({(i + 0.5f) / kCosines, float(ggx.alpha), 0, 0});
    for (const float cosine : {0.05f, 1.0f}) at.push_back({cosine, float(ggx.alpha), 0, 0});
    const auto fits = evaluate(shared::kFormulaGgxAlbedo, at);
    double mean = 0.0, meanWeight = 0.0;
    for (size_t i = 0; i < at.size(); ++i) {
      const double albedo = ggx.albedo(at[i].x, full, kDirections), weighted = ggx.albedo(at[i].x, weight, kDirections);
      EXPECT_NEAR(fits[i].x, albedo, 0.01) << "roughness " << roughness << ", cosine " << at[i].x;
      EXPECT_NEAR(fits[i].y, weighted, 0.005) << "roughness " << roughness << ", cosine " << at[i].x;
      EXPECT_GE(fits[i].y, weighted - 0.004) << "roughness " << roughness << ", cosine " << at[i].x;
      if (i >= kCosines) continue;
      mean += albedo * 2.0 * at[i].x / kCosines;
      meanWeight += weighted * 2.0 * at[i].x / kCosines;
    }
    EXPECT_NEAR(fits[0].z, mean, 0.008) << "roughness " << roughness;
    EXPECT_NEAR(fits[0].w, meanWeight, 0.004) << "roughness " << roughness;
  }
}

}  // namespace
}  // namespace limn::test
