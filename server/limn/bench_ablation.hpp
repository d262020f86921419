#pragma once
#include "server/limn/bench_results.hpp"

namespace limn::bench {

/// Runs two sessions in turn, step by step: one does what the scene needs, the other everything that any scene may
/// need. The same steps of both are compared in one process, so that what else the machine does hits both. Errors:
/// those of the session.
Result<Ablation> measureAblation(vk::Device& device, const LoadedScene& loaded, SessionConfig config);

}  // namespace limn::bench
