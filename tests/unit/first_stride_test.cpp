// The grid of the first picture: as fine as it can wait for, never coarser than the floor, and steady between two.
#include "renderer/session/first_stride.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace limn {
namespace {

constexpr double kWanted = 0.05;  // [s]

/// One restart after another on a device that takes `whole` seconds for all pixels.
std::vector<uint32_t> restarts(uint32_t stride, double whole, int count) {
  std::vector<uint32_t> strides;
  const auto secondsTo = [&](uint32_t s) { return whole / (s * s); };
  for (int i = 0; i < count; ++i) strides.push_back(stride = nextFirstStride(stride, kWanted, secondsTo));
  return strides;
}

using Strides = std::vector<uint32_t>;

TEST(FirstStride, ASlowDeviceGetsCoarserByOneStepARestart) {
  EXPECT_EQ(restarts(1, 2.0, 4), (Strides{2, 4, 8, 8}));
}

TEST(FirstStride, AFastDeviceGetsFinerByOneStepARestart) { EXPECT_EQ(restarts(8, 0.01, 4), (Strides{4, 2, 1, 1})); }

TEST(FirstStride, TheFloorHoldsHoweverSlowTheDevice) { EXPECT_EQ(restarts(8, 1e6, 2), (Strides{8, 8})); }

TEST(FirstStride, ThePictureMayBe30PercentLate) {
  EXPECT_EQ(restarts(2, 4 * 1.29 * kWanted, 1), Strides{2});
  EXPECT_EQ(restarts(2, 4 * 1.31 * kWanted, 1), Strides{4});
}

TEST(FirstStride, TheFinerOneMustHave20PercentToSpare) {
  EXPECT_EQ(restarts(2, 0.79 * kWanted, 1), Strides{1});
  EXPECT_EQ(restarts(2, 0.81 * kWanted, 1), Strides{2});
}

/// The rate as it is measured differs by a few percent from edit to edit: where it lies must not matter.
TEST(FirstStride, ARateThatVariesByATenthNeverFlickers) {
  for (double whole = 0.01; whole < 10.0; whole *= 1.07) {
    const uint32_t settled = restarts(4, whole, 6).back();
    uint32_t stride = settled, changes = 0;
    for (int i = 0; i < 20; ++i) {
      const double varied = whole * (i % 2 ? 1.1 : 0.9);
      const uint32_t next = nextFirstStride(stride, kWanted, [&](uint32_t s) { return varied / (s * s); });
      changes += next != stride;
      stride = next;
    }
    EXPECT_LE(changes, 1u) << "at " << whole << " s a picture";
  }
}

}  // namespace
}  // namespace limn
