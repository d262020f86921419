#pragma once
#include <string>
#include <vector>

#include "renderer/scene/gltf_loader.hpp"
#include "renderer/vk/device_info.hpp"
#include "server/limn/render_loop.hpp"

namespace limn {

/// Everything `limn render --stats` tells.
struct RenderStats {
  std::string scene, output;
  uint64_t sceneHash = 0;
  SessionConfig config;
  SampleRange samples;                 ///< really taken
  double loadSeconds = 0.0;            ///< file to Scene
  double buildSeconds = 0.0;           ///< Scene to device: textures, tables, BVH
  double warmUpSeconds = 0.0;          ///< pipelines
  double writeSeconds = 0.0;           ///< the picture, not the checkpoints
  RenderOutcome outcome;
  Status status;
  FrameInfo frame;
  LoadReport report;
  vk::DeviceInfo device;
};

/// One JSON object; seconds in s, memory in bytes.
std::string renderStatsJson(const RenderStats& stats);

/// FILE.exr, 0.5 -> FILE.0.5s.exr
std::string checkpointFile(const std::string& output, const std::string& time);

/// What a film says about itself, for limn merge and for people.
using Metadata = std::vector<std::pair<std::string, std::string>>;
Metadata filmMetadata(const RenderStats& stats, const View& view, double seconds);

}  // namespace limn
