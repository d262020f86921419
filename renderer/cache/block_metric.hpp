#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace limn {

/// Scales are told apart in steps of 2^(1/64), about 1.1 %; angles between the images of the axes in steps of 1/64 of
/// their cosine. Moving and turning an object leaves its metric as it is.
constexpr double kScaleStepsPerOctave = 64.0, kCosineSteps = 64.0;
/// Shapes are told apart in steps of 2^(1/4) of an axis against the longest: that one is off by 9 % at most, and the
/// areas of two faces by 19 % against each other.
constexpr double kShapeStepsPerOctave = 4.0;

/// What a node's linear map does to lengths, without its rotation: U with transpose(U) U = G, upper triangular, G being
/// transpose(M) M with its entries rounded. Reflections are taken out as well.
glm::dmat3 roundedStretch(const glm::dmat3& linear);

/// What it does to shapes: as roundedStretch(), but the longest axis becomes 1, and the scales of the others are rounded
/// to kShapeStepsPerOctave.
glm::dmat3 roundedShape(const glm::dmat3& linear);

/// Corners of triangles, 3 each in the order of `indices`, in their own space stretched by `stretch`.
std::vector<glm::vec3> stretchedCorners(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                                        const glm::dmat3& stretch);

}  // namespace limn
