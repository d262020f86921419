#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "renderer/scene/gltf_loader.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {

/// The hard cases of this program, in the order of the table.
std::vector<HardCase> makeHardCases();
/// Names this program's part of the table.
const char* hardCaseGroup();

inline const std::vector<HardCase>& hardCases() {
  static const std::vector<HardCase> kCases = makeHardCases();
  return kCases;
}

/// `radiance`, where it is known, is that of the whole picture [W·sr⁻¹·m⁻²].
inline HardCase hardCase(const std::string& name, const std::string& claim, std::function<Scene()> scene,
                         std::optional<double> radiance = {}) {
  HardCase hard;
  hard.name = name;
  hard.claim = claim;
  hard.scene = std::move(scene);
  hard.radiance = radiance;
  return hard;
}

inline Scene generatedScene(const std::string& name) {
  return must(loadGltf(LIMN_BUILD_DIR "/scenes/" + name + ".glb")).scene;
}

/// Every technique of the registry on every hard case of the program. A technique renders all of its pictures of one seed in one
/// session, so that its pipelines are made once.
class HardCases : public testing::TestWithParam<std::pair<size_t, size_t>> {
 protected:
  static constexpr uint32_t kWidth = 48, kHeight = 36, kSamples = 32;

  static void TearDownTestSuite() {
    s_sessions.clear();
    s_kept.clear();
    writeHardCases(LIMN_BUILD_DIR, hardCaseGroup(), s_cells);
  }

  static HardCell measure(const HardCase& hard, const TechniqueInfo& technique) {
    const Scene scene = hard.scene();
    const HardPictures pictures = take(technique, scene, hard.bounces, 11);
    const PicturePair truth = expected(hard, scene, unbiased());
    const PicturePair reference = hard.twin ? expected(hard, scene, technique) : truth;
    s_cells.push_back(judge(hard, technique, pictures, reference, truth));
    return s_cells.back();
  }

 private:
  /// The first technique that claims to have no bias.
  static const TechniqueInfo& unbiased() {
    return *std::find_if(techniqueInfos().begin(), techniqueInfos().end(), [](const auto& info) { return !info.biased; });
  }

  /// What the picture must be, by its closed form or as `technique` sees the twin or, without one, the scene.
  static PicturePair expected(const HardCase& hard, const Scene& scene, const TechniqueInfo& technique) {
    if (hard.radiance) return constantPictures(kWidth, kHeight, *hard.radiance);
    const std::string key = technique.name + " " + (hard.twin ? hard.twinName : hard.name);
    auto [kept, isNew] = s_kept.try_emplace(key);
    if (isNew) kept->second = take(technique, hard.twin ? hard.twin() : scene, hard.bounces, 21).pair;
    return kept->second;
  }

  /// Two pictures, of `seed` and the next; both together have 64 samples of a pixel.
  static HardPictures take(const TechniqueInfo& technique, const Scene& scene, uint32_t bounces, uint32_t seed) {
    HardPictures pictures;
    pictures.pair.a = take(technique, scene, bounces, seed, pictures);
    pictures.pair.b = take(technique, scene, bounces, seed + 1, pictures);
    return pictures;
  }

  static FilmImage take(const TechniqueInfo& technique, const Scene& scene, uint32_t bounces, uint32_t seed, HardPictures& counts) {
    auto& session = s_sessions[technique.name + " " + std::to_string(seed)];
    if (!session) session = std::make_unique<TestSession>(scene, config(technique, seed));
    SetTechnique settings;
    for (const ParameterInfo& p : technique.parameters)
      if (p.name == "maxBounces" || p.name == "bounces") settings.parameters.emplace_back(p.name, bounces);
    (void)session->apply({settings});
    LoadRequest load;
    load.loaded = std::make_shared<LoadedScene>(LoadedScene{scene, {}});
    session->ask(std::move(load));
    session->run(0);
    const uint64_t before = session->status().discardedSamples;
    session->run(kSamples);
    FilmImage film = session->film();
    const uint64_t discarded = session->status().discardedSamples - before;
    counts.discarded += discarded;
    for (const float samples : film.find("samples")->data) counts.taken += uint64_t(samples);
    counts.taken += discarded;
    return film;
  }

  /// Fewest points and no adaptive sampling where a technique knows of such; otherwise its defaults.
  static SessionConfig config(const TechniqueInfo& technique, uint32_t seed) {
    SessionConfig config = smallPicture(kWidth, kHeight);
    config.technique = technique.name;
    config.seed = seed;
    config.firstSample = 2;  // point projection takes sample 0 at the middle of the pixel
    config.sampleCount = kSamples;
    config.frameSeconds = config.firstFrameSeconds = 1e6;
    for (const ParameterInfo& p : technique.parameters) {
      if (p.name == "adaptive") config.parameters.emplace_back(p.name, 0.0);
      if (p.name == "points" || p.name == "clusters") config.parameters.emplace_back(p.name, p.minimum);
    }
    return config;
  }

  static inline std::map<std::string, std::unique_ptr<TestSession>> s_sessions;
  static inline std::map<std::string, PicturePair> s_kept;
  static inline std::vector<HardCell> s_cells;
};

inline std::vector<std::pair<size_t, size_t>> hardCells() {
  std::vector<std::pair<size_t, size_t>> cells;
  for (size_t i = 0; i < hardCases().size(); ++i)
    for (size_t k = 0; k < techniqueInfos().size(); ++k) cells.emplace_back(i, k);
  return cells;
}

/// "Scale1e3PathTracing": a test's name has letters and digits alone.
inline std::string hardCellName(const testing::TestParamInfo<std::pair<size_t, size_t>>& info) {
  std::string name;
  bool upper = true;
  for (const char c : hardCases()[info.param.first].name + " " + techniqueInfos()[info.param.second].name) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (kept) name += upper ? char(std::toupper(c)) : c;
    upper = !kept;
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(AllTechniques, HardCases, testing::ValuesIn(hardCells()), hardCellName);

TEST_P(HardCases, KeepsItsPromises) {
  const HardCell cell = measure(hardCases()[GetParam().first], techniqueInfos()[GetParam().second]);
  SCOPED_TRACE(cell.claim);
  EXPECT_TRUE(cell.sound) << "a layer holds a number that is not finite, or radiance below 0";
  EXPECT_LE(cell.deviation.value, cell.deviation.bound) << cell.unit;
  EXPECT_LE(cell.energy.value, cell.energy.bound) << "mean over the truth's";
  EXPECT_LE(cell.discarded.value, cell.discarded.bound) << "share of samples discarded";
  EXPECT_LE(cell.fireflies.value, cell.fireflies.bound) << "share of fireflies";
}

}  // namespace limn::test
