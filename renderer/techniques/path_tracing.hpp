#pragma once
#include "renderer/gpu/pass.hpp"
#include "renderer/techniques/technique.hpp"
#include "shaders/shared/film_shared.h"

namespace limn {

/// Unbiased path tracing with next-event estimation and MIS, the judge of every other technique.
const TechniqueInfo& pathTracingInfo();
std::unique_ptr<Technique> makePathTracing();
/// Records path_tracing.comp for the entries and samples of `push`; the film comes out the same however it is cut into
/// dispatches. Where rays go on behind panes a path takes more of them, and a dispatch fewer paths: see samplesOfPass().
void recordPathTracing(vk::CommandRecorder& recorder, const gpu::Pass& pass, const std::vector<vk::Binding>& bindings,
                       shared::PathTracingPush push, const SceneNeeds& needs);

}  // namespace limn
