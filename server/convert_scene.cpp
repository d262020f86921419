#include "server/convert.hpp"

#include <algorithm>

#include <glm/gtc/type_ptr.hpp>

#include "server/convert_values.hpp"

namespace limn::server {
namespace {

std::vector<std::string> textureNames(const Material& m) {
  const std::pair<const TextureRef&, const char*> slots[] = {
      {m.baseColorTexture, "baseColor"}, {m.metallicRoughnessTexture, "metallicRoughness"}, {m.normalTexture, "normal"},
      {m.emissiveTexture, "emission"}, {m.transmissionTexture, "transmission"}, {m.specularTexture, "specular"},
      {m.specularColorTexture, "specularColor"}, {m.clearcoatTexture, "clearcoat"},
      {m.clearcoatRoughnessTexture, "clearcoatRoughness"}, {m.clearcoatNormalTexture, "clearcoatNormal"}};
  std::vector<std::string> names;
  for (const auto& [texture, name] : slots)
    if (texture.present()) names.emplace_back(name);
  return names;
}

protocol::Material toWire(const Material& m) {
  protocol::Material wire;
  wire.name = m.name;
  wire.baseColor = array(m.baseColor);
  wire.metallic = m.metallic;
  wire.roughness = m.roughness;
  wire.emission = array(m.emission);
  wire.ior = m.ior;
  wire.transmission = m.transmission;
  wire.thickness = m.thickness;
  wire.attenuationDistance = m.attenuationDistance;
  wire.attenuationColor = array(m.attenuationColor);
  wire.specular = m.specular;
  wire.specularColor = array(m.specularColor);
  wire.clearcoat = m.clearcoat;
  wire.clearcoatRoughness = m.clearcoatRoughness;
  wire.normalScale = m.normalScale;
  wire.alphaCutoff = m.alphaCutoff;
  wire.alphaMode = same<protocol::AlphaMode>(m.alphaMode);
  wire.doubleSided = m.doubleSided;
  wire.unlit = m.unlit;
  wire.textures = textureNames(m);
  return wire;
}

protocol::Light toWire(const Light& light) {
  protocol::Light wire;
  wire.name = light.name;
  wire.type = same<protocol::LightType>(light.type);
  wire.color = array(light.color);
  wire.intensity = light.intensity;
  wire.range = light.range;
  wire.innerConeAngle = light.innerConeAngle;
  wire.outerConeAngle = light.outerConeAngle;
  return wire;
}

protocol::SceneNode toWire(const Node& node) {
  protocol::SceneNode wire;
  wire.name = node.name;
  wire.parent = index(node.parent);
  const Transform& t = node.parentFromLocal;
  wire.translation = array(t.translation);
  wire.rotation = {t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w};
  wire.scale = array(t.scale);
  if (t.matrix) {
    std::array<double, 16>& out = wire.matrix.emplace();
    std::copy_n(glm::value_ptr(*t.matrix), out.size(), out.begin());
  }
  wire.mesh = index(node.mesh);
  wire.camera = index(node.camera);
  wire.light = index(node.light);
  return wire;
}

protocol::LoadReport toWire(const LoadReport& report) {
  protocol::LoadReport wire;
  for (const LoadReport::Item& item : report.unsupported)
    wire.unsupported.push_back({item.feature, item.materials, item.note});
  wire.notes = report.notes;
  wire.triangles = report.triangles;
  wire.degenerateTriangles = report.degenerateTriangles;
  wire.vertices = report.vertices;
  wire.imageBytes = report.imageBytes;
  return wire;
}

}  // namespace

protocol::SceneMessage toWire(const SceneSummary& scene, protocol::SceneCause cause) {
  protocol::SceneMessage wire;
  wire.cause = cause;
  wire.name = scene.name;
  wire.hash.value = scene.hash;
  wire.sceneRevision = scene.sceneRevision;
  wire.viewRevision = scene.viewRevision;
  for (const Material& material : scene.materials) wire.materials.push_back(toWire(material));
  for (const Light& light : scene.lights) wire.lights.push_back(toWire(light));
  for (const Node& node : scene.nodes) wire.nodes.push_back(toWire(node));
  wire.meshes = scene.meshNames;
  for (const Camera& c : scene.cameras) wire.cameras.push_back({c.name, c.perspective, c.yfov, c.ymag, c.znear});
  const Image* sky = scene.environment.image.get();
  wire.environment = {array(scene.environment.radiance), scene.environment.rotation, sky != nullptr,
                      sky ? sky->name : ""};
  wire.view = toWire(scene.view);
  wire.resolve = {scene.resolve.exposure, same<protocol::ToneMap>(scene.resolve.toneMap),
                  same<protocol::ResolveView>(scene.resolve.view)};
  wire.technique = scene.technique;
  wire.parameters = scene.parameters;
  wire.width = scene.width;
  wire.height = scene.height;
  wire.boundsLow = array(scene.bounds.low);
  wire.boundsHigh = array(scene.bounds.high);
  wire.report = toWire(scene.report);
  return wire;
}

}  // namespace limn::server
