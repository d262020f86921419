#include "renderer/session/session.hpp"

#include "tests/analytic/analytic.hpp"

namespace limn::test {
namespace {

/// The whole loop, with the variant that is cut to the scene's needs, instead of the technique alone.
FilmImage renderBySession(const SceneBuilder& builder, double adaptive) {
  SessionConfig config;
  config.width = config.height = 16;
  config.sampleCount = 64;
  config.parameters = {{"adaptive", adaptive}};
  Mailbox mailbox;
  FrameSlot frames;
  StatusQueue replies;
  auto session = must(Session::create(SharedDevice::get(), builder.scene, {}, config, mailbox, frames, replies));
  must(session->runSteps(1u << 20));
  EXPECT_EQ(must(session->status()).discardedSamples, 0u);
  return must(session->readFilm());
}

SceneBuilder furnace(float albedo) {
  SceneBuilder b;
  floorOf(b, b.diffuse(glm::vec3(albedo)), 10);
  b.scene.environment.radiance = glm::vec3(1.0f);
  b.look({0, 3, 3}, {0, 0, 0}, 0.7f);
  return b;
}

TEST(SessionFurnace, ShowsTheAlbedo) {
  expectMean(renderBySession(furnace(1.0f), 0), 1.0, 2e-3);
  expectMean(renderBySession(furnace(0.5f), 0), 0.5, 2e-3);
}

/// Stopping pixels early must not favour those that happen to be bright or dark.
TEST(SessionFurnace, AdaptiveSamplingKeepsTheMean) { expectMean(renderBySession(furnace(0.5f), 1), 0.5, 5e-3); }

}  // namespace
}  // namespace limn::test
