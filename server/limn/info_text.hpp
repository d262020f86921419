#pragma once
#include <string>

#include "renderer/scene/gltf_loader.hpp"

namespace limn {

/// What `limn info` says about a file: contents, bounds, materials, textures, lights, cameras, what of it the renderer
/// needs and does not support, and what it will cost. Lines end in '\n'.
std::string infoText(const LoadedScene& loaded);

}  // namespace limn
