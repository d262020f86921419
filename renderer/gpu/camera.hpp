#pragma once
#include "renderer/scene/scene.hpp"
#include "shaders/shared/scene_shared.h"

namespace limn::gpu {

/// A view of width x height pixels as shaders see it, in render space. A view along `up` takes another direction for it.
shared::CameraData cameraData(const View& view, const glm::dvec3& renderOrigin, uint32_t width, uint32_t height);

}  // namespace limn::gpu
