#include "server/limn/info_text.hpp"

#include <cstdio>
#include <utility>

#include "renderer/scene/scene_estimate.hpp"
#include "renderer/scene/scene_needs.hpp"
#include "renderer/session/session_memory.hpp"
#include "renderer/techniques/technique_info.hpp"
#include "server/limn/hex_text.hpp"

namespace limn {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

template <class Vector>
std::string vectorText(const Vector& v) {
  std::string text;
  for (int i = 0; i < v.length(); ++i) text.append(i == 0 ? "(" : ", ").append(number(double(v[i])));
  return text + ")";
}

std::string nameOf(const std::string& name, size_t index) {
  return "  " + std::to_string(index) + " " + (name.empty() ? "(no name)" : name) + ": ";
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : ", ").append(word);
  return text;
}

std::string texturesOf(const Material& material) {
  const std::pair<const TextureRef*, const char*> slots[] = {
      {&material.baseColorTexture, "base colour"},      {&material.metallicRoughnessTexture, "metallic-roughness"},
      {&material.normalTexture, "normal"},              {&material.emissiveTexture, "emission"},
      {&material.transmissionTexture, "transmission"},  {&material.specularTexture, "specular"},
      {&material.specularColorTexture, "specular colour"}, {&material.clearcoatTexture, "clearcoat"},
      {&material.clearcoatRoughnessTexture, "clearcoat roughness"},
      {&material.clearcoatNormalTexture, "clearcoat normal"}};
  std::vector<std::string> used;
  for (const auto& [slot, name] : slots)
    if (slot->present()) used.emplace_back(name);
  return used.empty() ? "" : ", textures: " + joined(used);
}

std::string materialText(const Material& m) {
  std::string text = "base colour " + vectorText(m.baseColor) + ", metallic " + number(m.metallic) + ", roughness " +
                     number(m.roughness);
  if (m.emission != glm::vec3(0.0f)) text += ", emission " + vectorText(m.emission) + " W/(sr m2)";
  if (m.transmission > 0.0f) text += ", transmission " + number(m.transmission) + ", ior " + number(m.ior);
  if (m.thickness > 0.0f) text += ", volume";
  if (m.clearcoat > 0.0f) text += ", clearcoat " + number(m.clearcoat);
  if (m.alphaMode == AlphaMode::mask) text += ", alpha mask at " + number(m.alphaCutoff);
  if (m.alphaMode == AlphaMode::blend) text += ", alpha blend";
  if (m.doubleSided) text += ", double-sided";
  if (m.unlit) text += ", unlit";
  return text + texturesOf(m);
}

std::string lightText(const Light& light) {
  const bool directional = light.type == LightType::directional, spot = light.type == LightType::spot;
  const std::string type = directional ? "directional" : spot ? "spot" : "point";
  return type + ", " + number(light.intensity) + (directional ? " W/m2" : " W/sr") + ", colour " +
         vectorText(light.color) + (spot ? ", cone " + number(light.outerConeAngle) + " rad" : "");
}

std::string cameraText(const Camera& camera) {
  return camera.perspective ? "perspective, yfov " + number(camera.yfov) + " rad"
                            : "orthographic, half height " + number(camera.ymag) + " m";
}

std::string imageText(const Image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height) +
         (image.rgbaF.empty() ? ", 8-bit" : ", float");
}

/// A heading with the count, then one line an item.
template <class Item>
std::string listText(const std::string& heading, const std::vector<Item>& items, std::string (*describe)(const Item&)) {
  std::string text = heading + ": " + std::to_string(items.size()) + "\n";
  for (size_t i = 0; i < items.size(); ++i) text += nameOf(items[i].name, i) + describe(items[i]) + "\n";
  return text;
}

std::string geometryText(const Scene& scene, const LoadReport& report) {
  const Bounds bounds = worldBounds(scene);
  return "triangles: " + std::to_string(report.triangles) + " (" + std::to_string(report.degenerateTriangles) +
         " without area), vertices: " + std::to_string(report.vertices) +
         ", meshes: " + std::to_string(scene.meshes.size()) + ", nodes: " + std::to_string(scene.nodes.size()) +
         "\nbounds: " + vectorText(bounds.low) + " to " + vectorText(bounds.high) + " m\n";
}

std::string environmentText(const Scene& scene) {
  const Environment& environment = scene.environment;
  if (!environment.image && environment.radiance == glm::vec3(0.0f)) return "environment: none\n";
  const std::string image = environment.image ? "image \"" + environment.image->name + "\" times " : "constant ";
  return "environment: " + image +
         vectorText(environment.radiance) + " W/(sr m2)\n";
}

std::string mebibytes(uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%10.2f MiB\n", double(bytes) / double(1u << 20));
  return text;
}

/// A line an owner and one for all of them.
std::string memoryTable(const std::string& where, const vk::MemoryUse& memory) {
  const auto line = [](std::string name, uint64_t bytes) {
    name.resize(20, ' ');
    return "  " + name + mebibytes(bytes);
  };
  std::string text;
  for (const auto& [owner, bytes] : memory.byOwner()) text += line(owner, bytes);
  return text + line(where + " in all", memory.totalBytes());
}

std::string costText(const Scene& scene, const SessionConfig& config) {
  const gpu::MemoryPrediction memory = predictMemory(scene, config);
  const std::string& technique = config.technique.empty() ? techniqueInfos().front().name : config.technique;
  return "cost: " + std::to_string(instancedTriangles(scene)) + " triangles over all nodes; memory for " + technique +
         " at " + std::to_string(config.width) + "x" + std::to_string(config.height) + " pixels:\n" +
         memoryTable("device", memory.device) + memoryTable("host", memory.host);
}

std::string reportText(const LoadReport& report) {
  std::string text = report.unsupported.empty() ? "not supported: nothing of this file\n" : "not supported:\n";
  for (const LoadReport::Item& item : report.unsupported)
    text += "  " + item.feature + (item.materials.empty() ? "" : " (" + joined(item.materials) + ")") + ": " +
            item.note + "\n";
  for (const std::string& note : report.notes) text += "note: " + note + "\n";
  return text;
}

}  // namespace

std::string infoText(const LoadedScene& loaded, const SessionConfig& config) {
  const Scene& scene = loaded.scene;
  const std::vector<std::string> needs = describe(sceneNeeds(scene));
  return scene.name + ", hash " + hexText(scene.hash()) + "\n" + geometryText(scene, loaded.report) +
         listText("materials", scene.materials, materialText) + listText("images", scene.images, imageText) +
         listText("lights", scene.lights, lightText) + listText("cameras", scene.cameras, cameraText) +
         environmentText(scene) + "needs: " + (needs.empty() ? "nothing special" : joined(needs)) + "\n" +
         reportText(loaded.report) + costText(scene, config);
}

}  // namespace limn
