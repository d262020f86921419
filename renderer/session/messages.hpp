#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "renderer/base/stage_time.hpp"
#include "renderer/scene/edit.hpp"
#include "renderer/scene/gltf_loader.hpp"
#include "renderer/scene/scene_needs.hpp"

namespace limn {

/// Who asked, and which of their messages it was. `client` is the server's id, 0 for the process itself.
struct Origin {
  uint64_t client = 0;
  uint32_t seq = 0;
};

/// Edits that apply together or not at all.
struct EditRequest {
  Origin from;
  std::vector<Edit> edits;
  double receivedAt = 0.0;             ///< nowSeconds() when the message came in
};
/// A scene that a loader thread has read; replaces the present one. When it failed, `error` goes back and nothing changes.
struct LoadRequest {
  Origin from;
  std::shared_ptr<LoadedScene> loaded; ///< moved from
  double receivedAt = 0.0;
};
struct PickRequest { Origin from; uint32_t x = 0, y = 0; };   ///< [pixel], 0,0 top left
struct SaveRequest { Origin from; std::vector<std::string> layers; };  ///< EXR layers, empty: all
struct DescribeRequest { Origin from; };
/// The film's hash and statistics once `steps` passes are done since the last restart (0: at convergence).
struct WaitRequest { Origin from; uint32_t steps = 0; };
/// Whether anybody looks; with nobody watching and nothing asked the loop sleeps.
struct WatchRequest { bool watched = true; };
/// Nothing that the client asked matters any more.
struct LeaveRequest { uint64_t client = 0; };
using Request = std::variant<EditRequest, LoadRequest, PickRequest, SaveRequest, DescribeRequest, WaitRequest, WatchRequest,
                             LeaveRequest>;

/// What was edited and what it cost. One for every EditRequest, also for camera edits that a later one replaced.
struct EditAck {
  Origin to;
  CostClass cost = CostClass::none;
  uint32_t sceneRevision = 0, viewRevision = 0;
  bool superseded = false;             ///< a later camera edit took its place before it was applied
  std::string technique = {};          ///< that was in use when the edit came
};
struct ErrorReply { Origin to; Error error; };

/// The scene without its texels and vertices: what panels and scripts need.
struct SceneSummary {
  std::string name;
  uint64_t hash = 0;
  uint32_t sceneRevision = 0, viewRevision = 0;
  std::vector<Material> materials;
  std::vector<Light> lights;
  std::vector<Node> nodes;
  std::vector<std::string> meshNames;
  std::vector<Camera> cameras;
  Environment environment;
  View view;
  ResolveSettings resolve;
  std::string technique;
  std::vector<std::pair<std::string, double>> parameters;  ///< current values of the technique's parameters
  uint32_t width = 0, height = 0;
  Bounds bounds;
  LoadReport report;
};
struct DescribeReply { Origin to; std::shared_ptr<const SceneSummary> scene; };
struct LoadReply { Origin to; std::shared_ptr<const SceneSummary> scene; double loadSeconds = 0.0; };
/// Hit under a pixel; node == kNone when the ray leaves the scene.
struct PickReply {
  Origin to;
  int32_t node = kNone, material = kNone, primitive = kNone;
  glm::dvec3 posW{0.0};
  glm::vec3 normalW{0.0f};
  double distance = 0.0;               ///< [m] along the camera ray
};
struct SaveReply { Origin to; std::shared_ptr<const std::vector<uint8_t>> exr; };
struct WaitReply {
  Origin to;
  uint64_t filmHash = 0;
  uint32_t steps = 0;
  bool converged = false;
  float estimatedError = 0.0f;         ///< relMSE of that film; infinity until it can be told
  float errorLow = 0.0f, errorHigh = 0.0f;  ///< 95 % interval
};

using Reply = std::variant<EditAck, ErrorReply, DescribeReply, LoadReply, PickReply, SaveReply, WaitReply>;

enum class Phase : uint32_t { coarse, converging, converged };

/// Everything told about a picture.
struct FrameInfo {
  uint64_t frameId = 0;
  uint32_t sceneRevision = 0, viewRevision = 0;
  uint32_t width = 0, height = 0;      ///< [pixel]
  Phase phase = Phase::coarse;
  uint32_t steps = 0;                  ///< passes done since the restart
  float gatheredShare = 0.0f;          ///< share of pixels with at least one sample of their own, 0..1
  float meanSamples = 0.0f;            ///< per pixel
  float estimatedError = 0.0f;         ///< relMSE, estimate; infinity until it can be told
  float errorLow = 0.0f, errorHigh = 0.0f;  ///< 95 % interval
  float msSinceEdit = 0.0f;            ///< from receipt of the newest applied edit to publication
  uint64_t discardedSamples = 0;       ///< NaN, infinite or negative, since the restart
  std::vector<StageTime> stages;       ///< of this frame alone
  std::vector<Origin> applied;         ///< newest applied seq of every client that has edited
};

struct Frame {
  FrameInfo info;
  std::vector<uint8_t> rgba;           ///< width*height*4, sRGB-encoded, row 0 on top, alpha 255
};

/// Slow-changing facts, sent a few times a second.
struct Status {
  Phase phase = Phase::coarse;
  bool idle = false;
  uint32_t steps = 0;
  float meanSamples = 0.0f;
  float estimatedError = 0.0f;         ///< relMSE; infinity until it can be told
  float errorLow = 0.0f, errorHigh = 0.0f;  ///< 95 % interval
  double raysPerSecond = 0.0;
  double secondsSinceRestart = 0.0;
  uint64_t discardedSamples = 0;       ///< NaN, infinite or negative, since the restart
  double discardedShare = 0.0;         ///< of the samples taken since then, 0..1
  uint64_t editsApplied = 0, restarts = 0, framesPublished = 0, quanta = 0;
  uint64_t blocksRebuilt = 0;          ///< BVH blocks that edits and loads had built anew
  uint32_t pipelinesCreated = 0;       ///< since the process began; constant after warm-up
  std::string technique, device;
  /// The technique's passes, the pipelines they ran in, and "scene: " with the name of every flag of SceneNeeds.
  std::vector<std::string> ran, leftOut;
  std::vector<std::pair<std::string, uint64_t>> memory;      ///< on the device, bytes by owner
  std::vector<std::pair<std::string, uint64_t>> hostMemory;  ///< of the scene and what is kept of it, bytes by owner
  std::vector<StageTime> stages;       ///< build and warmUp of the session; the others since the restart
  std::vector<std::pair<std::string, double>> figures;       ///< Technique::figures()
};

}  // namespace limn
