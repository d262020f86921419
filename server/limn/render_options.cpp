#include "server/limn/render_options.hpp"

#include <algorithm>

#include "renderer/techniques/technique_info.hpp"
#include "server/limn/output_file.hpp"
#include "server/limn/render_stats.hpp"

namespace limn {
namespace {

constexpr std::string_view kLayers[] = {"beauty", "direct", "indirect", "albedo",
                                        "normal", "depth",  "samples",  "error"};
constexpr uint64_t kDefaultSamples = 64;
constexpr double kLongest = 1e7;               // [s], about four months
constexpr const char* kAdaptive = "adaptive";  // the parameter of techniques that stop pixels early

const TechniqueInfo* techniqueOf(const RenderOptions& options) {
  return options.technique.empty() ? &techniqueInfos().front() : findTechnique(options.technique);
}

const ParameterInfo* findParameter(const TechniqueInfo& technique, const std::string& name) {
  for (const ParameterInfo& parameter : technique.parameters)
    if (parameter.name == name) return &parameter;
  return nullptr;
}

const double* given(const RenderOptions& options, const std::string& name) {
  for (const auto& [parameter, value] : options.parameters)
    if (parameter == name) return &value;
  return nullptr;
}

Result<void> readParameters(const Arguments& arguments, RenderOptions& options) {
  for (const std::string& text : arguments.all("set")) {
    const size_t equals = text.find('=');
    double value = 0.0;
    if (equals == 0 || equals == text.npos || !parseReal(std::string_view(text).substr(equals + 1), value))
      return usageError("--set takes name=number, not '" + text + "'");
    const std::string name = text.substr(0, equals);
    if (given(options, name)) return usageError("--set " + name + " is given twice");
    options.parameters.emplace_back(name, value);
  }
  return {};
}

Result<void> readCheckpoints(const Arguments& arguments, RenderOptions& options) {
  for (const std::string& text : arguments.list("checkpoints")) {
    double seconds = 0.0;
    if (!parseReal(text, seconds) || seconds <= 0.0 || seconds > kLongest)
      return usageError("--checkpoints takes seconds, not '" + text + "'");
    options.checkpoints.push_back({text, seconds});
  }
  if (!arguments.has("checkpoints")) return {};
  if (options.checkpoints.empty()) return usageError("--checkpoints needs at least one time");
  std::stable_sort(options.checkpoints.begin(), options.checkpoints.end(),
                   [](const CheckpointRequest& a, const CheckpointRequest& b) { return a.seconds < b.seconds; });
  const CheckpointRequest& last = options.checkpoints.back();
  if (options.stop.seconds && last.seconds > *options.stop.seconds)
    return usageError("a checkpoint at " + last.text + " s comes after the end of --time");
  return {};
}

Result<void> readStop(const Arguments& arguments, RenderOptions& options) {
  const Result<double> seconds = arguments.real("time", 0.0, 1e-3, kLongest);
  const Result<uint64_t> steps = arguments.integer("steps", 0, 1, UINT32_MAX);
  const Result<uint64_t> samples = arguments.integer("spp", 0, 1, UINT32_MAX);
  const Result<double> error = arguments.real("until-error", 0.0, 1e-9, 1e3);
  if (!seconds) return seconds.error();
  if (!steps) return steps.error();
  if (!samples) return samples.error();
  if (!error) return error.error();
  if (arguments.has("time")) options.stop.seconds = *seconds;
  if (arguments.has("steps")) options.stop.steps = uint32_t(*steps);
  if (arguments.has("until-error")) options.stop.error = *error;
  if (arguments.has("spp")) options.samples = {0, *samples};

  if (arguments.has("samples")) {
    SampleRange range;
    if (!parseSampleRange(arguments.text("samples"), range) || range.end > UINT32_MAX)
      return usageError("--samples takes A:B with A < B, not '" + arguments.text("samples") + "'");
    if (arguments.has("spp") && range.end > *samples) return usageError("--samples ends after the last of --spp");
    options.samples = range;
  }
  return {};
}

/// Without any rule a render of checkpoints ends at the last one, any other after kDefaultSamples.
void completeStop(RenderOptions& options) {
  const StopRule& stop = options.stop;
  if (stop.seconds || stop.steps || stop.error || options.samples.count() > 0) return;
  if (options.checkpoints.empty()) options.samples = {0, kDefaultSamples};
  else options.stop.seconds = options.checkpoints.back().seconds;
}

Result<void> checkTechnique(const RenderOptions& options) {
  const TechniqueInfo* technique = techniqueOf(options);
  if (!technique) return Error{"unsupported", "there is no technique '" + options.technique + "'", ""};
  for (const auto& [name, value] : options.parameters) {
    const ParameterInfo* parameter = findParameter(*technique, name);
    if (!parameter) return Error{"unsupported", technique->name + " has no parameter '" + name + "'", ""};
    if (value >= parameter->minimum && value <= parameter->maximum) continue;
    return Error{"out-of-range", name + " must be from " + std::to_string(parameter->minimum) + " to " +
                                     std::to_string(parameter->maximum), ""};
  }
  const double* adaptive = given(options, kAdaptive);
  if (options.samples.count() > 0 && adaptive && *adaptive != 0.0)
    return usageError("adaptive sampling does not give every pixel the samples of --spp or --samples");
  return {};
}

Result<void> checkOutput(const Arguments& arguments, RenderOptions& options) {
  options.png = options.output.ends_with(".png");
  if (!options.png && !options.output.ends_with(".exr"))
    return usageError("--output must end in .exr or .png, not '" + options.output + "'");
  for (const char* flag : {"aov", "samples"})
    if (options.png && arguments.has(flag)) return usageError("--" + std::string(flag) + " needs an .exr output");
  for (const std::string& name : options.layers)
    if (std::find(std::begin(kLayers), std::end(kLayers), name) == std::end(kLayers))
      return Error{"unsupported", "the film has no layer '" + name + "'", ""};
  std::vector<std::string> files = {options.output};
  if (!options.stats.empty()) files.push_back(options.stats);
  for (const CheckpointRequest& asked : options.checkpoints)
    files.push_back(checkpointFile(options.output, asked.text));
  for (const std::string& file : files)
    if (Result<void> writable = checkWritable(file); !writable) return writable;
  return {};
}

}  // namespace

CommandSpec renderSpec() {
  return {"limn render",
          "Renders a still of a glTF scene; SIGINT or SIGTERM ends it early with the picture so far, exit 130 or 143.",
          {"SCENE"},
          {{"output", "FILE.{exr,png}", "EXR: radiance in layers; PNG: what a viewer shows", false, "", true},
           {"size", "WxH", "pixels (default: 512x512)"},
           {"technique", "T", "how (default: the first that limnd announces)"},
           {"set", "name=value", "a parameter of the technique", true},
           {"camera", "NAME|INDEX", "which camera of the file (default: the first, else one that frames the scene)"},
           {"seed", "S", "another noise (default: 0)"},
           {"time", "SECONDS", "stop at the first end of a pass so long after the first step", false, "stop"},
           {"steps", "N", "stop after so many passes", false, "stop"},
           {"spp", "N", "stop after so many samples of every pixel (default: 64)", false, "stop"},
           {"until-error", "E", "stop when the upper end of relMSE's 95 % interval is this small", false, "stop"},
           {"samples", "A:B", "only the samples A <= i < B of every pixel: a part for limn merge"},
           {"checkpoints", "T1,T2,...", "also write FILE.<t>s.exr at those times"},
           {"aov", "LIST", "layers beside beauty: direct,indirect,albedo,normal,depth,samples,error (default: all)"},
           {"stats", "FILE.json", "times, samples, rays, error, memory, what ran and what was left out"}}};
}

Result<RenderOptions> renderOptions(const Arguments& arguments) {
  RenderOptions options;
  options.scene = arguments.positionals()[0];
  options.output = arguments.text("output");
  options.stats = arguments.text("stats");
  options.technique = arguments.text("technique");
  options.camera = arguments.text("camera");
  options.layers = arguments.list("aov");
  const Result<PixelSize> size = parsePixelSize(arguments.text("size", "512x512"));
  if (!size) return size.error();
  options.width = size->width;
  options.height = size->height;
  const Result<uint64_t> seed = arguments.integer("seed", 0, 0, UINT32_MAX);
  if (!seed) return seed.error();
  options.seed = uint32_t(*seed);

  for (const auto read : {readParameters, readStop, readCheckpoints, checkOutput})
    if (Result<void> done = read(arguments, options); !done) return done.error();
  completeStop(options);
  if (Result<void> known = checkTechnique(options); !known) return known.error();
  return options;
}

SessionConfig sessionConfig(const RenderOptions& options) {
  SessionConfig config;
  config.width = options.width;
  config.height = options.height;
  config.technique = techniqueOf(options)->name;
  config.parameters = options.parameters;
  config.seed = options.seed;
  config.firstSample = uint32_t(options.samples.first);
  config.sampleCount = uint32_t(options.samples.count());
  const bool counted = options.samples.count() > 0;
  if (counted && findParameter(*techniqueOf(options), kAdaptive) && !given(options, kAdaptive))
    config.parameters.emplace_back(kAdaptive, 0.0);
  return config;
}

Result<View> findView(const Scene& scene, const std::string& camera) {
  if (camera.empty()) return scene.view;
  std::string names;
  uint64_t chosen = scene.cameras.size();
  for (size_t i = scene.cameras.size(); i-- > 0;) {
    if (scene.cameras[i].name == camera) chosen = i;
    names = std::to_string(i) + " '" + scene.cameras[i].name + (names.empty() ? "'" : "', ") + names;
  }
  if (chosen == scene.cameras.size() && !parseInteger(camera, chosen)) chosen = scene.cameras.size();
  if (chosen >= scene.cameras.size())
    return Error{"unsupported", "no camera '" + camera + "'; the file has " + (names.empty() ? "none" : names), ""};
  const std::optional<View> view = scene.viewOfCamera(uint32_t(chosen));
  if (!view) return Error{"unsupported", "camera '" + camera + "' is placed by no node", ""};
  return *view;
}

}  // namespace limn
