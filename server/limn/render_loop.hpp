#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "server/limn/render_options.hpp"

namespace limn {

/// What the loop knows after a pass.
struct PassState {
  uint32_t steps = 0;                  ///< passes done
  double error = 0.0;                  ///< estimated relMSE
  double errorLow = 0.0, errorHigh = 0.0;  ///< its 95 % interval
  bool converged = false;
};

/// The film at one moment, on its way to a file.
struct CheckpointTaken {
  CheckpointRequest request;
  double seconds = 0.0;                ///< of rendering when it was taken: the end of a pass, or the end of the render
  PassState state;
  std::optional<Error> failure;        ///< why its file was not written
};

struct RenderHooks {
  /// One more pass; the same number of steps when there is none left.
  std::function<Result<PassState>()> pass;
  /// Its time does not count.
  std::function<Result<void>(const CheckpointTaken&)> takeCheckpoint;
  /// [s], monotonic.
  std::function<double()> now;
  /// Whether to stop after this pass.
  std::function<bool()> interrupted;
};

struct RenderOutcome {
  double seconds = 0.0;                ///< of rendering, from the first step
  PassState state;
  std::vector<CheckpointTaken> checkpoints;
  bool interrupted = false;            ///< before the rule or convergence stopped it
};

/// Passes until the rule, convergence or an interruption stops them; at least one. Each checkpoint is taken at the
/// first end of a pass at or after its time. Those that the end forestalls show the final film; after an interruption
/// they are not taken. The first error of a pass ends it; one of a checkpoint is kept with it.
Result<RenderOutcome> renderUntil(const StopRule& stop, const std::vector<CheckpointRequest>& checkpoints,
                                  const RenderHooks& hooks);

}  // namespace limn
