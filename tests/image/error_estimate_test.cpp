// Whether the error that is told is the error there is, on generated scenes, over seeds and numbers of samples. All
// counts are of samples and paths, so that the figures are the same on every machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "renderer/film/compare.hpp"
#include "renderer/scene/gltf_loader.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/technique_pictures.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kSide = 32;               // [pixel]
constexpr uint32_t kReferenceSamples = 384;  // of each half

struct Check {
  double estimate = 0.0, low = 0.0, high = 0.0, truth = 0.0;
  bool held() const { return low <= truth && truth <= high; }
};

/// One session of a seed renders scene after scene, so that the general pipelines are made once.
class SceneRenderer {
 public:
  SceneRenderer(SessionConfig config, uint32_t seed) : m_session(plainScene(), seeded(config, seed)) {}

  void load(const std::string& name) {
    LoadRequest request;
    request.loaded = std::make_shared<LoadedScene>(must(loadGltf(LIMN_BUILD_DIR "/scenes/" + name + ".glb")));
    m_session.ask(std::move(request));
    m_session.run(0);
    EXPECT_EQ(m_session.take<LoadReply>().size(), 1u);
  }
  FilmImage film(uint32_t passes) {
    m_session.run(passes);
    return m_session.film();
  }
  Check check(uint32_t passes, const PicturePair& reference) {
    const FilmImage shown = film(passes);
    const Status status = m_session.status();
    return {status.estimatedError, status.errorLow, status.errorHigh, relMseOf(shown, reference)};
  }

 private:
  static SessionConfig seeded(SessionConfig config, uint32_t seed) {
    config.seed = seed;
    return config;
  }

  /// As `limn compare --halves` says it: without the largest quotients.
  static double relMseOf(const FilmImage& shown, const PicturePair& reference) {
    const RadianceView a = radianceOf(reference.a, "a").value();
    const RadianceView b = radianceOf(reference.b, "b").value();
    RadianceImage mean{a.width, a.height, {}};
    for (size_t i = 0; i < a.values.size(); ++i) mean.values.push_back(0.5f * (a.values[i] + b.values[i]));
    return compareImages(radianceOf(shown, "shown").value(), {mean.view(), a, b})->relMse;
  }

  TestSession m_session;
};

using References = std::map<std::string, PicturePair>;

References referencesOf(const std::vector<std::string>& scenes) {
  References references;
  const SessionConfig config = pathTracing(kSide, kSide, 32, kReferenceSamples);
  SceneRenderer first(config, 101), second(config, 102);
  for (const std::string& name : scenes) {
    first.load(name);
    second.load(name);
    references[name] = {first.film(kReferenceSamples), second.film(kReferenceSamples)};
  }
  return references;
}

double medianRatio(const std::vector<Check>& checks) {
  std::vector<double> ratios;
  for (const Check& c : checks) ratios.push_back(c.estimate / c.truth);
  std::nth_element(ratios.begin(), ratios.begin() + std::ptrdiff_t(ratios.size() / 2), ratios.end());
  return ratios[ratios.size() / 2];
}

double heldShare(const std::vector<Check>& checks) {
  const auto held = std::count_if(checks.begin(), checks.end(), [](const Check& c) { return c.held(); });
  return double(held) / double(checks.size());
}

std::string textOf(const std::vector<Check>& checks) {
  std::string text;
  for (const Check& c : checks)
    text += std::to_string(c.estimate) + " (" + std::to_string(c.low) + " to " + std::to_string(c.high) + ") of " +
            std::to_string(c.truth) + "\n";
  return text;
}

TEST(ErrorEstimate, OfThePathTracerIsWhatItSays) {
  const std::vector<std::string> scenes{"cornell-box", "cornell-point", "veach-mis"};
  const References references = referencesOf(scenes);
  std::vector<Check> checks;
  for (uint32_t seed = 0; seed < 6; ++seed) {
    SceneRenderer renderer(pathTracing(kSide, kSide, 32, 64), seed);
    for (const std::string& name : scenes) {
      renderer.load(name);
      for (const uint32_t passes : {3u, 4u, 6u})  // 4, 8 and 16 samples
        checks.push_back(renderer.check(passes, references.at(name)));
    }
  }
  EXPECT_GE(heldShare(checks), 0.9) << textOf(checks);
  EXPECT_NEAR(std::log(medianRatio(checks)), 0.0, std::log(1.25)) << textOf(checks);
}

// Textures and bumps: no pixel is quite like the one beside it, and one that a bright path has lifted must not hide its error
// behind its own mean all the same.
TEST(ErrorEstimate, OfThePathTracerIsWhatSeedsDifferByOnTextures) {
  const std::string scene = "demo";
  const References references = referencesOf({scene});
  double told = 0.0, truth = 0.0;
  std::vector<Check> checks;
  for (uint32_t seed = 0; seed < 12; ++seed) {
    SceneRenderer renderer(pathTracing(kSide, kSide, 32, 64), seed);
    renderer.load(scene);
    checks.push_back(renderer.check(8, references.at(scene)));
    told += checks.back().estimate;
    truth += checks.back().truth;
  }
  EXPECT_NEAR(std::log(told / truth), 0.0, std::log(1.25)) << textOf(checks);
}

TEST(ErrorEstimate, HoldsTheBiasOfPointProjectionWhereItIsLarge) {
  constexpr uint32_t kPasses = 5;
  const std::string scene = "ajar-door";
  const References references = referencesOf({scene});
  SessionConfig config = pointProjection(kSide, kSide, 6, 0);
  config.auditPathsPerPass = 8000;
  std::vector<Check> checks;
  for (uint32_t seed = 0; seed < 4; ++seed) {
    SceneRenderer renderer(config, seed);
    renderer.load(scene);
    checks.push_back(renderer.check(kPasses, references.at(scene)));
  }
  for (const Check& c : checks) {
    EXPECT_GT(c.truth, 0.02) << "the scene is too easy to tell anything";
    EXPECT_TRUE(c.held()) << textOf(checks);
  }

  config.parameters.emplace_back("auditShare", 0.0);
  SceneRenderer silent(config, 0);
  silent.load(scene);
  EXPECT_TRUE(std::isinf(silent.check(kPasses, references.at(scene)).high)) << "certainty about a bias that nobody looked at";
}

}  // namespace
}  // namespace limn::test
