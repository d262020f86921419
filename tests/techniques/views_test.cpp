// What of the film is shown: views of one picture, without a sample more.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/film/resolver.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/gather_shared.h"
#include "tests/support/scene_builder.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kSide = 24;
constexpr size_t kPixels = kSide * kSide;
using Rgba = std::vector<uint8_t>;

double linearOf(uint8_t byte) {
  const double c = byte / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// A room where only the lamp itself is too bright for the linear tone map.
Scene dimRoom() {
  SceneBuilder b = cornellLike();
  b.scene.materials[3].emission = glm::vec3(3.0f);
  return b.scene;
}

class Views : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    s_session = std::make_unique<TestSession>(dimRoom(), smallPicture(kSide, kSide));
    s_session->run(3);
  }
  static void TearDownTestSuite() { s_session.reset(); }
  static TestSession& session() { return *s_session; }

  static Rgba shown(ResolveView view, ToneMap map = ToneMap::linear) {
    session().apply({Edit(SetResolve{0.0f, map, view})});
    return must(session()->resolveFrame())->rgba;
  }

 private:
  static inline std::unique_ptr<TestSession> s_session;
};

TEST_F(Views, DirectAndIndirectLightAddUp) {
  const uint64_t hash = session().hash();
  const Rgba beauty = shown(ResolveView::beauty), direct = shown(ResolveView::direct),
             indirect = shown(ResolveView::indirect);
  double directSum = 0.0, indirectSum = 0.0;
  for (size_t i = 0; i < beauty.size(); ++i) {
    if (i % 4 == 3 || beauty[i] == 255) continue;
    // Half a step of a byte in each of the three.
    EXPECT_NEAR(linearOf(direct[i]) + linearOf(indirect[i]), linearOf(beauty[i]), 0.015) << i;
    directSum += linearOf(direct[i]) / double(kPixels);
    indirectSum += linearOf(indirect[i]) / double(kPixels);
  }
  EXPECT_GT(directSum, 0.02);
  EXPECT_GT(indirectSum, 0.02);
  EXPECT_NE(direct, indirect);
  EXPECT_EQ(session().hash(), hash) << "a view changed the film";
}

TEST_F(Views, ShowWhatTheLayersHold) {
  const FilmImage film = session().film();
  const Rgba albedo = shown(ResolveView::albedo), normal = shown(ResolveView::normal), depth = shown(ResolveView::depth),
             samples = shown(ResolveView::samples);
  for (size_t p = 0; p < kPixels; ++p) {
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(linearOf(albedo[4 * p + k]), film.find("albedo")->data[3 * p + k], 0.005);
      EXPECT_NEAR(linearOf(normal[4 * p + k]), film.find("normal")->data[3 * p + k] * 0.5 + 0.5, 0.005);
    }
    const double metres = film.find("depth")->data[p];
    EXPECT_NEAR(linearOf(depth[4 * p]), metres > 0.0 ? 1.0 / (1.0 + metres) : 0.0, 0.005);
    EXPECT_NEAR(linearOf(samples[4 * p]), film.find("samples")->data[p] / 256.0, 0.005);
  }
}

TEST_F(Views, ToneMapsLeaveDataAlone) {
  EXPECT_EQ(shown(ResolveView::normal, ToneMap::linear), shown(ResolveView::normal, ToneMap::agx));
  EXPECT_NE(shown(ResolveView::beauty, ToneMap::linear), shown(ResolveView::beauty, ToneMap::agx));
}

/// Which tint a pixel has, from the half of it that the picture leaves.
bool isGreen(const Rgba& rgba, size_t pixel) { return rgba[4 * pixel + 1] > rgba[4 * pixel]; }

TEST_F(Views, PlacementIsGreenWhereEveryPixelHasItsOwnSamples) {
  const Rgba beauty = shown(ResolveView::beauty), placement = shown(ResolveView::placement);
  for (size_t p = 0; p < kPixels; ++p) {
    const double green = 0.5 * (std::min(1.0, linearOf(beauty[4 * p + 1])) + 0.8);
    EXPECT_NEAR(linearOf(placement[4 * p + 1]), green, 0.006) << p;
  }
}

TEST(Placement, TellsGatheredPixelsFromInterpolatedOnes) {
  const Film film = must(Film::create(device(), kSide, kSide));
  must(gpu::runNow(device(), [&](vk::CommandRecorder& r) { film.recordClear(r); }));
  std::vector<shared::IndirectTexel> texels(kPixels);
  const float states[] = {shared::kIndirectNone, shared::kIndirectInterpolated, shared::kIndirectSampled};
  for (size_t p = 0; p < kPixels; ++p) texels[p].state = states[p % 3];
  vk::BufferDesc desc;
  desc.name = "indirect";
  desc.owner = "test";
  const vk::Buffer indirect = must(vk::createBufferWith(device(), desc, std::span<const shared::IndirectTexel>(texels)));
  Resolver resolver = must(Resolver::create(device(), film));
  const ResolveSettings settings{0.0f, ToneMap::linear, ResolveView::placement};
  const Rgba rgba = must(resolver.resolve(device(), film, settings, 0, &indirect));
  for (size_t p = 0; p < kPixels; ++p) {
    EXPECT_EQ(isGreen(rgba, p), p % 3 == 2) << p;
    EXPECT_EQ(rgba[4 * p] == 0, p % 3 == 0) << p;
  }
}

}  // namespace
}  // namespace limn::test
