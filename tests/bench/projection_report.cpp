#include "tests/bench/projection_report.hpp"

#include <filesystem>

#include "protocol/json_writer.hpp"
#include "renderer/base/file_bytes.hpp"

namespace limn::projection {
namespace {

using protocol::JsonWriter;

template <class T, class Write>
void writeList(JsonWriter& json, const char* name, const std::vector<T>& list, Write write) {
  json.key(name);
  json.beginArray();
  for (const T& item : list) {
    json.beginObject();
    write(json, item);
    json.endObject();
  }
  json.endArray();
}

void writeGather(JsonWriter& json, const GatherError& error) {
  json.field("way", error.way);
  json.field("relMse", error.texels);
  json.field("relMseAll", error.texelsAll);
  json.field("relativeSquare", error.square);
  json.field("irradianceRelMse", error.irradiance);
  json.field("holes", error.holes);
}

void writeLight(JsonWriter& json, const LightReport& light) {
  json.field("bounces", light.bounces);
  json.field("pathBounces", light.pathBounces);
  json.field("filterSize", light.filterSize);
  json.field("relMse", light.relMse);
  json.field("relMseAll", light.relMseAll);
  json.field("energy", light.energy);
  json.field("pathNoise", light.pathNoise);
}

void writePlacement(JsonWriter& json, const PlacementReport& placement) {
  json.field("seconds", placement.seconds);
  json.field("passes", placement.passes);
  json.field("sampledShare", placement.sampledShare);
}

void writeScene(JsonWriter& json, const SceneReport& scene) {
  json.field("name", scene.name);
  json.field("gridPixels", scene.microBuffers.gridPixels);
  writeList(json, "microBuffers", scene.microBuffers.errors, writeGather);
  writeList(json, "indirectLight", scene.light, writeLight);
  writeList(json, "placement", scene.placement, writePlacement);
}

/// Of every part, in the order of the page.
std::vector<const Picture*> picturesOf(const SceneReport& scene) {
  std::vector<const Picture*> all;
  for (const Picture& picture : scene.microBuffers.pictures) all.push_back(&picture);
  for (const LightReport& light : scene.light)
    for (const Picture& picture : light.pictures) all.push_back(&picture);
  for (const PlacementReport& placement : scene.placement) all.push_back(&placement.picture);
  return all;
}

Result<void> writeBytes(const std::filesystem::path& file, const std::string& bytes) {
  return writeFileAtomically(file, {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

}  // namespace

std::string reportJson(const ValidationReport& report) {
  const ValidationOptions& options = report.options;
  JsonWriter json;
  json.beginObject();
  json.field("device", report.device);
  json.field("width", options.size.width);
  json.field("height", options.size.height);
  json.field("points", options.points);
  json.field("projections", options.projections);
  json.field("pathSamples", 2 * options.pathSamples);
  json.field("passes", options.passes);
  writeList(json, "scenes", report.scenes, writeScene);
  json.endObject();
  return json.take() + "\n";
}

Result<void> writeReport(const ValidationReport& report) {
  const std::filesystem::path directory = report.options.output;
  std::error_code problem;
  std::filesystem::create_directories(directory, problem);
  if (problem) return Error{"io", problem.message(), directory.string()};
  for (const SceneReport& scene : report.scenes)
    for (const Picture* picture : picturesOf(scene))
      if (auto done = writeBytes(directory / picture->file, picture->png); !done) return done;
  if (auto done = writeBytes(directory / "results.json", reportJson(report)); !done) return done;
  return writeBytes(directory / "index.html", reportPage(report));
}

}  // namespace limn::projection
