// Pictures of generated scenes beside small references of 1,024 samples, which tests/image/README.md says how to make. The
// bound is the noise that both pictures say they have.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/film/exr.hpp"
#include "renderer/scene/gltf_loader.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kSide = 32, kTile = 8;  // [pixel]
constexpr uint32_t kSamples = 64;
constexpr double kSigmas = 6;  // the noise is that of the luminance: one channel may err by somewhat more

const std::vector<float>& dataOf(const FilmImage& image, const std::string& layer) {
  const FilmLayer* found = image.find(layer);
  LIMN_CHECK(found != nullptr);
  return found->data;
}

/// Mean over a tile of one channel, or for the standard errors of pixels that of their mean.
struct Tile {
  const FilmImage& image;
  uint32_t x, y;
  double mean(const std::string& layer, uint32_t channel) const {
    double sum = 0;
    each([&](size_t pixel) { sum += dataOf(image, layer)[3 * pixel + channel]; });
    return sum / (kTile * kTile);
  }
  double error() const {
    double sum = 0;
    each([&](size_t pixel) { sum += std::pow(double(dataOf(image, "error")[pixel]), 2); });
    return std::sqrt(sum) / (kTile * kTile);
  }
  template <class F>
  void each(F f) const {
    for (uint32_t dy = 0; dy < kTile; ++dy)
      for (uint32_t dx = 0; dx < kTile; ++dx) f(size_t(y + dy) * kSide + x + dx);
  }
};

/// One session renders all, so that the general pipelines are made once.
class Scenes : public testing::TestWithParam<const char*> {
 protected:
  static void SetUpTestSuite() {
    SessionConfig config = smallPicture(kSide, kSide);
    config.sampleCount = kSamples;
    config.parameters = {{"adaptive", 0.0}};
    s_session = std::make_unique<TestSession>(plainScene(), config);
  }
  static void TearDownTestSuite() { s_session.reset(); }

  static FilmImage pictureOf(const std::string& name) {
    LoadRequest request;
    request.loaded = std::make_shared<LoadedScene>(must(loadGltf(LIMN_BUILD_DIR "/scenes/" + name + ".glb")));
    s_session->ask(std::move(request));
    s_session->run(kSamples);
    EXPECT_EQ(s_session->take<LoadReply>().size(), 1u);
    return s_session->film();
  }

 private:
  static inline std::unique_ptr<TestSession> s_session;
};
INSTANTIATE_TEST_SUITE_P(Generated, Scenes, testing::Values("cornell-box", "cornell-point", "veach-mis", "textures"),
                         [](const auto& scene) {
                           std::string name = scene.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(Scenes, EveryTileIsTheReferencesWithinTheirNoise) {
  const FilmImage picture = pictureOf(GetParam());
  const std::string references = LIMN_SOURCE_DIR "/tests/image/references/";
  const FilmImage reference = must(readExr(references + GetParam() + ".exr"));
  ASSERT_EQ(reference.width, kSide);
  ASSERT_EQ(reference.height, kSide);
  double whole = 0, wholeReference = 0;
  for (uint32_t y = 0; y < kSide; y += kTile)
    for (uint32_t x = 0; x < kSide; x += kTile) {
      SCOPED_TRACE("tile at " + std::to_string(x) + ", " + std::to_string(y));
      const Tile ours{picture, x, y}, theirs{reference, x, y};
      const double noise = std::hypot(ours.error(), theirs.error());
      for (uint32_t k = 0; k < 3; ++k) {
        const double expected = theirs.mean("beauty", k);
        const auto expectNear = [&](const char* layer, double bound) {
          EXPECT_NEAR(ours.mean(layer, k), theirs.mean(layer, k), bound) << layer << ", channel " << k;
        };
        expectNear("beauty", kSigmas * noise + 1e-3 * expected);
        expectNear("direct", kSigmas * noise + 1e-3 * expected);
        expectNear("albedo", 0.01);
        expectNear("normal", 0.02);
        whole += ours.mean("beauty", k);
        wholeReference += expected;
      }
    }
  EXPECT_NEAR(whole, wholeReference, 0.02 * wholeReference) << "the whole picture";
}

}  // namespace
}  // namespace limn::test
