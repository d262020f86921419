// Point projection at the ends of its parameters, and how its bias falls as they grow.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/techniques/point_projection.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/technique_pictures.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kWidth = 48, kHeight = 36;

void expectLayersAddUp(const FilmImage& film) {
  EXPECT_TRUE(isSound(film));
  const auto &beauty = film.find("beauty")->data, &direct = film.find("direct")->data, &indirect = film.find("indirect")->data;
  double worst = 0.0;
  for (size_t i = 0; i < beauty.size(); ++i)
    worst = std::max(worst, std::abs(double(direct[i]) + indirect[i] - beauty[i]) / (beauty[i] + 1e-3));
  EXPECT_LT(worst, 1e-4);
  EXPECT_GT(meanOf(film, "direct"), 0.01);
}

/// The smallest and largest announced value; of counts that cost in proportion a large one within the range.
std::vector<double> endsOf(const ParameterInfo& p) {
  const bool isLong = p.name == "maxSamples" || p.name == "points";
  return {p.minimum, isLong ? std::min(p.maximum, 262144.0) : p.maximum};
}

/// One session: parameters are edited, as clients do.
class PointProjectionEnds : public testing::Test {
 protected:
  static SessionConfig config() { return pointProjection(24, 20, 2, 0, {{"points", 16384.0}}); }
  static void expectSound(TestSession& session, const Parameters& parameters) {
    session.apply({Edit(SetTechnique{std::nullopt, parameters})});
    session.run(4);
    EXPECT_TRUE(session.take<ErrorReply>().empty());
    EXPECT_EQ(session.status().discardedSamples, 0u);
    expectLayersAddUp(session.film());
  }
};

TEST_F(PointProjectionEnds, EveryParameterAtItsEndsGivesAPicture) {
  TestSession session(richScene().scene, config());
  session.run(1);
  for (const ParameterInfo& p : pointProjectionInfo().parameters) {
    const double usual = [&] {
      for (const auto& [name, value] : config().parameters)
        if (name == p.name) return value;
      return p.defaultValue;
    }();
    for (const double value : endsOf(p)) {
      SCOPED_TRACE(p.name + " = " + std::to_string(value));
      expectSound(session, {{p.name, value}});
    }
    session.apply({Edit(SetTechnique{std::nullopt, {{p.name, usual}}})});
  }
}

TEST_F(PointProjectionEnds, SoDoAllAtTheirEndsTogether) {
  TestSession session(richScene().scene, config());
  session.run(1);
  for (const size_t end : {size_t(0), size_t(1)}) {
    SCOPED_TRACE(end == 0 ? "least" : "most");
    Parameters all;
    for (const ParameterInfo& p : pointProjectionInfo().parameters) {
      const bool isLong = p.name == "points" || p.name == "bounces" || p.name == "relightSamples";
      all.push_back({p.name, end == 1 && isLong ? 2.0 * endsOf(p)[0] + 2.0 : endsOf(p)[end]});
    }
    expectSound(session, all);
  }
}

TEST_F(PointProjectionEnds, WithoutBouncesThereIsDirectLightAlone) {
  TestSession session(plainScene(), config());
  session.apply({Edit(SetTechnique{std::nullopt, {{"bounces", 0.0}}})});
  session.run(4);
  EXPECT_LE(largestOf(session.film(), "indirect"), 1e-6);
  EXPECT_GT(meanOf(session.film(), "direct"), 0.01);
}

// Three settings, each with more points, projections and texels. One bounce in a room of four walls and a block. Without
// rays the projections show their own bias; with rays little is left of it whatever the setting.
TEST(PointProjectionBias, FallsAsPointsProjectionsAndMicroBuffersGrow) {
  const Scene scene = plainScene();
  const PicturePair truth = pairOf(scene, pathTracing(kWidth, kHeight, 1, 512));
  const auto sizes = [](double points, double clusters, double projections, double microSize) {
    return Parameters{{"points", points}, {"clusters", clusters}, {"projections", projections},
                      {"microSize", microSize}, {"filterSize", 1.0}, {"correctionRays", 0.0}};
  };
  const Parameters settings[] = {sizes(16384, 64, 512, 8), sizes(32768, 256, 1536, 16), sizes(262144, 512, 4096, 32)};
  std::vector<double> bias;
  for (const Parameters& setting : settings)
    bias.push_back(biasOf(pairOf(scene, pointProjection(kWidth, kHeight, 1, 80, setting)), truth, "indirect"));
  EXPECT_LT(bias[1], 0.8 * bias[0]);
  EXPECT_LT(bias[2], 0.8 * bias[1]);
  EXPECT_LT(bias[2], 0.04);
  Parameters corrected = settings[0];
  corrected.back().second = 32.0;
  EXPECT_LT(biasOf(pairOf(scene, pointProjection(kWidth, kHeight, 1, 80, corrected)), truth, "indirect"), 0.1 * bias[0]);
}

}  // namespace
}  // namespace limn::test
