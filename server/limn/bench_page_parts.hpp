#pragma once
#include <string>

#include "server/limn/bench_results.hpp"

namespace limn::bench {

/// The plot DIRECTORY/NAME.svg as an image; nothing where it was not drawn.
std::string plot(const std::string& directory, const std::string& name, const std::string& caption);
/// The exponent with its standard error.
std::string fitText(const std::optional<PowerFit>& fit);

/// Slope and spread of unbiased techniques over many seeds; empty where it was not measured.
std::string convergenceSection(const BenchResults& results, const std::string& directory);
/// Time and memory against one size alone; empty where it was not measured.
std::string growthSection(const BenchResults& results, const std::string& directory);
/// What leaving out saves; empty where it was not measured.
std::string ablationSection(const BenchResults& results);

}  // namespace limn::bench
