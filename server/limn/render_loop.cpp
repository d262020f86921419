#include "server/limn/render_loop.hpp"

namespace limn {
namespace {

bool ended(const StopRule& stop, double seconds, const PassState& state) {
  return state.converged || (stop.seconds && seconds >= *stop.seconds) || (stop.steps && state.steps >= *stop.steps) ||
         (stop.error && state.errorHigh <= *stop.error);
}

}  // namespace

Result<RenderOutcome> renderUntil(const StopRule& stop, const std::vector<CheckpointRequest>& checkpoints,
                                  const RenderHooks& hooks) {
  RenderOutcome outcome;
  const double begin = hooks.now();
  double aside = 0.0;  // spent on checkpoints
  for (bool done = false; !done && !outcome.interrupted;) {
    const Result<PassState> state = hooks.pass();
    if (!state) return state.error();
    const bool progressed = state->steps > outcome.state.steps;
    outcome.state = *state;
    outcome.seconds = hooks.now() - begin - aside;
    done = !progressed || ended(stop, outcome.seconds, outcome.state);
    outcome.interrupted = !done && hooks.interrupted();

    while (outcome.checkpoints.size() < checkpoints.size()) {
      const CheckpointRequest& next = checkpoints[outcome.checkpoints.size()];
      if (!done && next.seconds > outcome.seconds) break;
      const double before = hooks.now();
      CheckpointTaken taken{next, outcome.seconds, outcome.state};
      if (const Result<void> written = hooks.takeCheckpoint(taken); !written) taken.failure = written.error();
      outcome.checkpoints.push_back(std::move(taken));
      aside += hooks.now() - before;
    }
  }
  return outcome;
}

}  // namespace limn
