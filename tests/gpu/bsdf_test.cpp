#include <numbers>

#include "tests/gpu/bsdf_cases.hpp"
#include "tests/support/statistics.hpp"

namespace limn::test {
namespace {

using shared::kColumnBins, shared::kRowBins;
constexpr uint32_t kDraws = 1u << 17;
constexpr uint32_t kBins = kRowBins * kColumnBins;

/// Bins crowd about the way of a mirror, for lobes too sharp for equal ones.
shared::BsdfCase aboutReflection(shared::BsdfCase c) {
  c.axis = glm::normalize(2.0f * glm::dot(c.normal, c.woW) * c.normal - c.woW);
  c.concentration = 4.0f;
  return c;
}
shared::BsdfCase aboutRefraction(shared::BsdfCase c) {
  const float eta = (c.flags & shared::kMaterialThin) ? 1.0f : c.frontFace ? c.ior : 1.0f / c.ior;
  c.axis = glm::normalize(glm::refract(-c.woW, c.normal, 1.0f / eta));
  c.concentration = 4.0f;
  return c;
}
shared::BsdfCase tilted(shared::BsdfCase c) {
  c.geometricNormal = glm::normalize(c.normal + glm::vec3(-0.2f, 0.3f, 0.1f));
  return c;
}
shared::BsdfCase coloured(shared::BsdfCase c) {
  c.baseColor = {0.9f, 0.3f, 0.05f};
  c.specularColor = {1.0f, 0.6f, 0.4f};
  return c;
}

std::vector<NamedBsdf> chiSquareCases() {
  std::vector<NamedBsdf> list;
  const auto add = [&](const char* name, const shared::BsdfCase& c) { list.push_back({name, c}); };
  add("Diffuse", whiteCase(0.6f));
  add("DiffuseTilted", tilted(whiteCase(0.6f)));
  add("MetalSharp", aboutReflection(metalCase(0.7f, 0.01f)));
  add("MetalSharpGrazing", aboutReflection(metalCase(0.05f, 0.01f)));
  add("MetalHalfRough", metalCase(0.5f, 0.25f));
  add("MetalHalfRoughGrazing", metalCase(0.04f, 0.25f));
  add("MetalRough", metalCase(0.9f, 1.0f));
  add("MetalRoughGrazing", metalCase(0.04f, 1.0f));
  add("MetalTilted", tilted(coloured(metalCase(0.5f, 0.4f))));
  add("DielectricNormal", dielectricCase(0.99f, 0.3f));
  add("DielectricOblique", coloured(dielectricCase(0.5f, 0.3f)));
  add("DielectricGrazing", dielectricCase(0.05f, 0.3f));
  add("DielectricSharp", aboutReflection(dielectricCase(0.3f, 0.02f)));
  shared::BsdfCase half = coloured(dielectricCase(0.4f, 0.5f));
  half.metallic = 0.5f;
  add("HalfMetal", half);
  add("GlassEntering", glassCase(0.8f, 0.3f, true));
  add("GlassEnteringGrazing", glassCase(0.05f, 0.3f, true));
  add("GlassEnteringRough", glassCase(0.5f, 1.0f, true));
  add("GlassEnteringSharp", aboutRefraction(glassCase(0.6f, 0.02f, true)));
  add("GlassLeaving", glassCase(0.95f, 0.3f, false));
  add("GlassLeavingTotally", glassCase(0.4f, 0.3f, false));
  add("GlassLeavingGrazing", glassCase(0.05f, 0.3f, false));
  add("GlassLeavingRough", glassCase(0.7f, 1.0f, false));
  add("GlassLeavingSharp", aboutRefraction(glassCase(0.9f, 0.02f, false)));
  shared::BsdfCase tinted = coloured(tilted(glassCase(0.6f, 0.4f, true)));
  tinted.transmission = 0.5f;
  add("HalfGlassTilted", tinted);
  add("Thin", thinCase(0.7f, 0.3f));
  add("ThinGrazing", thinCase(0.05f, 0.3f));
  add("ThinSharp", aboutRefraction(thinCase(0.7f, 0.02f)));
  add("Coated", coatedCase(0.6f, 0.8f, 0.2f));
  add("CoatedGrazing", coatedCase(0.05f, 0.5f, 0.2f));
  shared::BsdfCase bump = coloured(coatedCase(0.6f, 0.3f, 0.1f));
  bump.clearcoatNormal = glm::normalize(bump.normal + glm::vec3(0.1f, 0.2f, -0.1f));
  add("CoatWithItsOwnNormal", bump);
  shared::BsdfCase coatedGlass = glassCase(0.6f, 0.3f, true);
  coatedGlass.clearcoat = 0.7f;
  coatedGlass.clearcoatAlpha = 0.3f;
  add("CoatedGlass", coatedGlass);
  shared::BsdfCase silhouette = tilted(glassCase(0.3f, 0.4f, true));  // samples of each layer end below the other's surface
  silhouette.clearcoat = 1.0f;
  silhouette.clearcoatAlpha = 0.5f;
  silhouette.clearcoatNormal = glm::normalize(silhouette.normal + glm::vec3(-0.3f, -0.2f, 0.1f));
  add("CoatedGlassTilted", silhouette);
  return list;
}

size_t binOf(const shared::BsdfCase& c, const glm::vec3& dirW) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(c.axis)), d = glm::normalize(glm::dvec3(dirW));
  // The frame of makeFrame in shaders/lib/math.glsl.
  const double s = axis.z >= 0 ? 1 : -1, a = -1 / (s + axis.z), k = axis.x * axis.y * a;
  const glm::dvec3 t(1 + s * axis.x * axis.x * a, s * k, -s * axis.x), b(k, s + axis.y * axis.y * a, -axis.y);
  const glm::dvec3 apart = d - axis;
  const double row = std::pow(std::min(1.0, glm::dot(apart, apart) / 4), 1.0 / double(c.concentration));
  const double turn = std::atan2(glm::dot(d, b), glm::dot(d, t)) / (2 * std::numbers::pi);
  const auto index = [](double v, uint32_t bins) { return std::min(size_t(v * bins), size_t(bins - 1)); };
  return index(row, kRowBins) * kColumnBins + index(turn < 0 ? turn + 1 : turn, kColumnBins);
}

class BsdfMixture : public testing::TestWithParam<NamedBsdf> {};
INSTANTIATE_TEST_SUITE_P(Bsdfs, BsdfMixture, testing::ValuesIn(chiSquareCases()), bsdfName);

TEST_P(BsdfMixture, SamplesFollowTheirPdf) {
  const shared::BsdfCase& c = GetParam().data;
  std::vector<double> expected(kBins + 1, 0.0), counts(kBins + 1, 0.0);
  glm::dvec3 reflectance(0.0), sum(0.0), squares(0.0);
  double total = 0.0;
  const auto integrals = runBsdf(c, shared::kBsdfIntegrate, kBins, 1, 0);
  for (uint32_t i = 0; i < kBins; ++i) {
    total += integrals[i].w;
    expected[i] = integrals[i].w * double(kDraws);
    reflectance += glm::dvec3(integrals[i]);
  }
  EXPECT_LE(total, 1.003);
  expected[kBins] = std::max(0.0, 1.0 - total) * kDraws;  // draws that end the path

  for (const BsdfDraw& d : drawBsdf(c, kDraws, 77)) {
    ASSERT_FALSE(d.mirror());
    if (!(d.pdf > 0)) {
      counts[kBins] += 1;
      continue;
    }
    counts[binOf(c, d.dirW)] += 1;
    ASSERT_EQ(d.pdf, d.evaluatedPdf);
    ASSERT_EQ(d.transmitted(), glm::dot(c.geometricNormal, d.dirW) < 0);
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(d.weight[k], d.value[k] / d.pdf, 1e-5f * d.weight[k]);
    sum += glm::dvec3(d.weight);
    squares += glm::dvec3(d.weight) * glm::dvec3(d.weight);
  }
  const GoodnessOfFit fit = chiSquare(counts, expected);
  EXPECT_GT(fit.p, 0.01 / double(chiSquareCases().size()))
      << "chi-square " << fit.statistic << " of " << fit.dof << ", " << fit.worst << ", pdf adds to " << total;
  for (int k = 0; k < 3; ++k) {
    const double mean = sum[k] / kDraws, error = std::sqrt((squares[k] / kDraws - mean * mean) / kDraws);
    EXPECT_NEAR(mean, reflectance[k], 4.5 * error + 3e-3 * mean) << "mean weight against the integral of the value";
  }
}

}  // namespace
}  // namespace limn::test
