#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/asset_files.hpp"
#include "renderer/scene/gltf_loader.hpp"

namespace limn::gltf {

/// A .gltf or .glb file taken apart: its JSON text, the binary chunk, and the folder that its URIs are relative to.
struct Container {
  AssetRoot root;
  std::string folder;  ///< of the file, below the root; "" or ends with '/'
  std::string json;
  std::optional<std::vector<uint8_t>> binary;  ///< GLB's BIN chunk
};

/// Reads and checks the file's frame. Throws Fault: io, path, limit, bad-file, unsupported (GLB version).
Container openContainer(const std::filesystem::path& file, const LoadOptions& options);

/// The path below the asset root that a URI names; empty for a data URI. Throws Fault at `pointer`: path, bad-file.
std::string pathOfUri(const Container& container, const std::string& uri, const std::string& pointer);

/// The bytes of a buffer's or image's URI: a base64 or percent-encoded data URI, or a file below the asset root.
/// Throws Fault at `pointer`: path, io, limit, bad-file.
std::vector<uint8_t> readUri(const Container& container, const std::string& uri, uint64_t maxBytes,
                             const std::string& pointer);

}  // namespace limn::gltf
