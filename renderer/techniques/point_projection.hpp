#pragma once
#include "renderer/techniques/technique.hpp"

namespace limn {

/// Importance-driven point projection [IPP]: lit points on all surfaces are projected into a micro-buffer at pixels chosen
/// adaptively; the other pixels are reconstructed from those. Direct light and lobes too narrow for splats are traced.
/// Biased: micro-buffers see 1,024 directions, points stand for disks, pixels between samples are interpolated, and light
/// ends after the announced number of bounces.
/// The bias falls as points, projections and the micro-buffer grow: relMSE of indirect light below 0.02 in a Cornell box and 0.04
/// in an open room, each in 48x36 pixels without the filter. The filter blurs by pixels; between splats of a near wall a little
/// light passes; gaps narrower than splats leak. tests/techniques/point_projection_*_test.cpp hold the bounds.
const TechniqueInfo& pointProjectionInfo();
std::unique_ptr<Technique> makePointProjection();

}  // namespace limn
