#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/scene/scene.hpp"

namespace limn {

/// Limits checked before anything large is allocated.
struct LoadLimits {
  uint64_t maxFileBytes = 2ull << 30;
  uint64_t maxJsonBytes = 256ull << 20;  ///< of a .gltf or a GLB's first chunk; parsed it takes several times as much
  uint64_t maxTriangles = 64'000'000;  ///< of all meshes, and over all nodes
  uint64_t maxVertices = 192'000'000;
  uint32_t maxNodes = 1'000'000;
  uint32_t maxImageSide = 16'384;       ///< [texel]
  uint64_t maxImageBytes = 1ull << 30;  ///< decoded, all images together
  uint32_t maxJsonDepth = 64;
};

struct LoadOptions {
  std::filesystem::path assetRoot;  ///< URIs may not leave it; empty: the file's own directory
  LoadLimits limits;
};

/// What was found, what is not supported, and what was added so that the scene can be seen.
struct LoadReport {
  struct Item {
    std::string feature;                 ///< "KHR_materials_iridescence", "primitive mode LINES", "TEXCOORD_2", ...
    std::vector<std::string> materials;  ///< names (or "#index") of the affected materials; empty: not a material's
    std::string note;                    ///< one sentence: what happens instead
  };
  std::vector<Item> unsupported;
  std::vector<std::string> notes;  ///< "no camera: one was added that frames the scene", ...
  uint64_t triangles = 0, degenerateTriangles = 0, vertices = 0, imageBytes = 0;
  uint64_t instancedTriangles = 0;  ///< over all nodes
  uint64_t contents = 0;            ///< hash of the glTF's JSON, in whose lists materials, lights and nodes have their numbers
};

struct LoadedScene {
  Scene scene;
  LoadReport report;
};

/// Reads .gltf or .glb. Any thread. Errors name the file and the JSON pointer ("cube.gltf#/accessors/3/count").
/// Skins and morph targets are applied at time zero. Nothing outside the asset root is opened. The root's
/// extras.limn.environment may be the URI of an environment image (environment_image.hpp).
Result<LoadedScene> loadGltf(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace limn
