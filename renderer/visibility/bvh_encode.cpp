#include "renderer/visibility/bvh_encode.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/base/check.hpp"

namespace limn {
namespace {

using namespace shared;

// In steps of the grid. The shader computes a plane's t as (256 + q) * A + B with A = scale / d and
// B = (origin - o) / d - 256 * A. For a ray origin o within D = 1000 steps of the node this errs by less than
// 4 * 2^-24 * (D + 512) = 4e-4 steps, fifty times less than this margin. From farther away the error is relative to t
// and covered by the slack of kTraceSlack ulps in trace_node.glsl.
constexpr double kMargin = 0.02;

// The grid of one axis: a power of two at least 1/252 of the extent, and so coarse that origin can lie below the box.
struct Grid {
  float origin;
  double scale;
  uint32_t exponent;  // field of a float
};

Grid gridOf(float lower, float upper) {
  const double magnitude = std::max(std::abs(double(lower)), std::abs(double(upper)));
  const double wanted = std::max({(double(upper) - lower) / 252, magnitude * 0x1p-22, 0x1p-100});
  int exponent = 0;
  std::frexp(wanted, &exponent);
  const double scale = std::ldexp(1.0, exponent);
  return {float(lower - scale / 2), scale, uint32_t(exponent + 127)};
}

uint32_t gridLow(const Grid& grid, float v) {
  const double steps = std::floor((v - double(grid.origin)) / grid.scale - kMargin);
  LIMN_CHECK(steps >= 0 && steps <= 255);
  return uint32_t(steps);
}

uint32_t gridHigh(const Grid& grid, float v) {
  const double steps = std::ceil((v - double(grid.origin)) / grid.scale + kMargin);
  LIMN_CHECK(steps >= 0 && steps <= 255);
  return uint32_t(steps);
}

}  // namespace

BvhNode encodeNode(const Box& box, std::span<const EncodedChild> children, uint32_t innerCount, uint32_t childBase,
                   uint32_t triangleBase) {
  BvhNode node{};
  node.scaleExponents = innerCount << 24;
  for (int axis = 0; axis < 3; ++axis) {
    const Grid grid = children.empty() ? gridOf(0, 0) : gridOf(box.lower[axis], box.upper[axis]);
    node.origin[axis] = grid.origin;
    node.scaleExponents |= grid.exponent << (8 * axis);
    // An absent child is inside out: low above high.
    for (uint32_t child = 0; child < 4; ++child) {
      const bool there = child < children.size();
      const uint32_t low = there ? gridLow(grid, children[child].box.lower[axis]) : 255;
      const uint32_t high = there ? gridHigh(grid, children[child].box.upper[axis]) : 0;
      node.low[axis] |= low << (8 * child);
      node.high[axis] |= high << (8 * child);
    }
  }
  uint32_t mask = 0;
  for (uint32_t child = innerCount; child < children.size(); ++child) {
    LIMN_CHECK_LE(children[child].triangles, kBvhLeafTriangles);
    mask |= ((1u << children[child].triangles) - 1) << (kBvhLeafTriangles * child);
  }
  LIMN_CHECK_LE(childBase, kBvhBaseMask);
  LIMN_CHECK_LE(triangleBase, kBvhBaseMask);
  node.childBase = childBase | (mask & 0xff) << 24;
  node.triangleBase = triangleBase | (mask >> 8) << 24;
  return node;
}

}  // namespace limn
