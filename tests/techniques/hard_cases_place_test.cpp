// Closed boxes, cameras in awkward places, surfaces that touch or lie in each other.
#include "tests/support/closed_form.hpp"
#include "tests/techniques/hard_cases.hpp"

namespace limn::test {
namespace {

SceneBuilder boxAround(float albedo) {
  SceneBuilder b;
  b.box(b.diffuse(glm::vec3(albedo)), {-1, -1, -1}, {1, 1, 1});
  b.look({0.1, 0.2, 0.9}, {0, -0.1, -1}, 1.2f);
  return b;
}
Scene lampInBlackBox() {
  SceneBuilder b = boxAround(0.0f);
  b.pointLight({0.2f, 0.3f, 0.1f}, glm::vec3(1.0f), 3.0f);
  return b.scene;
}
Scene skyOutside() {
  SceneBuilder b = boxAround(0.7f);
  b.scene.environment.radiance = glm::vec3(1.0f);
  return b.scene;
}

Scene eyeInGlass() {
  SceneBuilder b;
  Material glass;
  glass.metallic = 0;
  glass.roughness = 0;
  glass.transmission = 1;
  glass.thickness = 1;
  b.sphere(b.material(glass), {0, 0, 0}, 1, 32);
  b.scene.environment.radiance = glm::vec3(1.0f);
  b.look({0.2, 0.1, 0.3}, {0, 0, -1}, 1.2f);
  return b.scene;
}
/// The eye lies in the wall behind it.
Scene eyeInWall() {
  SceneBuilder b;
  const uint32_t walls = b.diffuse(glm::vec3(0.5f));
  b.scene.materials[walls].emission = glm::vec3(0.5f);
  b.box(walls, {-1, -1, -1}, {1, 1, 1});
  b.look({0.2, 0.1, 1.0}, {0, 0, -1}, 1.2f);
  b.scene.view.lens.znear = 0.0f;
  return b.scene;
}

/// A pillar in a room, of one piece or of two that overlap by `overlap` [m], 0 where they touch.
Scene pillar(std::optional<float> overlap) {
  SceneBuilder b = cornellLike();
  constexpr float kMiddle = -0.5f, kTop = 0.1f;
  const glm::vec3 low(-0.1f, -1.0f, 0.3f), high(0.2f, kTop, 0.6f);
  if (!overlap) {
    b.box(0, low, high);
    return b.scene;
  }
  b.box(0, low, {high.x, kMiddle + 0.5f * *overlap, high.z});
  b.box(0, {low.x, kMiddle - 0.5f * *overlap, low.z}, high);
  return b.scene;
}

}  // namespace

std::vector<HardCase> makeHardCases() {
  std::vector<HardCase> cases{
      hardCase("closed black box", "A lamp inside, and nothing that sends its light on", lampInBlackBox, 0.0),
      hardCase("closed box under a sky", "No light comes in", skyOutside, 0.0),
      hardCase("camera in glass",
               "A glass ball around the eye in a furnace of 1: in a medium, radiance is as the square of its index",
               eyeInGlass, 1.5 * 1.5),
      hardCase("camera in a wall", "The eye in the wall of a shining box, five bounces",
               eyeInWall, 1.0 - std::pow(0.5, 6.0)),
      hardCase("touching bodies", "Two boxes, one on the other, are one", [] { return pillar(0.0f); }),
      hardCase("interpenetrating bodies", "Two boxes, one in the other, are one", [] { return pillar(0.3f); }),
      hardCase("touching glass", "A glass ball on the floor", [] { return generatedScene("hard-touching"); })};
  for (const size_t i : {4u, 5u}) {
    cases[i].twinName = "pillar";
    cases[i].twin = [] { return pillar({}); };
  }
  cases[6].caustics = true;
  cases[6].known = {interpolatedCaustics()};
  return cases;
}

const char* hardCaseGroup() { return "4-place"; }

}  // namespace limn::test
