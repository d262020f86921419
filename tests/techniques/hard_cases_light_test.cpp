// Lights that are tiny, many, grazing, in a surface, or broken.
#include <gmock/gmock.h>

#include "tests/support/closed_form.hpp"
#include "tests/techniques/hard_cases.hpp"

namespace limn::test {
namespace {

constexpr double kAlbedo = 0.5;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

/// A grey floor whose origin alone is looked at.
SceneBuilder floorAtOrigin(glm::dvec3 eye = {0.3, 1.0, 0.9}) {
  SceneBuilder b;
  floorOf(b, b.diffuse(glm::vec3(float(kAlbedo))), 5);
  lookParallel(b, eye, {0, 0, 0}, 1e-3f);
  return b;
}

constexpr float kTinyRadius = 1e-3f;
constexpr double kTinyIntensity = 1e6;  // [W/sr]

/// [m²] A convex body shows a quarter of its surface on average. [Cauchy]
double quarterSurface(const Primitive& p) {
  double area = 0.0;
  for (size_t i = 0; i < p.indices.size(); i += 3) {
    const glm::dvec3 a = p.positions[p.indices[i]], b = p.positions[p.indices[i + 1]], c = p.positions[p.indices[i + 2]];
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return area / 4;
}

/// A corner of a room with its lamp out of sight: a shining ball, or the point light that sends as much.
Scene tinyLight(bool ball) {
  SceneBuilder b;
  const uint32_t grey = b.diffuse(glm::vec3(float(kAlbedo)));
  floorOf(b, grey, 2);
  b.quad(grey, {-2, 0, -2}, {2, 0, -2}, {2, 2, -2}, {-2, 2, -2});
  const double radiance = kTinyIntensity / (kPi * kTinyRadius * kTinyRadius);
  const glm::vec3 place(0.3f, 1.0f, 0.2f);
  SceneBuilder shape;
  shape.sphere(0, place, kTinyRadius, 16);
  if (ball) b.sphere(b.emitter(glm::vec3(float(radiance))), place, kTinyRadius, 16);
  else b.pointLight(place, glm::vec3(1.0f), float(radiance * quarterSurface(shape.scene.meshes[0].primitives[0])));
  lookParallel(b, {0, 3, 1}, {0, 0, -1.2}, 0.7f);
  return b.scene;
}

constexpr int kManyLights = 10000;

glm::vec3 placeOf(int light) {
  return {float(light % 100) * 0.04f - 2.0f, 1.0f + float(light % 7) * 0.1f, float(light / 100) * 0.04f - 2.0f};
}
double lambert(const glm::vec3& light, double intensity) {
  return kAlbedo / kPi * intensity * light.y / std::pow(double(glm::length(light)), 3);
}

/// One strong light above the origin among weak ones.
Scene oneStrongLight() {
  SceneBuilder b = floorAtOrigin();
  b.pointLight({0, 1, 0}, glm::vec3(1.0f), 1.0f);
  for (int i = 1; i < kManyLights; ++i) b.pointLight(placeOf(i), glm::vec3(1.0f), 1e-6f);
  return b.scene;
}
double oneStrongRadiance() {
  double sum = lambert({0, 1, 0}, 1.0);
  for (int i = 1; i < kManyLights; ++i) sum += lambert(placeOf(i), 1e-6);
  return sum;
}

/// One light above the origin, all others as strong and shut in a black box.
Scene oneOpenLight() {
  SceneBuilder b = floorAtOrigin();
  b.pointLight({0, 1, 0}, glm::vec3(1.0f), 1.0f);
  b.box(b.diffuse(glm::vec3(0.0f)), {7, 0.5f, -3}, {13, 3, 3});
  for (int i = 1; i < kManyLights; ++i) b.pointLight(placeOf(i) + glm::vec3(10, 0, 0), glm::vec3(1.0f), 1.0f);
  return b.scene;
}

Image skyOf(uint32_t width, uint32_t height, float radiance) {
  Image image;
  image.width = width;
  image.height = height;
  image.rgbaF.assign(size_t(width) * height * 4, radiance);
  return image;
}
Scene floorUnder(Image image) {
  SceneBuilder b = floorAtOrigin();
  b.scene.environment.image = std::make_shared<const Image>(std::move(image));
  b.scene.environment.radiance = glm::vec3(1.0f);
  return b.scene;
}

constexpr uint32_t kSkyWidth = 64, kSkyHeight = 32, kHotColumn = 20, kHotRow = 9;
constexpr float kSky = 0.01f, kHot = 1e6f;

Scene hotTexel() {
  Image image = skyOf(kSkyWidth, kSkyHeight, kSky);
  for (size_t k = 0; k < 3; ++k) image.rgbaF[(size_t(kHotRow) * kSkyWidth + kHotColumn) * 4 + k] = kHot;
  return floorUnder(image);
}
/// The bilinear filter makes a tent of the texel, two texels wide.
double hotTexelRadiance() {
  const double tent = quadrature(1000, [](double u, double v) {
    const double x = 2 * u - 1, y = 2 * v - 1, theta = (kHotRow + 0.5 + y) / kSkyHeight * kPi;
    return 4 * (1 - std::abs(x)) * (1 - std::abs(y)) * std::cos(theta) * std::sin(theta);
  });
  const double texel = 2 * kPi / kSkyWidth * kPi / kSkyHeight;
  return kAlbedo / kPi * (kPi * double(kSky) + double(kHot - kSky) * tent * texel);
}

/// A sky with values that are not finite or negative, or with 0 in their place.
Scene brokenSky(bool broken) {
  Image image = skyOf(kSkyWidth, kSkyHeight, 1.0f);
  const float values[] = {kNan, kInfinity, -kInfinity, -1.0f};
  for (size_t i = 0; i < image.rgbaF.size(); i += 4 * 7)
    for (size_t k = 0; k < 3; ++k) image.rgbaF[i + k] = broken ? values[i / (4 * 7) % 4] : 0.0f;
  return floorUnder(image);
}

Scene grazingLight() {
  SceneBuilder b = floorAtOrigin();
  b.directionalLight({-1, -1e-3f, 0}, glm::vec3(1.0f), 1000.0f);
  return b.scene;
}
Scene grazingView() {
  SceneBuilder b = floorAtOrigin({0, 1e-3, 1});
  b.directionalLight({0, -1, 0}, glm::vec3(1.0f), 2.0f);
  return b.scene;
}
/// A wall lit by a point exactly in the plane of a black floor.
Scene lightInFloor() {
  SceneBuilder b;
  floorOf(b, b.diffuse(glm::vec3(0.0f)), 2);
  b.quad(b.diffuse(glm::vec3(float(kAlbedo))), {-2, 0, -1}, {2, 0, -1}, {2, 2, -1}, {-2, 2, -1});
  b.pointLight({0, 0, 0}, glm::vec3(1.0f), 4.0f);
  lookParallel(b, {0, 1, 0.5}, {0, 1, -1}, 1e-3f);
  return b.scene;
}

/// A room open to the right, where a tinted pane may stand before the sun.
Scene roomInTheSun(bool pane) {
  constexpr float kTint = 0.4f;
  SceneBuilder b;
  const uint32_t grey = b.diffuse(glm::vec3(0.6f)), red = b.diffuse({0.6f, 0.2f, 0.2f});
  b.quad(grey, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
  b.quad(grey, {-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1});
  b.quad(grey, {-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1});
  b.quad(red, {-1, 0, 1}, {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1});
  b.box(grey, {-0.6f, 0, -0.6f}, {0, 0.6f, 0});
  Material glass;
  glass.metallic = glass.roughness = 0;
  glass.transmission = glass.ior = 1;
  glass.baseColor = glm::vec4(glm::vec3(kTint), 1.0f);
  if (pane) b.quad(b.material(glass), {1, 0, 1}, {1, 0, -1}, {1, 2, -1}, {1, 2, 1});
  b.directionalLight({-1, -0.7f, 0}, glm::vec3(1.0f), pane ? 5.0f : 5.0f * kTint);
  b.look({0, 1, 4.5}, {0, 1, 0}, 0.6f);
  return b.scene;
}

TEST(BrokenSky, ValuesThatAreCleanedAreCounted) {
  TestSession session(brokenSky(true), smallPicture());
  session.ask(DescribeRequest{});
  session.run(0);
  const auto replies = session.take<DescribeReply>();
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_THAT(replies[0].scene->report.notes, testing::Contains(testing::HasSubstr("879 values of the environment")));
}

}  // namespace

std::vector<HardCase> makeHardCases() {
  std::vector<HardCase> cases{
      hardCase("1e6 W/sr in a 1e-3 sphere", "Lights like the point light of its mean intensity",
               [] { return tinyLight(true); }),
      hardCase("10,000 lights, one strong", "The others send a millionth each", oneStrongLight, oneStrongRadiance()),
      hardCase("10,000 lights, one open", "The others are as strong, and shut in a box",
               oneOpenLight, lambert({0, 1, 0}, 1.0)),
      hardCase("HDR sky with a hot texel", "1e6 in a sky of 0.01", hotTexel, hotTexelRadiance()),
      hardCase("HDR sky with NaN and infinity", "Such texels are 0", [] { return brokenSky(true); }),
      hardCase("grazing light", "A sun at a cosine of 1e-3", grazingLight, kAlbedo / kPi * 1000.0 * 1e-3),
      hardCase("grazing view", "Seen at a cosine of 1e-3", grazingView, kAlbedo / kPi * 2.0),
      hardCase("light in a surface", "Exactly in the plane of the floor",
               lightInFloor, kAlbedo / kPi * 4.0 / std::pow(2.0, 1.5)),
      hardCase("sun through a pane", "As a dimmer sun through an opening", [] { return roomInTheSun(true); })};
  cases[0].twinName = "point";
  cases[0].twin = [] { return tinyLight(false); };
  cases[0].rounding = 2e-3;  // the ball has 16 sides
  cases[8].twinName = "opening";
  cases[8].twin = [] { return roomInTheSun(false); };
  cases[4].twinName = "sky with zeros";
  cases[4].twin = [] { return brokenSky(false); };
  for (const size_t i : {1u, 3u, 7u}) cases[i].rounding = 1e-3;
  return cases;
}

const char* hardCaseGroup() { return "3-light"; }

}  // namespace limn::test
