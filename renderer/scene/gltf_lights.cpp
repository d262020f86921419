#include <algorithm>
#include <cmath>

#include "renderer/scene/gltf_materials.hpp"

namespace limn::gltf {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLargest = 1e30;
constexpr double kSmallest = 1e-30;

LightType lightType(const Value& type) {
  if (type.asString() == "point") return LightType::point;
  if (type.asString() == "spot") return LightType::spot;
  if (type.asString() == "directional") return LightType::directional;
  type.fail("bad-file", "there is no light type \"" + type.asString() + "\"");
}

void readCone(Light& light, const Value& spot) {
  // The double nearest to pi/2 may lie above the file's own pi/2.
  const double outer = spot.numberOr("outerConeAngle", kPi / 4.0, kSmallest, kPi / 2.0 + 1e-6);
  const double inner = spot.numberOr("innerConeAngle", 0.0, 0.0, kPi / 2.0);
  if (inner >= outer) spot.fail("out-of-range", "innerConeAngle must be smaller than outerConeAngle");
  light.outerConeAngle = float(std::min(outer, kPi / 2.0));
  light.innerConeAngle = float(inner);
}

Light readLight(const Value& json) {
  Light light;
  light.name = json.stringOr("name", "");
  light.type = lightType(json.need("type"));
  double intensity = json.numberOr("intensity", 1.0, 0.0, kLargest);
  if (const std::vector<double> color = json.numbers("color", 3); !color.empty()) {
    for (size_t i = 0; i < 3; ++i) json.need("color")[i].asNumber(0.0, kLargest);
    const double peak = std::max({color[0], color[1], color[2], 1.0});
    light.color = {float(color[0] / peak), float(color[1] / peak), float(color[2] / peak)};
    intensity = std::min(intensity * peak, kLargest);
  }
  light.intensity = float(intensity);
  light.range = float(json.numberOr("range", 0.0, 0.0, kLargest));
  if (light.type == LightType::spot) readCone(light, json.need("spot").object());
  return light;
}

Camera readCamera(const Value& json) {
  Camera camera;
  camera.name = json.stringOr("name", "");
  const std::string& type = json.need("type").asString();
  if (type == "perspective") {
    const Value lens = json.need("perspective").object();
    lens.need("yfov");
    camera.yfov = float(lens.numberOr("yfov", 0.8, 1e-4, kPi - 1e-3));
    lens.need("znear");
    camera.znear = float(lens.numberOr("znear", 0.01, kSmallest, kLargest));
    lens.numberOr("zfar", 1.0, kSmallest, kLargest);
    lens.numberOr("aspectRatio", 1.0, kSmallest, kLargest);
  } else if (type == "orthographic") {
    const Value lens = json.need("orthographic").object();
    camera.perspective = false;
    lens.need("ymag");
    camera.ymag = float(std::abs(lens.numberOr("ymag", 1.0, -kLargest, kLargest)));
    if (!(camera.ymag > 0.0f)) lens.need("ymag").fail("out-of-range", "ymag must not be 0");
    camera.znear = float(lens.numberOr("znear", 0.0, 0.0, kLargest));
  } else {
    json.need("type").fail("bad-file", "there is no camera type \"" + type + "\"");
  }
  return camera;
}

}  // namespace

void readLights(const Document& document, Scene& scene) {
  const auto extension = document.root().extension("KHR_lights_punctual");
  if (!extension) return;
  const Value lights = extension->list("lights");
  for (size_t i = 0; i < lights.size(); ++i) scene.lights.push_back(readLight(lights[i].object()));
}

void readCameras(const Document& document, Scene& scene) {
  const Value cameras = document.root().list("cameras");
  for (size_t i = 0; i < cameras.size(); ++i) scene.cameras.push_back(readCamera(cameras[i]));
}

}  // namespace limn::gltf
