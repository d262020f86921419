#pragma once
#include <memory>
#include <optional>

#include "renderer/film/film.hpp"
#include "renderer/gpu/device_scene.hpp"
#include "renderer/scene/scene_needs.hpp"
#include "renderer/visibility/scene_tracer.hpp"

namespace limn {

/// What techniques that are not in use are prepared on: the materials of a scene on triangles without area, and a picture
/// of 16x16 pixels. They get the pipelines of the scene, and nothing that costs time or memory. Render thread.
struct WarmUpScene {
  explicit WarmUpScene(vk::Device& device) : mirror(device) {}
  /// Errors: "limit", "out-of-memory", "device-lost".
  static Result<std::unique_ptr<WarmUpScene>> create(vk::Device& device, const Scene& scene);

  Scene description;
  SceneNeeds needs;  ///< of the scene that this one stands for
  gpu::DeviceScene mirror;
  SceneTracer tracer;
  std::optional<Film> film;
};

}  // namespace limn
