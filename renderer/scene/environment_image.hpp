#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "renderer/scene/gltf_loader.hpp"

namespace limn {

/// Decodes an .hdr or .exr latitude-longitude image for the environment; the bytes decide which. Values that are not
/// finite or negative become 0 and are counted in `notes`. Size is checked before anything is decoded. Any thread.
/// Errors: unsupported, bad-file, limit.
Result<Image> decodeEnvironmentImage(std::span<const uint8_t> bytes, const LoadLimits& limits,
                                     std::vector<std::string>& notes);

/// The same of a file below the asset root, which is the file's own directory when it is empty; the image is named by
/// its path below the root. Any thread. Errors as above, and path, io; they name the file.
Result<Image> loadEnvironmentImage(const std::filesystem::path& file, const LoadOptions& options,
                                   std::vector<std::string>& notes);

}  // namespace limn
