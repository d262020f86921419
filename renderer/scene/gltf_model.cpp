#include <nlohmann/json.hpp>
#define TINYGLTF_IMPLEMENTATION
#include "renderer/scene/gltf_document.hpp"

namespace limn::gltf {
namespace {

using nlohmann::json;

/// What tinygltf is given: only the lists that describe geometry, without extensions and extras (which we read
/// ourselves, because tinygltf cuts large integers and drops empty values), and with every buffer's URI replaced by its
/// number.
json geometryPart(const json& full) {
  json part = {{"asset", {{"version", "2.0"}}}};
  for (const char* list : {"buffers", "bufferViews", "accessors", "meshes", "nodes", "skins", "scenes"}) {
    if (!full.contains(list)) continue;
    part[list] = full[list];
    for (json& item : part[list]) {
      item.erase("extensions");
      item.erase("extras");
      if (!item.contains("primitives")) continue;
      for (json& primitive : item["primitives"]) {
        primitive.erase("extensions");
        primitive.erase("extras");
      }
    }
  }
  size_t index = 0;
  if (part.contains("buffers")) {
    for (json& buffer : part["buffers"]) buffer["uri"] = "buffer/" + std::to_string(index++);
  }
  return part;
}

/// The bytes of buffer `index`, cut to the length it declares.
std::vector<uint8_t> bufferBytes(Document& document, size_t index) {
  const Value buffer = document.root().list("buffers")[index];
  const uint64_t length = buffer.need("byteLength").asUnsigned();
  std::vector<uint8_t> bytes;
  if (const auto uri = buffer.find("uri")) {
    bytes = readUri(document.container, uri->asString(), document.limits.maxFileBytes, uri->pointer());
  } else if (index == 0 && document.container.binary) {
    bytes = std::move(*document.container.binary);
  } else {
    buffer.fail("bad-file", "the buffer has neither a URI nor a binary chunk");
  }
  if (bytes.size() < length) {
    buffer.need("byteLength")
        .fail("out-of-range",
              "the buffer says " + std::to_string(length) + " bytes and has " + std::to_string(bytes.size()));
  }
  bytes.resize(length);
  return bytes;
}

/// tinygltf's file system: it can open "buffer/N" and nothing else.
struct BufferFiles {
  Document& document;
  std::optional<Fault> fault;

  static bool exists(const std::string& name, void*) { return name.starts_with("buffer/"); }
  static std::string expand(const std::string& name, void*) { return name; }
  static bool write(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }
  static bool read(std::vector<unsigned char>* out, std::string*, const std::string& name, void* self) {
    auto& files = *static_cast<BufferFiles*>(self);
    try {
      *out = bufferBytes(files.document, std::stoul(name.substr(7)));
      return true;
    } catch (const Fault& fault) {
      files.fault = fault;
      return false;
    }
  }
};

}  // namespace

void parseModel(Document& document) {
  BufferFiles files{document, {}};
  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks({&BufferFiles::exists, &BufferFiles::expand, &BufferFiles::read, &BufferFiles::write, &files});
  const std::string text = geometryPart(document.json).dump();
  if (text.size() > std::numeric_limits<unsigned int>::max()) fail("limit", "the JSON is too large", "");

  std::string error, warning;
  const bool good = reader.LoadASCIIFromString(&document.model, &error, &warning, text.data(), unsigned(text.size()),
                                               "", tinygltf::NO_REQUIRE);
  if (files.fault) throw *files.fault;
  if (!good) fail("bad-file", "tinygltf refuses the file: " + error.substr(0, error.find('\n')), "");
  const Value root = document.root();
  const bool complete = document.model.accessors.size() == root.list("accessors").size() &&
                        document.model.meshes.size() == root.list("meshes").size() &&
                        document.model.nodes.size() == root.list("nodes").size();
  if (!complete) fail("bad-file", "tinygltf could not read every mesh, node and accessor", "");
  for (size_t i = 0; i < document.model.meshes.size(); ++i) {
    const Value primitives = root.list("meshes")[i].list("primitives");
    if (document.model.meshes[i].primitives.size() != primitives.size())
      primitives.fail("bad-file", "tinygltf could not read a primitive");
  }
}

}  // namespace limn::gltf
