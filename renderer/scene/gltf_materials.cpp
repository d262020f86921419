#include "renderer/scene/gltf_materials.hpp"

#include <algorithm>
#include <limits>

#include "renderer/scene/gltf_textures.hpp"

namespace limn::gltf {
namespace {

constexpr double kLargest = 1e30;  ///< keeps products of factors inside float

/// Reads one material.
class MaterialReader {
 public:
  MaterialReader(Document& document, Textures& textures, const Value& json, size_t index)
      : m_document(document), m_textures(textures), m_json(json), m_label(json.stringOr("name", "")) {
    if (m_label.empty()) m_label = "#" + std::to_string(index);
  }

  Material read() {
    m_material.name = m_json.stringOr("name", "");
    core();
    metallicRoughness();
    extensions();
    return std::move(m_material);
  }

 private:
  float factor(const Value& owner, const char* key, double fallback, double low = 0.0, double high = 1.0) {
    const double v = owner.numberOr(key, fallback);
    return float(clamped(v, low, high));
  }
  double clamped(double v, double low, double high) {
    if (v < low || v > high) m_document.reporter.count("material factors out of their range were clamped", 1);
    return std::clamp(v, low, high);
  }
  template <int N>
  void color(const Value& owner, const char* key, glm::vec<N, float>& out, double high = 1.0) {
    const std::vector<double> values = owner.numbers(key, N);
    for (int i = 0; i < N && !values.empty(); ++i) out[i] = float(clamped(values[size_t(i)], 0.0, high));
  }
  TextureRef texture(const Value& owner, const char* key) { return m_textures.read(owner, key, m_label); }

  void core() {
    color(m_json, "emissiveFactor", m_material.emission, kLargest);
    m_material.emissiveTexture = texture(m_json, "emissiveTexture");
    m_material.normalTexture = texture(m_json, "normalTexture");
    if (const auto normal = m_json.find("normalTexture"))
      m_material.normalScale = factor(*normal, "scale", 1.0, -kLargest, kLargest);
    m_material.doubleSided = m_json.boolOr("doubleSided", false);
    m_material.alphaCutoff = factor(m_json, "alphaCutoff", 0.5, 0.0, kLargest);
    const std::string mode = m_json.stringOr("alphaMode", "OPAQUE");
    if (mode == "MASK") m_material.alphaMode = AlphaMode::mask;
    else if (mode == "BLEND") m_material.alphaMode = AlphaMode::blend;
    else if (mode != "OPAQUE") m_json.need("alphaMode").fail("bad-file", "there is no alpha mode \"" + mode + "\"");
    if (m_json.has("occlusionTexture"))
      m_document.reporter.note("occlusion textures are not used: the light is really transported");
  }

  void metallicRoughness() {
    const auto pbr = m_json.find("pbrMetallicRoughness");
    if (!pbr) return;
    color(*pbr, "baseColorFactor", m_material.baseColor);
    m_material.metallic = factor(*pbr, "metallicFactor", 1.0);
    m_material.roughness = factor(*pbr, "roughnessFactor", 1.0);
    m_material.baseColorTexture = texture(*pbr, "baseColorTexture");
    m_material.metallicRoughnessTexture = texture(*pbr, "metallicRoughnessTexture");
  }

  void emissiveStrength(const Value& e) {
    const float strength = factor(e, "emissiveStrength", 1.0, 0.0, kLargest);
    m_material.emission = glm::min(m_material.emission * strength, glm::vec3(float(kLargest)));
  }
  void ior(const Value& e) {
    const float v = factor(e, "ior", 1.5, 0.0, kLargest);
    m_material.ior = v == 0.0f ? v : float(clamped(v, 1.0, kLargest));
  }
  void transmission(const Value& e) {
    m_material.transmission = factor(e, "transmissionFactor", 0.0);
    m_material.transmissionTexture = texture(e, "transmissionTexture");
  }
  void volume(const Value& e) {
    m_material.thickness = factor(e, "thicknessFactor", 0.0, 0.0, kLargest);
    m_material.attenuationDistance = factor(e, "attenuationDistance", 0.0, 0.0, kLargest);
    color(e, "attenuationColor", m_material.attenuationColor);
    if (e.has("thicknessTexture"))
      m_document.reporter.note("thickness textures are not used: rays measure the real thickness");
  }
  void specular(const Value& e) {
    m_material.specular = factor(e, "specularFactor", 1.0);
    m_material.specularTexture = texture(e, "specularTexture");
    color(e, "specularColorFactor", m_material.specularColor, kLargest);
    m_material.specularColorTexture = texture(e, "specularColorTexture");
  }
  void clearcoat(const Value& e) {
    m_material.clearcoat = factor(e, "clearcoatFactor", 0.0);
    m_material.clearcoatTexture = texture(e, "clearcoatTexture");
    m_material.clearcoatRoughness = factor(e, "clearcoatRoughnessFactor", 0.0);
    m_material.clearcoatRoughnessTexture = texture(e, "clearcoatRoughnessTexture");
    m_material.clearcoatNormalTexture = texture(e, "clearcoatNormalTexture");
    if (const auto normal = e.find("clearcoatNormalTexture")) {
      m_material.clearcoatNormalScale = factor(*normal, "scale", 1.0, -kLargest, kLargest);
    }
  }
  void unlit(const Value&) { m_material.unlit = true; }

  void extensions() {
    using Part = void (MaterialReader::*)(const Value&);
    constexpr std::pair<const char*, Part> kParts[] = {
        {"KHR_materials_emissive_strength", &MaterialReader::emissiveStrength},
        {"KHR_materials_ior", &MaterialReader::ior},
        {"KHR_materials_transmission", &MaterialReader::transmission},
        {"KHR_materials_volume", &MaterialReader::volume},
        {"KHR_materials_specular", &MaterialReader::specular},
        {"KHR_materials_clearcoat", &MaterialReader::clearcoat},
        {"KHR_materials_unlit", &MaterialReader::unlit},
    };
    for (const auto& [name, part] : kParts) {
      if (const auto extension = m_json.extension(name)) (this->*part)(*extension);
    }
  }

  Document& m_document;
  Textures& m_textures;
  const Value m_json;
  std::string m_label;  // for the report
  Material m_material;
};

}  // namespace

void readMaterials(Document& document, Scene& scene) {
  Textures textures(document, scene);
  const Value materials = document.root().list("materials");
  for (size_t i = 0; i < materials.size(); ++i) {
    scene.materials.push_back(MaterialReader(document, textures, materials[i], i).read());
  }
}

}  // namespace limn::gltf
