#pragma once
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/scene/scene.hpp"

namespace limn {

/// Scales are told apart in steps of 2^(1/64), about 1.1 %; angles between the images of the axes in steps of 1/64 of
/// their cosine. Moving and turning an object leaves its metric as it is.
constexpr double kScaleStepsPerOctave = 64.0, kCosineSteps = 64.0;

/// What a node's linear map does to lengths, without its rotation: U with transpose(U) U = G, upper triangular, G being
/// transpose(M) M with its entries rounded. Reflections are taken out as well.
glm::dmat3 roundedStretch(const glm::dmat3& linear);

/// Corners of a primitive, 3 a triangle in the order of its indices, in its own space stretched by `stretch`.
std::vector<glm::vec3> stretchedCorners(const Primitive& primitive, const glm::dmat3& stretch);

}  // namespace limn
