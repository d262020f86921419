#pragma once
#include "renderer/techniques/technique.hpp"

namespace limn {

/// Importance-driven point projection [IPP]: lit points on all surfaces are projected into a micro-buffer at pixels chosen
/// adaptively; the other pixels are reconstructed from those. Direct light and lobes too narrow for splats are traced.
/// Biased: micro-buffers see 1,024 directions, points stand for disks, pixels between samples are interpolated, and light
/// ends after the announced number of bounces.
const TechniqueInfo& pointProjectionInfo();
std::unique_ptr<Technique> makePointProjection();

}  // namespace limn
