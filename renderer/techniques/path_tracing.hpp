#pragma once
#include "renderer/techniques/technique.hpp"

namespace limn {

/// Unbiased path tracing with next-event estimation and MIS, the judge of every other technique.
const TechniqueInfo& pathTracingInfo();
std::unique_ptr<Technique> makePathTracing();

}  // namespace limn
