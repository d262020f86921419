#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace limn::gpu {

/// One draw picks entry i with chance 1/n, keeps it below `share`, else takes `alias`. [Walker 1977, Vose 1991]
struct AliasEntry {
  float share = 1.0f;
  uint32_t alias = 0;
  float probability = 0.0f;  ///< of this entry being drawn in the end
};

/// Weights are non-negative and finite. All zero: every entry is as likely.
std::vector<AliasEntry> buildAliasTable(std::span<const double> weights);

}  // namespace limn::gpu
