#pragma once
#include <string>

#include "renderer/scene/gltf_loader.hpp"
#include "renderer/session/session.hpp"

namespace limn {

/// What `limn info` says about a file: contents, bounds, materials, textures, lights, cameras, what of it the renderer
/// needs and does not support, and the memory that a session of `config` will take. Lines end in '\n'.
std::string infoText(const LoadedScene& loaded, const SessionConfig& config = {});

}  // namespace limn
