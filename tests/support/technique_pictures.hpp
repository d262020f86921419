#pragma once
#include "tests/support/picture_error.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {

using Parameters = std::vector<std::pair<std::string, double>>;

inline SessionConfig pathTracing(uint32_t width, uint32_t height, uint32_t bounces, uint32_t samples) {
  SessionConfig config = smallPicture(width, height);
  config.technique = "path-tracing";
  config.sampleCount = samples;
  config.parameters = {{"adaptive", 0.0}, {"maxBounces", double(bounces)}};
  return config;
}

/// Few points, so that a picture takes a second; `more` comes after the defaults and wins.
inline SessionConfig pointProjection(uint32_t width, uint32_t height, uint32_t bounces, uint32_t samples, Parameters more = {}) {
  SessionConfig config = smallPicture(width, height);
  config.technique = "point-projection";
  config.sampleCount = samples;
  config.parameters = {{"points", 32768.0}, {"clusters", 256.0}, {"bounces", double(bounces)}};
  config.parameters.insert(config.parameters.end(), more.begin(), more.end());
  return config;
}

/// The picture at its end. No sample may be thrown away.
inline FilmImage pictureOf(const Scene& scene, const SessionConfig& config) {
  TestSession session(scene, config);
  const uint64_t before = session.status().discardedSamples;
  session.run(config.sampleCount);
  EXPECT_EQ(session.status().discardedSamples, before);
  return session.film();
}

inline PicturePair pairOf(const Scene& scene, SessionConfig config) {
  PicturePair pair;
  config.firstSample = 1;  // point projection takes sample 0 at the middle of the pixel
  config.seed = 11;
  pair.a = pictureOf(scene, config);
  config.seed = 12;
  pair.b = pictureOf(scene, config);
  return pair;
}

}  // namespace limn::test
