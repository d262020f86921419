// How much work is asked for at a time.
#include "renderer/techniques/work_rate.hpp"

#include <gtest/gtest.h>

namespace limn {
namespace {

TEST(WorkRate, GivesWhatFitsAndAtLeastOneItem) {
  const WorkRate rate(1e4);
  EXPECT_EQ(rate.itemsIn(0.015), 150u);
  EXPECT_EQ(rate.itemsIn(1e-9), 1u);
}

TEST(WorkRate, NeverGivesMoreThanADispatchHasWorkgroupsFor) {
  WorkRate rate(1e3);
  for (int i = 0; i < 100; ++i) rate.measured(1ull << 40, 1.0);
  const uint64_t asked = rate.itemsIn(0.015) + 64;        // as PathTracing asks
  EXPECT_LE((asked + 511) / 512 * 8, 65535u) << "workgroups of 64, dealt eight at a time";
  EXPECT_GT(asked, 1u << 20) << "and none so small that dispatches cost more than they do";
}

}  // namespace
}  // namespace limn
