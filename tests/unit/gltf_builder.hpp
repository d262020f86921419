#pragma once
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "renderer/scene/gltf_loader.hpp"

namespace limn::test {

/// A folder of its own for one test, removed in the end.
class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "limn-test-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    m_path = pattern;
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  ~TempFolder() { std::filesystem::remove_all(m_path); }

  const std::filesystem::path& path() const { return m_path; }
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path file = m_path / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    return file;
  }

 private:
  std::filesystem::path m_path;
};

inline void putWord(std::string& out, uint32_t v) { out.append(reinterpret_cast<const char*>(&v), 4); }

/// A glTF file in the making: the document is open to the test, the binary chunk grows with each accessor.
struct GltfBuilder {
  nlohmann::json doc = {{"asset", {{"version", "2.0"}}}};
  std::string binary;

  template <class T>
  int view(const std::vector<T>& data, int stride = 0) {
    while (binary.size() % 4 != 0) binary += '\0';
    nlohmann::json entry = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", data.size() * sizeof(T)}};
    if (stride > 0) entry["byteStride"] = stride;
    binary.append(reinterpret_cast<const char*>(data.data()), data.size() * sizeof(T));
    return push("bufferViews", entry);
  }

  template <class T>
  static constexpr int componentType() {
    if constexpr (std::is_same_v<T, int8_t>) return 5120;
    else if constexpr (std::is_same_v<T, uint8_t>) return 5121;
    else if constexpr (std::is_same_v<T, int16_t>) return 5122;
    else if constexpr (std::is_same_v<T, uint16_t>) return 5123;
    else if constexpr (std::is_same_v<T, uint32_t>) return 5125;
    else return 5126;
  }

  /// A tightly packed accessor of `components` values an element.
  template <class T>
  int accessor(const std::vector<T>& data, int components, bool normalized = false) {
    const char* const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    nlohmann::json entry = {{"bufferView", view(data)},
                            {"componentType", componentType<T>()},
                            {"count", data.size() / size_t(components)},
                            {"type", components == 16 ? "MAT4" : types[components]}};
    if (normalized) entry["normalized"] = true;
    return push("accessors", entry);
  }

  int push(const char* list, nlohmann::json entry) {
    doc[list].push_back(std::move(entry));
    return int(doc[list].size()) - 1;
  }

  /// A mesh of one primitive and a root node that carries it; gives the primitive.
  nlohmann::json& show(const nlohmann::json& attributes, int indices = -1) {
    nlohmann::json primitive = {{"attributes", attributes}};
    if (indices >= 0) primitive["indices"] = indices;
    const int mesh = push("meshes", {{"primitives", {primitive}}});
    root({{"mesh", mesh}});
    return doc["meshes"][size_t(mesh)]["primitives"][0];
  }

  int root(const nlohmann::json& node) {
    const int index = push("nodes", node);
    if (!doc.contains("scenes")) doc["scenes"] = {{{"nodes", nlohmann::json::array()}}};
    doc["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  /// The square [0,1]² in the xy plane, facing +z, two triangles, texture coordinates with v downwards.
  nlohmann::json& square(bool normals = true, bool uvs = true) {
    nlohmann::json attributes = {{"POSITION", accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3)}};
    if (normals) attributes["NORMAL"] = accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    if (uvs) attributes["TEXCOORD_0"] = accessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, 2);
    return show(attributes, accessor<uint16_t>({0, 1, 2, 0, 2, 3}, 1));
  }

  std::string glb() const {
    nlohmann::json whole = doc;
    if (!binary.empty() && !whole.contains("buffers")) whole["buffers"] = {{{"byteLength", binary.size()}}};
    std::string json = whole.dump();
    while (json.size() % 4 != 0) json += ' ';
    std::string bin = binary;
    while (bin.size() % 4 != 0) bin += '\0';
    std::string out = "glTF";
    putWord(out, 2);
    putWord(out, uint32_t(20 + json.size() + (bin.empty() ? 0 : 8 + bin.size())));
    putWord(out, uint32_t(json.size()));
    out += "JSON" + json;
    if (bin.empty()) return out;
    putWord(out, uint32_t(bin.size()));
    out += std::string("BIN\0", 4) + bin;
    return out;
  }

  Result<LoadedScene> load(const LoadOptions& options = {}) const {
    const TempFolder folder;
    return loadGltf(folder.write("test.glb", glb()), options);
  }

  /// Loads what must load.
  LoadedScene mustLoad(const LoadOptions& options = {}) const {
    Result<LoadedScene> loaded = load(options);
    if (!loaded) ADD_FAILURE() << loaded.error().code << " " << loaded.error().text();
    return loaded ? loaded.take() : LoadedScene{};
  }

  /// "code place" of the error that must come.
  std::string refusal(const LoadOptions& options = {}) const {
    const Result<LoadedScene> loaded = load(options);
    return loaded ? "loaded" : loaded.error().code + " " + loaded.error().place;
  }
};

inline bool hasNote(const LoadReport& report, const std::string& part) {
  for (const std::string& note : report.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

inline const LoadReport::Item* unsupportedItem(const LoadReport& report, const std::string& feature) {
  for (const LoadReport::Item& item : report.unsupported) {
    if (item.feature == feature) return &item;
  }
  return nullptr;
}

inline const Primitive& onlyPrimitive(const LoadedScene& loaded) {
  static const Primitive kEmpty;
  if (loaded.scene.meshes.size() != 1 || loaded.scene.meshes[0].primitives.size() != 1) {
    ADD_FAILURE() << "expected one mesh of one primitive";
    return kEmpty;
  }
  return loaded.scene.meshes[0].primitives[0];
}

}  // namespace limn::test
