#include <functional>

#include "tests/gpu/bsdf_cases.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kDraws = 1u << 14;
constexpr float kCosines[] = {1.0f, 0.8f, 0.4f, 0.1f, 0.02f};

struct Family {
  const char* name;
  std::function<shared::BsdfCase(float cosine, float alpha)> make;
};
void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }

std::string familyName(const testing::TestParamInfo<Family>& info) { return info.param.name; }

struct Moments {
  double mean = 0.0, error = 0.0;
};
Moments meanWeight(const std::vector<BsdfDraw>& draws) {
  double sum = 0.0, squares = 0.0;
  for (const BsdfDraw& d : draws) {
    sum += d.weight.g;
    squares += double(d.weight.g) * d.weight.g;
  }
  const double n = double(draws.size()), mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

/// Refraction scales radiance by the index squared; the energy is what is left without that.
void undoScaling(const shared::BsdfCase& c, std::vector<BsdfDraw>& draws) {
  if (c.transmission == 0.0f || (c.flags & shared::kMaterialThin)) return;
  const float eta = c.frontFace ? c.ior : 1.0f / c.ior;
  for (BsdfDraw& d : draws)
    if (d.transmitted()) d.weight *= eta * eta;
}

shared::BsdfCase blackUnder(shared::BsdfCase c) {
  c.baseColor = glm::vec3(0.0f);
  return c;
}

const std::vector<Family>& families() {
  static const std::vector<Family> kFamilies{
      {"Metal", metalCase},
      {"Dielectric", dielectricCase},
      {"DielectricLayer", [](float c, float a) { return blackUnder(dielectricCase(c, a)); }},
      {"Diffuse", [](float c, float) { return whiteCase(c); }},
      {"Glass", [](float c, float a) { return glassCase(c, a, true); }},
      {"GlassFromInside", [](float c, float a) { return glassCase(c, a, false); }},
      {"Thin", thinCase},
      {"CoatedSmooth", [](float c, float a) { return coatedCase(c, a, 0.0f); }},
      {"CoatedRough", [](float c, float a) { return coatedCase(c, 0.5f, a); }},
      {"CoatOnBlack", [](float c, float a) { return blackUnder(coatedCase(c, 0.5f, a)); }}};
  return kFamilies;
}

class Bsdfs : public testing::TestWithParam<Family> {};
INSTANTIATE_TEST_SUITE_P(Materials, Bsdfs, testing::ValuesIn(families()), familyName);

TEST_P(Bsdfs, SendBackNoMoreThanArrives) {
  for (const float cosine : kCosines)
    for (int step = 0; step <= 10; ++step) {
      const float roughness = 0.1f * float(step);
      const shared::BsdfCase c = GetParam().make(cosine, roughness * roughness);
      auto draws = drawBsdf(c, kDraws, uint32_t(100 + step));
      undoScaling(c, draws);
      const Moments m = meanWeight(draws);
      EXPECT_LE(m.mean, 1.0 + 3.0 * m.error + 1e-5) << "roughness " << roughness << ", cosine " << cosine;
    }
}

/// Grazing views, lobes on both sides of the mirror's limit, no change of index, and all at once.
TEST_P(Bsdfs, StayFiniteAtTheEdges) {
  for (const float cosine : {1.0f, 0.1f, 1e-3f, 1e-6f})
    for (const float alpha : {0.0f, 0.99e-4f, 1.01e-4f, 2e-4f, 1.0f})
      for (const float ior : {1.0f, 1.0005f, 1.002f, 1.5f, 3.0f}) {
        shared::BsdfCase c = GetParam().make(cosine, alpha);
        c.ior = ior;
        int bad = 0;
        for (const BsdfDraw& d : drawBsdf(c, 512, 3)) {
          for (int k = 0; k < 3; ++k)
            bad += !std::isfinite(d.weight[k]) || d.weight[k] < 0 || !std::isfinite(d.value[k]);
          bad += !std::isfinite(d.pdf) || d.pdf < 0 || (d.mirror() && d.pdf != 0);
          if (d.weight != glm::vec3(0)) bad += std::abs(glm::length(d.dirW) - 1) > 1e-4f;
        }
        EXPECT_EQ(bad, 0) << "cosine " << cosine << ", alpha " << alpha << ", ior " << ior;
      }
}

TEST_P(Bsdfs, ReflectBothWaysAlike) {
  if (GetParam().make(1.0f, 0.5f).clearcoat > 0.0f)
    return;  // the coat dims by the viewer's angle alone. [KHR_materials_clearcoat]
  for (const float alpha : {0.05f, 0.3f, 1.0f}) {
    shared::BsdfCase c = GetParam().make(0.5f, alpha);
    c.transmission = std::min(c.transmission, 0.5f);
    constexpr uint32_t kPairs = 4096;
    const auto values = runBsdf(c, shared::kBsdfSwap, kPairs, 2, 11);
    int unequal = 0;
    for (uint32_t i = 0; i < kPairs; ++i) {
      const glm::vec4 forth = values[2 * i], back = values[2 * i + 1];
      if (forth.w < 0.01f || back.w < 0.01f) continue;  // division by the cosine leaves few digits
      unequal += std::abs(forth.g - back.g) > 2e-3f * std::max(forth.g, back.g) + 1e-6f;
    }
    EXPECT_EQ(unequal, 0) << "alpha " << alpha;
  }
}

TEST(Mirror, SendsAllLightOneWay) {
  for (const float alpha : {0.0f, 1e-4f}) {
    const shared::BsdfCase c = metalCase(0.3f, alpha);
    for (const BsdfDraw& d : drawBsdf(c, 256, 5)) {
      ASSERT_TRUE(d.mirror());
      EXPECT_LT(glm::length(d.dirW - (2.0f * glm::dot(c.normal, c.woW) * c.normal - c.woW)), 1e-5f);
      EXPECT_NEAR(d.weight.g, 1.0f, 1e-5f);
    }
  }
}

/// Snell's law and Fresnel's equations for a smooth boundary, entering and leaving.
TEST(Mirror, GlassSplitsLightAsFresnelSays) {
  for (const bool entering : {true, false})
    for (const float cosine : {1.0f, 0.8f, 0.3f}) {
      const shared::BsdfCase c = glassCase(cosine, 0.0f, entering);
      const double eta = entering ? 1.5 : 1 / 1.5, sine2 = (1 - double(cosine) * cosine) / (eta * eta);
      double reflectance = 1.0;
      if (sine2 < 1.0) {
        const double t = std::sqrt(1 - sine2), s = (cosine - eta * t) / (cosine + eta * t),
                     p = (eta * cosine - t) / (eta * cosine + t);
        reflectance = 0.5 * (s * s + p * p);
      }
      double reflected = 0.0, transmitted = 0.0;
      for (const BsdfDraw& d : drawBsdf(c, kDraws, 6)) {
        if (d.weight.g == 0.0f) continue;
        ASSERT_TRUE(d.mirror());
        (d.transmitted() ? transmitted : reflected) += d.weight.g / kDraws;
        const double sine = glm::length(glm::cross(d.dirW, c.normal)),
                     incident = std::sqrt(1 - double(cosine) * cosine);
        EXPECT_NEAR(sine, d.transmitted() ? incident / eta : incident, 2e-5);
      }
      // A lobe's weight is constant, so its sum errs as the binomial count of its draws.
      const double error = 4.0 / std::sqrt(double(kDraws));
      EXPECT_NEAR(reflected, reflectance, error * std::sqrt(reflectance) + 1e-4) << cosine << entering;
      EXPECT_NEAR(transmitted * eta * eta, 1 - reflectance, error * std::sqrt(1 - reflectance) + 1e-4)
          << cosine << entering;
    }
}

}  // namespace
}  // namespace limn::test
