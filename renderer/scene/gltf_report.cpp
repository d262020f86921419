#include <algorithm>
#include <functional>
#include <set>

#include "renderer/scene/gltf_document.hpp"

namespace limn::gltf {
namespace {

constexpr std::string_view kSupported[] = {
    "KHR_texture_transform", "KHR_materials_emissive_strength", "KHR_materials_ior",       "KHR_materials_transmission",
    "KHR_materials_volume",  "KHR_materials_specular",          "KHR_materials_clearcoat", "KHR_materials_unlit",
    "KHR_lights_punctual",   "KHR_mesh_quantization",           "EXT_mesh_gpu_instancing",
};

const char* noteOf(const std::string& extension) {
  if (extension == "KHR_materials_variants") return "the default materials are shown";
  if (extension == "KHR_materials_pbrSpecularGlossiness") return "the metallic-roughness factors are used instead";
  if (extension == "KHR_texture_basisu" || extension == "EXT_texture_webp")
    return "the PNG or JPEG beside it is used, if there is one";
  if (extension == "KHR_animation_pointer") return "animations are not played";
  if (extension.starts_with("KHR_materials_")) return "the material is shown without it";
  return "it is ignored";
}

/// Names of extensions of `value` and of everything in it.
void collectExtensions(const nlohmann::json& value, std::set<std::string>& names) {
  if (!value.is_structured()) return;
  for (const auto& [key, member] : value.items()) {
    if (key == "extras") continue;
    if (key == "extensions" && value.is_object() && member.is_object()) {
      for (const auto& [name, unused] : member.items()) names.insert(name);
    }
    collectExtensions(member, names);
  }
}

std::string materialName(const Value& material, size_t index) {
  const std::string name = material.stringOr("name", "");
  return name.empty() ? "#" + std::to_string(index) : name;
}

/// Extensions used by a texture count as the materials' that sample it.
void addTextureExtensions(const nlohmann::json& value, const Value& textures, std::set<std::string>& names) {
  if (!value.is_structured()) return;
  for (const auto& [key, member] : value.items()) {
    const bool isReference = key == "index" && member.is_number_unsigned() && member.get<uint64_t>() < textures.size();
    if (isReference) collectExtensions(textures.json()[member.get<size_t>()], names);
    else addTextureExtensions(member, textures, names);
  }
}

}  // namespace

bool supportsExtension(std::string_view name) {
  return std::find(std::begin(kSupported), std::end(kSupported), name) != std::end(kSupported);
}

void reportUnsupported(Document& document) {
  const Value root = document.root();
  std::set<std::string> met;
  const Value materials = root.list("materials");
  for (size_t i = 0; i < materials.size(); ++i) {
    std::set<std::string> names;
    collectExtensions(materials[i].json(), names);
    addTextureExtensions(materials[i].json(), root.list("textures"), names);
    for (const std::string& name : names) {
      if (!supportsExtension(name)) document.reporter.unsupported(name, noteOf(name), materialName(materials[i], i));
      met.insert(name);
    }
  }
  std::set<std::string> elsewhere;
  for (const auto& [key, member] : root.json().items()) {
    if (key != "materials" && key != "textures" && key != "extras") collectExtensions(member, elsewhere);
    if (key == "extensions" && member.is_object()) {
      for (const auto& [name, unused] : member.items()) elsewhere.insert(name);
    }
  }
  const Value used = root.list("extensionsUsed");
  for (size_t i = 0; i < used.size(); ++i) elsewhere.insert(used[i].asString());
  for (const std::string& name : elsewhere) {
    if (!supportsExtension(name) && !met.contains(name)) document.reporter.unsupported(name, noteOf(name));
  }
  if (root.list("animations").size() > 0)
    document.reporter.unsupported("animations", "the scene is shown at rest, as its nodes are stored");
}

void Reporter::unsupported(const std::string& feature, const std::string& note, const std::string& material) {
  const auto same = [&](const LoadReport::Item& item) { return item.feature == feature; };
  auto item = std::find_if(m_report.unsupported.begin(), m_report.unsupported.end(), same);
  if (item == m_report.unsupported.end()) item = m_report.unsupported.insert(item, {feature, {}, note});
  const bool listed = std::find(item->materials.begin(), item->materials.end(), material) != item->materials.end();
  if (!material.empty() && !listed) item->materials.push_back(material);
}

void Reporter::note(const std::string& text) {
  if (std::find(m_report.notes.begin(), m_report.notes.end(), text) == m_report.notes.end())
    m_report.notes.push_back(text);
}

void Reporter::count(const std::string& text, uint64_t howMany) {
  if (howMany > 0) m_counts[text] += howMany;
}

LoadReport Reporter::take() {
  for (const auto& [text, howMany] : m_counts) m_report.notes.push_back(std::to_string(howMany) + " " + text);
  m_counts.clear();
  return std::move(m_report);
}

void Document::spend(uint64_t items, const std::string& pointer) {
  work += items;
  if (work > limits.maxVertices) fail("limit", "morph targets and skins ask for too much work", pointer);
}

size_t Document::count(const char* list) const { return root().list(list).size(); }

}  // namespace limn::gltf
