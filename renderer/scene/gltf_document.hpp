#pragma once
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "renderer/scene/gltf_container.hpp"
#include "renderer/scene/gltf_json.hpp"
#include "renderer/scene/gltf_loader.hpp"
#include "renderer/scene/gltf_tiny.hpp"

namespace limn::gltf {

/// Gathers the report; the same feature met twice is one item, the same note one line.
class Reporter {
 public:
  void unsupported(const std::string& feature, const std::string& note, const std::string& material = "");
  void note(const std::string& text);
  /// "3 zero or broken normals were replaced", once for the whole file.
  void count(const std::string& text, uint64_t howMany);
  LoadReport& report() { return m_report; }
  /// Writes the counted lines and gives the report away.
  LoadReport take();

 private:
  LoadReport m_report;
  std::map<std::string, uint64_t> m_counts;
};

/// A glTF file on its way to a Scene. The stages below run in this order; each throws Fault.
struct Document {
  Container container;
  LoadLimits limits;
  nlohmann::json json;    ///< all of the document; materials, lights, cameras and extensions are read from here
  tinygltf::Model model;  ///< buffers, accessors, meshes, nodes, skins and scenes, after checkStructure
  Reporter reporter;
  uint64_t work = 0;  ///< morphed vertices and placed joints so far

  /// Counts work that a small file can ask for many times over. Throws Fault limit at `pointer`.
  void spend(uint64_t items, const std::string& pointer);
  Value root() const { return Value(json); }
  size_t count(const char* list) const;  ///< elements of a top-level list, 0 when absent
};

/// Version, required extensions, and every number by which buffers, views and accessors reach into each other.
void checkStructure(const Document& document);
void checkBuffers(const Document& document);
/// Primitives' attributes, skins, and the node graph: one parent each, no cycles, depth no matter.
void checkGraph(const Document& document);
/// Hands the checked geometry part to tinygltf; buffers are read here, through the asset root.
void parseModel(Document& document);

/// The extensions that the loader understands.
bool supportsExtension(std::string_view name);
/// Lists in the report what the file uses and the loader does not.
void reportUnsupported(Document& document);

}  // namespace limn::gltf
