#pragma once
#include "server/limn/bench_results.hpp"

namespace limn::bench {

/// A rippled floor of about `triangles` (at least 2), lit by `lights` point lights of the same power in all: the same
/// picture but for the lights' places, whatever the numbers.
LoadedScene growthScene(uint32_t triangles, uint32_t lights);

/// Seconds of a step and of the first ones, device memory and seconds to build, against each size alone, for every
/// technique; numbers of points for those that have them. Errors: those of the session.
Result<std::vector<Growth>> measureGrowth(vk::Device& device, const BenchOptions& options);

}  // namespace limn::bench
