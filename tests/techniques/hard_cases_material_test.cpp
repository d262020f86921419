// Materials at the ends of their ranges, in furnaces of radiance 1 and in rooms.
#include "tests/support/closed_form.hpp"
#include "tests/techniques/hard_cases.hpp"

namespace limn::test {
namespace {

/// A floor seen in parallel rays under a sky of 1, at this cosine from its normal.
Scene floorInFurnace(SceneBuilder& b, uint32_t material, double cosine) {
  floorOf(b, material, 10);
  b.scene.environment.radiance = glm::vec3(1.0f);
  lookParallel(b, {0, cosine, std::sqrt(1 - cosine * cosine)}, {0, 0, 0}, 0.1f);
  return b.scene;
}

HardCase furnace(const std::string& name, const std::string& claim, std::function<Scene()> scene, std::optional<double> radiance) {
  HardCase hard = hardCase(name, claim, std::move(scene), radiance);
  if (!radiance) hard.ceiling = 1.0;
  return hard;
}

Scene whiteDielectric(double cosine) {
  SceneBuilder b;
  Material m;
  m.metallic = 0;
  m.roughness = 0.3f;
  return floorInFurnace(b, b.material(m), cosine);
}

Scene shiningBox() {
  SceneBuilder b;
  const uint32_t walls = b.diffuse(glm::vec3(0.5f));
  b.scene.materials[walls].emission = glm::vec3(0.5f);
  b.box(walls, {-1, -1.5f, -2}, {1, 1.5f, 2});
  b.look({0.2, 0.3, 0.9}, {0, -0.4, -1}, 1.2f);
  return b.scene;
}

Scene roomWithBall(bool present) {
  SceneBuilder b = cornellLike();
  Material nothing;
  nothing.metallic = 0;
  nothing.roughness = 0;
  nothing.transmission = 1;
  nothing.thickness = 1;
  nothing.ior = 1;
  if (present) b.sphere(b.material(nothing), {-0.2f, 0.6f, 0.4f}, 0.25f, 24);
  return b.scene;
}

std::vector<HardCase> furnaces() {
  const auto floor = [](bool metal, float roughness, double cosine) {
    return [=] {
      SceneBuilder b;
      return floorInFurnace(b, metal ? b.metal(glm::vec3(1.0f), roughness) : b.diffuse(glm::vec3(1.0f)), cosine);
    };
  };
  std::vector<HardCase> cases{
      furnace("white diffuse floor", "Sends back all light", floor(false, 1.0f, 0.5), 1.0),
      furnace("white mirror", "Roughness 0, sends back all light", floor(true, 0.0f, 0.5), 1.0),
      furnace("white rough metal", "Directional albedo of single-scattering GGX", floor(true, 0.5f, 0.5), Ggx{0.25}.albedo(0.5)),
      furnace("smooth glass ball", "Absorbs nothing", [] { return generatedScene("furnace-dielectric"); }, 1.0),
      furnace("rough glass ball", "At most 1", [] { return generatedScene("furnace-rough-dielectric"); }, {}),
      furnace("coated white ball", "At most 1", [] { return generatedScene("furnace-clearcoat"); }, {}),
      furnace("white dielectric", "At most 1, seen near the normal", [] { return whiteDielectric(0.95); }, {}),
      furnace("white dielectric, grazing", "At most 1, seen at a cosine of 0.05", [] { return whiteDielectric(0.05); }, {}),
      furnace("closed shining box", "Emission 1/2 and albedo 1/2, five bounces", shiningBox, 1.0 - std::pow(0.5, 6.0))};
  cases[2].rounding = 1e-3;
  for (const size_t i : {3u, 4u}) {  // some light goes to and fro in the glass for longer
    cases[i].bounces = 16;
    cases[i].rounding = 5e-3;
  }
  return cases;
}

std::vector<HardCase> rooms() {
  HardCase smooth;
  smooth.name = "roughness 0";
  smooth.claim = "Two metal blocks as mirrors in the Cornell box";
  smooth.scene = [] { return generatedScene("hard-roughness-0"); };
  smooth.caustics = true;
  smooth.known = {interpolatedCaustics()};
  smooth.known[0].reason += "; the point light's mirror image, which no path finds, lights them too";
  HardCase nearly = smooth;
  nearly.name = "roughness 1e-4";
  nearly.claim = "Looks like roughness 0";
  nearly.scene = [] { return generatedScene("hard-roughness-1e-4"); };
  nearly.twinName = "hard-roughness-0";
  nearly.twin = smooth.scene;
  nearly.known.clear();
  HardCase ball;
  ball.name = "index 1, area light";
  ball.claim = "A ball that neither bends nor reflects is not there";
  ball.scene = [] { return roomWithBall(true); };
  ball.twinName = "room";
  ball.known = {interpolatedCaustics()};
  ball.twin = [] { return roomWithBall(false); };
  HardCase under = ball;
  under.name = "index 1, point light";
  under.scene = [] { return generatedScene("hard-ior-1"); };
  under.twinName = "cornell-point";
  under.twin = [] { return generatedScene("cornell-point"); };
  under.known.clear();
  return {smooth, nearly, ball, under};
}

}  // namespace

std::vector<HardCase> makeHardCases() {
  std::vector<HardCase> cases = furnaces();
  for (HardCase& hard : rooms()) cases.push_back(std::move(hard));
  return cases;
}
const char* hardCaseGroup() { return "2-material"; }

}  // namespace limn::test
