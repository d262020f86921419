#include "renderer/gpu/alias_table.hpp"

#include <numeric>

namespace limn::gpu {

std::vector<AliasEntry> buildAliasTable(std::span<const double> weights) {
  const size_t n = weights.size();
  std::vector<AliasEntry> table(n);
  if (n == 0) return table;
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<double> scaled(n);
  std::vector<uint32_t> small, large;
  for (size_t i = 0; i < n; ++i) {
    const double probability = sum > 0.0 ? weights[i] / sum : 1.0 / double(n);
    table[i] = {1.0f, uint32_t(i), float(probability)};
    scaled[i] = probability * double(n);
    (scaled[i] < 1.0 ? small : large).push_back(uint32_t(i));
  }
  while (!small.empty() && !large.empty()) {
    const uint32_t poor = small.back(), rich = large.back();
    small.pop_back();
    table[poor].share = float(scaled[poor]);
    table[poor].alias = rich;
    scaled[rich] -= 1.0 - scaled[poor];
    if (scaled[rich] < 1.0) {
      large.pop_back();
      small.push_back(rich);
    }
  }
  // Rounding leaves entries that should be exactly full; a zero weight among them would be drawn by mistake.
  for (const uint32_t i : small)
    if (weights[i] == 0.0 && sum > 0.0 && !large.empty()) table[i] = {0.0f, large.back(), 0.0f};
  return table;
}

}  // namespace limn::gpu
