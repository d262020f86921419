// What leaves the film: parts that merge, seeds, answers to picks and saves, and no NaN.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/film/exr.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {
namespace {

SessionConfig plainConfig(uint32_t firstSample, uint32_t sampleCount, uint32_t seed = 0) {
  SessionConfig config = smallPicture();
  config.firstSample = firstSample;
  config.sampleCount = sampleCount;
  config.seed = seed;
  config.parameters = {{"adaptive", 0.0}};
  return config;
}

FilmImage rendered(const Scene& scene, const SessionConfig& config) {
  TestSession session(scene, config);
  session.run(1000);
  return session.film();
}

const std::vector<float>& layer(const FilmImage& image, const std::string& name) {
  const FilmLayer* found = image.find(name);
  LIMN_CHECK(found != nullptr);
  return found->data;
}

class FilmParts : public testing::TestWithParam<double> {};  // whether samples come from Sobol points

TEST_P(FilmParts, MergeToTheWhole) {
  const Scene scene = richScene().scene;
  const auto part = [&](uint32_t firstSample, uint32_t sampleCount) {
    SessionConfig config = plainConfig(firstSample, sampleCount);
    config.parameters.emplace_back("sobol", GetParam());
    return rendered(scene, config);
  };
  const FilmImage whole = part(0, 16), first = part(0, 8), second = part(8, 8);
  for (const float n : layer(whole, "samples")) ASSERT_EQ(n, 16.0f);
  for (const float n : layer(second, "samples")) ASSERT_EQ(n, 8.0f);
  for (const char* name : {"beauty", "direct", "albedo", "normal"}) {
    const auto &w = layer(whole, name), &a = layer(first, name), &b = layer(second, name);
    double largest = 0.0, worst = 0.0;
    for (const float v : w) largest = std::max(largest, double(std::abs(v)));
    for (size_t i = 0; i < w.size(); ++i) {
      const double merged = 0.5 * (double(a[i]) + double(b[i]));
      worst = std::max(worst, std::abs(merged - w[i]) / std::max(std::abs(double(w[i])), 0.01 * largest));
    }
    EXPECT_LE(worst, 1e-6) << name;
  }
  EXPECT_NE(layer(first, "beauty"), layer(second, "beauty"));
}
INSTANTIATE_TEST_SUITE_P(, FilmParts, testing::Values(1.0, 0.0),
                         [](const auto& each) { return std::string(each.param != 0.0 ? "OfSobolPoints" : "OfIndependentSamples"); });

TEST(Film, DepthIsMeasuredFromTheEye) {
  for (const bool perspective : {true, false})
    for (const char* technique : {"path-tracing", "point-projection"}) {
      SCOPED_TRACE(std::string(technique) + (perspective ? ", perspective" : ", parallel"));
      SceneBuilder b;
      b.quad(b.diffuse(glm::vec3(0.5f)), {-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
      b.look({0, 0, 5}, {0, 0, 0}, 0.02f);
      b.scene.view.lens.perspective = perspective;
      b.scene.view.lens.ymag = 0.05f;
      b.scene.view.lens.znear = 2.0f;
      SessionConfig config = smallPicture();
      config.technique = technique;
      config.sampleCount = 2;
      const FilmImage film = rendered(b.scene, config);
      for (const float depth : layer(film, "depth")) ASSERT_NEAR(depth, 5.0, 1e-3);
    }
}

TEST(Film, TheSeedAloneDecidesTheBits) {
  const Scene scene = plainScene();
  TestSession a(scene, plainConfig(0, 0, 7)), b(scene, plainConfig(0, 0, 7)), c(scene, plainConfig(0, 0, 8));
  for (const uint32_t passes : {1u, 3u, 5u}) {
    a.run(passes), b.run(passes), c.run(passes);
    EXPECT_EQ(a.hash(), b.hash()) << passes;
    EXPECT_NE(a.hash(), c.hash()) << passes;
  }
}

TEST(Film, ExtremeValuesNeverPutNanIntoThePicture) {
  const RichScene rich = richScene();
  TestSession session(rich.scene, plainConfig(0, 0));
  constexpr float kHuge = std::numeric_limits<float>::max();
  const auto material = [&](auto set) {
    SetMaterial e;
    set(e);
    return Edit(e);
  };
  const std::vector<std::vector<Edit>> extremes = {
      {material([&](auto& e) { e.material = rich.lamp; e.emission = glm::vec3(kHuge); })},
      {Edit(SetEnvironment{glm::vec3(kHuge), 1e30f})},
      {material([&](auto& e) { e.material = rich.glass; e.ior = kHuge; e.attenuationDistance = 1e-38f; e.attenuationColor = glm::vec3(0.0f); })},
      {material([&](auto& e) { e.material = rich.metal; e.specularColor = glm::vec3(kHuge); e.metallic = 0.0f; })},
      {material([&](auto& e) { e.material = rich.floor; e.normalScale = kHuge; e.ior = 0.0f; })},
      {Edit(SetNodeTransform{rich.glassNode, std::nullopt, std::nullopt, glm::dvec3(1e-12, 1e12, 1.0)})},
  };
  for (size_t i = 0; i < extremes.size(); ++i) {
    SCOPED_TRACE("extreme " + std::to_string(i));
    session.edit(extremes[i]);
    session.run(4);
    for (const ErrorReply& error : session.take<ErrorReply>()) ADD_FAILURE() << error.error.text();
    const FilmImage film = session.film();
    for (const FilmLayer& l : film.layers) {
      if (l.name == "error") continue;  // a variance of huge values may overflow; the picture may not
      EXPECT_TRUE(std::all_of(l.data.begin(), l.data.end(), [](float v) { return std::isfinite(v); })) << l.name;
    }
    const Status status = session.status();
    double taken = 0.0;
    for (const float n : layer(film, "samples")) taken += n;
    const double asked = 32.0 * 32.0 * (1 + 1 + 2 + 4);
    EXPECT_LE(taken, asked);
    EXPECT_TRUE(taken == asked || status.discardedSamples > 0) << "samples are missing and nobody says so";
  }
  EXPECT_GT(session.status().discardedSamples, 0u) << "nothing was extreme enough to be thrown away";
}

/// Ray through the centre of a pixel against the triangles of every node, in double precision.
struct CpuHit {
  int32_t node = kNone, material = kNone;
  double distance = std::numeric_limits<double>::infinity();
  glm::dvec3 posW{0.0};
};

CpuHit castRay(const Scene& scene, const glm::dvec3& eye, const glm::dvec3& direction) {
  CpuHit nearest;
  const auto worlds = scene.worldFromNodes();
  for (size_t n = 0; n < scene.nodes.size(); ++n) {
    if (scene.nodes[n].mesh == kNone) continue;
    for (const Primitive& p : scene.meshes[size_t(scene.nodes[n].mesh)].primitives) {
      const auto corner = [&](size_t i) { return glm::dvec3(worlds[n] * glm::dvec4(p.positions[p.indices[i]], 1.0)); };
      for (size_t i = 0; i < p.indices.size(); i += 3) {
        const glm::dvec3 a = corner(i), e1 = corner(i + 1) - a, e2 = corner(i + 2) - a, h = glm::cross(direction, e2);
        const double det = glm::dot(e1, h);
        if (det == 0.0) continue;
        const glm::dvec3 s = eye - a, q = glm::cross(s, e1);
        const double u = glm::dot(s, h) / det, v = glm::dot(direction, q) / det, t = glm::dot(e2, q) / det;
        if (u < 0.0 || v < 0.0 || u + v > 1.0 || t <= 0.0 || t >= nearest.distance) continue;
        nearest = {int32_t(n), p.material, t, eye + direction * t};
      }
    }
  }
  return nearest;
}

glm::dvec3 pixelDirection(const View& view, uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
  const glm::dvec3 forward = glm::normalize(view.target - view.eye), right = glm::normalize(glm::cross(forward, view.up));
  const glm::dvec3 up = glm::cross(right, forward);
  const double half = std::tan(double(view.lens.yfov) * 0.5);
  const double nx = ((x + 0.5) / width * 2.0 - 1.0) * half * width / height, ny = (1.0 - (y + 0.5) / height * 2.0) * half;
  return glm::normalize(forward + right * nx + up * ny);
}

TEST(Film, PicksAgreeWithARayOnTheCpu) {
  const Scene scene = plainScene();
  SessionConfig config = smallPicture(48, 32);
  TestSession session(scene, config);
  int hits = 0, misses = 0;
  for (uint32_t y = 1; y < 32; y += 5)
    for (uint32_t x = 1; x < 48; x += 5) {
      session.ask(PickRequest{{}, x, y});
      session.run(0);
      const auto replies = session.take<PickReply>();
      ASSERT_EQ(replies.size(), 1u);
      const CpuHit expected = castRay(scene, scene.view.eye, pixelDirection(scene.view, x, y, 48, 32));
      SCOPED_TRACE(std::to_string(x) + " " + std::to_string(y));
      ASSERT_EQ(replies[0].node, expected.node);
      (expected.node == kNone ? misses : hits) += 1;
      if (expected.node == kNone) continue;
      EXPECT_EQ(replies[0].material, expected.material);
      EXPECT_NEAR(glm::length(replies[0].posW - expected.posW), 0.0, 1e-4);
      EXPECT_NEAR(replies[0].distance, expected.distance, 1e-3);
      EXPECT_NEAR(glm::length(replies[0].normalW), 1.0f, 1e-5f);
    }
  EXPECT_GT(hits, 20);
  EXPECT_GT(misses, 2);
  session.ask(PickRequest{{}, 48, 0});
  session.run(0);
  EXPECT_EQ(session.take<ErrorReply>().size(), 1u);
}

TEST(Film, SaveGivesAnExrWithAllLayers) {
  TestSession session(plainScene(), plainConfig(0, 0, 3));
  session.run(3);
  session.ask(SaveRequest{});
  session.ask(SaveRequest{{}, {"depth", "beauty"}});
  session.ask(SaveRequest{{}, {"beauty", "aura"}});
  session.run(3);
  const std::vector<Reply> replies = session.takeReplies();
  ASSERT_EQ(replies.size(), 3u);
  const FilmImage film = session.film();
  const FilmImage all = must(decodeExr(*std::get<SaveReply>(replies[0]).exr, "save"));
  for (const char* name : {"beauty", "direct", "indirect", "albedo", "normal", "depth", "samples", "error"}) {
    ASSERT_NE(all.find(name), nullptr) << name;
    EXPECT_EQ(layer(all, name), layer(film, name)) << name;
  }
  const auto has = [&](const std::string& key, const std::string& value) {
    return std::find(all.metadata.begin(), all.metadata.end(), std::make_pair(key, value)) != all.metadata.end();
  };
  EXPECT_TRUE(has("limn:seed", "3"));
  EXPECT_TRUE(has("limn:technique", "path-tracing"));
  EXPECT_TRUE(has("limn:samples", "0:4"));
  EXPECT_EQ(must(decodeExr(*std::get<SaveReply>(replies[1]).exr, "save")).layers.size(), 2u);
  EXPECT_EQ(std::get<ErrorReply>(replies[2]).error.code, "unknown-layer");
}

}  // namespace
}  // namespace limn::test
