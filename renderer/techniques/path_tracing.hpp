#pragma once
#include "renderer/techniques/technique.hpp"

namespace limn {

/// Unbiased path tracing with next-event estimation and MIS, the judge of every other technique.
const TechniqueInfo& pathTracingInfo();
std::unique_ptr<Technique> makePathTracing();
/// Workgroups of path_tracing.comp for a list of `entries` pixels.
uint32_t pathTracingWorkgroups(uint32_t entries);

}  // namespace limn
