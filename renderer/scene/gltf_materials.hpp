#pragma once
#include "renderer/scene/gltf_document.hpp"

namespace limn::gltf {

/// All materials, in the file's order, with the images that they sample. Factors outside their range are clamped and
/// noted.
void readMaterials(Document& document, Scene& scene);

/// KHR_lights_punctual's lights and the cameras, in the file's order. A colour above 1 moves into the intensity.
void readLights(const Document& document, Scene& scene);
void readCameras(const Document& document, Scene& scene);

/// The image whose URI is the root's extras.limn.environment, as an environment of radiance 1. After readMaterials(),
/// with whose images it shares a limit.
void readEnvironment(Document& document, Scene& scene);

}  // namespace limn::gltf
