#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/scene/scene.hpp"
#include "renderer/session/session.hpp"
#include "server/arguments.hpp"
#include "server/limn/merge_parts.hpp"

namespace limn {

/// When a render ends; it also ends when the technique has converged.
struct StopRule {
  std::optional<double> seconds;       ///< from the first step
  std::optional<uint32_t> steps;       ///< whole passes
  std::optional<double> error;         ///< upper end of the 95 % interval of relMSE
};

struct CheckpointRequest {
  std::string text;                    ///< as it was written; names the file
  double seconds = 0.0;
};

/// The command line of `limn render`, checked as far as it can be without the scene.
struct RenderOptions {
  std::string scene, output;
  bool png = false;
  uint32_t width = 512, height = 512;  ///< [pixel]
  std::string technique;               ///< empty: the first of the registry
  std::vector<std::pair<std::string, double>> parameters;
  std::string camera;                  ///< name or index; empty: the scene's first
  uint32_t seed = 0;
  StopRule stop;
  SampleRange samples;                 ///< end == first: without an end
  std::vector<CheckpointRequest> checkpoints;  ///< ascending
  std::vector<std::string> layers;     ///< beside beauty; empty: all
  std::string stats;
};

CommandSpec renderSpec();

/// Errors: "usage" for what is malformed or contradicts itself, "unsupported" for an unknown technique, parameter or
/// layer, "io" when the picture, the statistics or a checkpoint cannot be written where they are to go.
Result<RenderOptions> renderOptions(const Arguments& arguments);

/// Sample range, seed and parameters for the session. A render of counted samples is not adaptive: every pixel gets
/// them all, so that parts add up to the whole.
SessionConfig sessionConfig(const RenderOptions& options);

/// The view through the camera of that name, else of that index. Errors: "unsupported", naming the cameras there are.
Result<View> findView(const Scene& scene, const std::string& camera);

}  // namespace limn
