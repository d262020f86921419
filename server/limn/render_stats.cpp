#include "server/limn/render_stats.hpp"

#include <algorithm>
#include <filesystem>

#include "protocol/json_writer.hpp"
#include "server/limn/hex_text.hpp"

namespace limn {
namespace {

std::string parametersText(std::vector<std::pair<std::string, double>> parameters) {
  std::sort(parameters.begin(), parameters.end());
  std::string text;
  for (const auto& [name, value] : parameters)
    text.append(text.empty() ? "" : " ").append(name).append("=").append(protocol::javascriptNumber(value));
  return text;
}

std::string viewText(const View& view) {
  std::string text;
  for (const glm::dvec3& v : {view.eye, view.target, view.up})
    for (int c = 0; c < 3; ++c) text.append(protocol::javascriptNumber(v[c])).append(" ");
  const Camera& lens = view.lens;
  return text + (lens.perspective ? "yfov " + protocol::javascriptNumber(lens.yfov)
                                  : "ymag " + protocol::javascriptNumber(lens.ymag)) +
         " znear " + protocol::javascriptNumber(lens.znear);
}

void writeSeconds(protocol::JsonWriter& json, const RenderStats& stats) {
  json.key("seconds");
  json.beginObject();
  json.field("load", stats.loadSeconds);
  json.field("build", stats.buildSeconds);
  json.field("warmUp", stats.warmUpSeconds);
  json.field("render", stats.outcome.seconds);
  json.field("write", stats.writeSeconds);
  json.endObject();
}

void writeCheckpoints(protocol::JsonWriter& json, const RenderStats& stats) {
  json.key("checkpoints");
  json.beginArray();
  for (const CheckpointTaken& taken : stats.outcome.checkpoints) {
    json.beginObject();
    json.field("requested", taken.request.seconds);
    json.field("seconds", taken.seconds);
    json.field("steps", taken.state.steps);
    json.field("estimatedError", taken.state.error);
    json.field("estimatedErrorLow", taken.state.errorLow);
    json.field("estimatedErrorHigh", taken.state.errorHigh);
    if (taken.failure) json.field("failure", taken.failure->text());
    else json.field("file", checkpointFile(stats.output, taken.request.text));
    json.endObject();
  }
  json.endArray();
}

void writeReport(protocol::JsonWriter& json, const LoadReport& report) {
  json.key("unsupported");
  json.beginArray();
  for (const LoadReport::Item& item : report.unsupported) {
    json.beginObject();
    json.field("feature", item.feature);
    json.field("materials", item.materials);
    json.field("note", item.note);
    json.endObject();
  }
  json.endArray();
  json.field("notes", report.notes);
}

std::vector<std::pair<std::string, float>> stageTimes(const Status& status) {
  std::vector<std::pair<std::string, float>> times;
  for (const StageTime& stage : status.stages) times.emplace_back(stage.name, stage.ms);
  return times;
}

void writeQuality(protocol::JsonWriter& json, const RenderStats& stats) {
  json.field("steps", stats.outcome.state.steps);
  json.field("samples", sampleRangeText(stats.samples));
  json.field("meanSamples", stats.status.meanSamples);
  json.field("discardedSamples", stats.status.discardedSamples);
  json.field("discardedShare", stats.status.discardedShare);
  json.field("converged", stats.outcome.state.converged);
  json.field("interrupted", stats.outcome.interrupted);
  json.field("estimatedError", stats.outcome.state.error);
  json.field("estimatedErrorLow", stats.outcome.state.errorLow);
  json.field("estimatedErrorHigh", stats.outcome.state.errorHigh);
}

}  // namespace

std::string renderStatsJson(const RenderStats& stats) {
  protocol::JsonWriter json;
  json.beginObject();
  json.field("scene", stats.scene);
  json.field("sceneHash", hexText(stats.sceneHash));
  json.field("triangles", stats.report.triangles);
  json.field("output", stats.output);
  json.field("width", stats.config.width);
  json.field("height", stats.config.height);
  json.field("technique", stats.config.technique);
  json.field("parameters", stats.config.parameters);
  json.field("seed", stats.config.seed);
  json.field("device", stats.device.name);
  json.field("driver", stats.device.driver);
  writeSeconds(json, stats);
  writeQuality(json, stats);
  json.field("raysPerSecond", stats.status.raysPerSecond);
  json.field("pipelinesCreated", stats.status.pipelinesCreated);
  writeCheckpoints(json, stats);
  json.field("ran", stats.status.ran);
  json.field("leftOut", stats.status.leftOut);
  json.field("memory", stats.status.memory);
  json.field("hostMemory", stats.status.hostMemory);
  json.field("stageMs", stageTimes(stats.status));
  json.field("figures", stats.status.figures);
  writeReport(json, stats.report);
  json.endObject();
  return json.take() + "\n";
}

std::string checkpointFile(const std::string& output, const std::string& time) {
  const std::filesystem::path path(output);
  return (path.parent_path() / path.stem()).string() + "." + time + "s.exr";
}

Metadata filmMetadata(const RenderStats& stats, const View& view, double seconds) {
  return {{"limn:parameters", parametersText(stats.config.parameters)},
          {"limn:samples", sampleRangeText(stats.samples)},
          {"limn:scene", std::filesystem::path(stats.scene).filename().string()},
          {"limn:sceneHash", hexText(stats.sceneHash)},
          {"limn:seconds", protocol::javascriptNumber(seconds)},
          {"limn:seed", std::to_string(stats.config.seed)},
          {"limn:technique", stats.config.technique},
          {"limn:version", LIMN_VERSION},
          {"limn:view", viewText(view)}};
}

}  // namespace limn
