#pragma once
#include "renderer/film/compare.hpp"
#include "renderer/scene/gltf_loader.hpp"
#include "renderer/vk/device.hpp"
#include "tests/bench/projection_results.hpp"

namespace limn::projection {

/// The scene's beauty after a few passes of the technique. Errors: those of the session.
Result<RadianceImage> beautyOf(vk::Device& device, const LoadedScene& loaded, const ValidationOptions& options);

/// The layer "indirect" of the technique beside the path tracer's, once every pixel was gathered: after one bounce and
/// after three, with the technique's filter and without. In scenes with lobes too sharp for splats the technique
/// follows them by rays, which are not among its bounces, and the path tracer counts each; both then go on until it hardly
/// matters. Errors: those of the session, "io".
Result<std::vector<LightReport>> reportLight(vk::Device& device, const LoadedScene& loaded, const std::string& name,
                                             const ValidationOptions& options);

}  // namespace limn::projection
