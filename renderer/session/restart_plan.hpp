#pragma once
#include "renderer/scene/edit.hpp"

namespace limn {

/// What of the derived data died with a change; only that is redone. DESIGN.md section 3, the restart table.
struct RestartPlan {
  CostClass cost = CostClass::none;  ///< told back in the ack
  bool syncScene = false;            ///< device mirror, then BVH blocks that moved
  bool writeCamera = false;
  bool restartFilm = false;
  bool showAgain = false;            ///< a new picture of the same samples
};

/// `parameterCost` is the dearest class among the technique parameters that changed.
inline RestartPlan planRestart(const ChangeSet& changes, CostClass parameterCost, bool sizeChanged) {
  RestartPlan plan;
  plan.cost = std::max(changes.cost(), parameterCost);
  if (changes.view) plan.cost = std::max(plan.cost, CostClass::regather);
  if (sizeChanged) plan.cost = std::max(plan.cost, CostClass::regather);
  plan.syncScene = changes.everything || !changes.materials.empty() || !changes.lights.empty() || !changes.nodes.empty() ||
                   !changes.emissive.empty() || changes.environment;
  // The camera is written in render space, whose origin a moved object may have moved.
  plan.writeCamera = changes.view || sizeChanged || plan.syncScene;
  plan.restartFilm = plan.cost > CostClass::displayOnly;
  plan.showAgain = plan.cost == CostClass::displayOnly;
  return plan;
}

}  // namespace limn
