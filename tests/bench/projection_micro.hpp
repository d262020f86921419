#pragma once
#include "renderer/film/compare.hpp"
#include "tests/bench/projection_results.hpp"
#include "tests/bench/projection_scene.hpp"

namespace limn::projection {

/// Micro-buffers of five named pixels of a scene as pictures, and errors over a grid of pixels, of every way of
/// choosing points and splatting them against all points. Light at the points is direct. The named pixels of scenes that are not
/// known lie in a cross. Errors: those of the device, "io".
Result<MicroBufferReport> reportMicroBuffers(const LitScene& scene, const std::string& sceneName,
                                             const ValidationOptions& options);

/// The scene's picture with the named pixels framed in green; their order is from top to bottom. Errors: "io".
Result<Picture> markNamedPixels(const RadianceImage& beauty, const std::string& sceneName);

}  // namespace limn::projection
