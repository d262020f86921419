#pragma once
#include <string>

#include "server/limn/bench_results.hpp"

namespace limn::bench {

/// The figures that a README quotes, as Markdown: speed against error, slopes, spread, calibration, growth, what leaving
/// out saves, hard cases, and what is absent.
std::string resultsFigures(const BenchResults& results);

}  // namespace limn::bench
