#pragma once
#include "renderer/scene/gltf_loader.hpp"
#include "renderer/vk/device.hpp"
#include "tests/bench/projection_results.hpp"

namespace limn::projection {

/// The view "placement" of one run of the technique at times after its first step, pipelines warm: green pixels were
/// gathered, orange ones interpolated. Time stops while a picture is taken. Errors: those of the session, "io".
Result<std::vector<PlacementReport>> reportPlacement(vk::Device& device, const LoadedScene& loaded,
                                                     const std::string& name, const ValidationOptions& options);

}  // namespace limn::projection
