#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace limn {

/// Calls work(i) once for every i < count on all cores, the caller's thread among them. Calls take their turns in order
/// of i; what they write must not depend on who runs first.
template <class Work>
void parallelFor(size_t count, const Work& work) {
  std::atomic<size_t> next{0};
  const auto drain = [&] {
    for (size_t i = next++; i < count; i = next++) work(i);
  };
  const size_t workers = std::min<size_t>({count, std::max(std::thread::hardware_concurrency(), 1u), 16});
  std::vector<std::jthread> helpers;
  for (size_t i = 1; i < workers; ++i) helpers.emplace_back(drain);
  drain();
}

}  // namespace limn
