#pragma once
#include <cstdint>

namespace limn::gpu {

/// What the pipelines at work were cut to, the best first.
enum class PipelineVariant : uint32_t {
  tailored,  ///< what the present scene needs
  superset,  ///< what an earlier scene needed, which was more
  general,   ///< nothing: they render any scene
};

}  // namespace limn::gpu
