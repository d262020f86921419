#include "server/limn/bench_options.hpp"

#include <algorithm>
#include <filesystem>

namespace limn::bench {
namespace {

namespace fs = std::filesystem;

constexpr double kLongest = 1e6;  // [s]
constexpr const char* kDefaultBudgets = "0.25,0.5,1,2,4,8";
constexpr const char* kAdaptive = "adaptive";
constexpr const char* kMaxSamples = "maxSamples";
/// Of the generated scenes, those that stand for a kind of light transport each.
constexpr const char* kDefaultScenes[] = {"cornell-box", "cornell-point", "cornell-indirect", "cornell-glossy", "cornell-caustic",
                                          "veach-mis",   "ajar-door",     "colonnade",      "thin-furniture",
                                          "many-lights", "plant",         "demo"};

bool isFile(const fs::path& path) {
  std::error_code problem;
  return fs::is_regular_file(path, problem);
}
bool isDirectory(const fs::path& path) {
  std::error_code problem;
  return fs::is_directory(path, problem);
}

/// Where a build keeps its generated scenes: ../scenes as the program sees it.
fs::path generatedScenes() {
  std::error_code problem;
  const fs::path program = fs::read_symlink("/proc/self/exe", problem);
  return problem ? fs::path("scenes") : program.parent_path().parent_path() / "scenes";
}

std::vector<std::string> scenesIn(const fs::path& directory) {
  std::vector<std::string> files;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, problem)) {
    const std::string ending = entry.path().extension().string();
    if (isFile(entry.path()) && (ending == ".glb" || ending == ".gltf")) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Result<void> readScenes(const Arguments& arguments, BenchOptions& options) {
  std::vector<std::string> asked = arguments.list("scenes");
  if (!arguments.has("scenes")) asked.assign(std::begin(kDefaultScenes), std::end(kDefaultScenes));
  if (asked.empty()) return usageError("--scenes needs at least one scene");
  for (const std::string& item : asked) {
    const fs::path generated = generatedScenes() / (item + ".glb");
    if (isDirectory(item)) {
      const std::vector<std::string> found = scenesIn(item);
      if (found.empty()) return Error{"io", "holds no .glb and no .gltf file", item};
      options.scenes.insert(options.scenes.end(), found.begin(), found.end());
    } else if (isFile(item)) {
      options.scenes.push_back(item);
    } else if (isFile(generated)) {
      options.scenes.push_back(generated.string());
    } else {
      return Error{"io", "no such scene, and none of that name is in " + generatedScenes().string(), item};
    }
  }
  return {};
}

Result<void> readTechniques(const Arguments& arguments, BenchOptions& options) {
  options.techniques = arguments.list("techniques");
  if (!arguments.has("techniques"))
    for (const TechniqueInfo& info : techniqueInfos()) options.techniques.push_back(info.name);
  if (options.techniques.empty()) return usageError("--techniques needs at least one name");
  for (const std::string& name : options.techniques)
    if (!findTechnique(name)) return Error{"unsupported", "no technique '" + name + "'", ""};
  return {};
}

Result<void> readBudgets(const Arguments& arguments, BenchOptions& options) {
  const bool counted = arguments.has("steps");
  const std::string flag = counted ? "steps" : "budgets";
  const std::string list = arguments.text(flag, kDefaultBudgets);
  for (const std::string& text : splitList(list, ',')) {
    Budget budget{text};
    uint64_t steps = 0;
    const bool valid = counted ? parseInteger(text, steps) && steps > 0 && steps <= UINT32_MAX
                               : parseReal(text, budget.seconds) && budget.seconds > 0.0 && budget.seconds <= kLongest;
    if (!valid) return usageError("--" + flag + " takes " + (counted ? "passes" : "seconds") + ", not '" + text + "'");
    budget.steps = uint32_t(steps);
    options.budgets.push_back(budget);
  }
  const auto before = [](const Budget& a, const Budget& b) {
    return a.seconds != b.seconds ? a.seconds < b.seconds : a.steps < b.steps;
  };
  std::stable_sort(options.budgets.begin(), options.budgets.end(), before);
  for (size_t i = 1; i < options.budgets.size(); ++i)
    if (!before(options.budgets[i - 1], options.budgets[i])) return usageError("--" + flag + " has a budget twice");
  return {};
}

const ParameterInfo* findParameter(const TechniqueInfo& technique, const std::string& name) {
  for (const ParameterInfo& parameter : technique.parameters)
    if (parameter.name == name) return &parameter;
  return nullptr;
}

/// Every technique that a setting speaks of has the parameter and allows the value; there is at least one.
Result<void> checkSetting(const Setting& setting) {
  bool known = false;
  for (const TechniqueInfo& technique : techniqueInfos()) {
    if (!setting.technique.empty() && setting.technique != technique.name) continue;
    const ParameterInfo* parameter = findParameter(technique, setting.parameter);
    if (!parameter) continue;
    known = true;
    if (setting.value < parameter->minimum || setting.value > parameter->maximum)
      return Error{"out-of-range", setting.parameter + " must be from " + std::to_string(parameter->minimum) + " to " +
                                       std::to_string(parameter->maximum), ""};
  }
  const std::string who = setting.technique.empty() ? "no technique" : "no technique '" + setting.technique + "'";
  if (!known) return Error{"unsupported", who + " with a parameter '" + setting.parameter + "'", ""};
  return {};
}

Result<void> readSettings(const Arguments& arguments, BenchOptions& options) {
  for (const std::string& text : arguments.all("set")) {
    const size_t equals = text.find('=');
    Setting setting;
    if (equals == 0 || equals == text.npos || !parseReal(std::string_view(text).substr(equals + 1), setting.value))
      return usageError("--set takes [technique.]name=number, not '" + text + "'");
    const size_t dot = text.substr(0, equals).rfind('.');
    if (dot != text.npos) setting.technique = text.substr(0, dot);
    setting.parameter = dot == text.npos ? text.substr(0, equals) : text.substr(dot + 1, equals - dot - 1);
    if (Result<void> checked = checkSetting(setting); !checked) return checked;
    options.settings.push_back(setting);
  }
  return {};
}

Result<void> readPlaces(const Arguments& arguments, BenchOptions& options) {
  options.output = arguments.text("output");
  options.references = arguments.text("references", (fs::path(options.output) / "references").string());
  options.pictures = arguments.text("pictures");
  options.hardCases = arguments.text("hard-cases");
  for (const std::string& file : {options.pictures, options.hardCases})
    if (!file.empty() && !isFile(file)) return Error{"io", "no such file", file};
  return {};
}

Result<void> readSizes(const Arguments& arguments, BenchOptions& options) {
  const Result<PixelSize> size = parsePixelSize(arguments.text("size", "256x256"));
  if (!size) return size.error();
  options.width = size->width;
  options.height = size->height;
  const Result<uint64_t> seeds = arguments.integer("seeds", options.seeds, 1, 100);
  if (!seeds) return seeds.error();
  options.seeds = uint32_t(*seeds);
  const Result<double> seconds = arguments.real("reference-seconds", options.referenceSeconds, 0.01, kLongest);
  if (!seconds) return seconds.error();
  options.referenceSeconds = *seconds;
  const Result<uint64_t> convergence = arguments.integer("convergence", options.convergence, 3, 1000);
  if (!convergence) return convergence.error();
  options.convergence = uint32_t(*convergence);
  options.growth = arguments.has("growth");
  options.ablation = arguments.has("ablation");
  return {};
}

}  // namespace

CommandSpec benchSpec() {
  return {"limn bench",
          "Speed against error of every technique on every scene: CSV, JSON, plots and one page, index.html.",
          {},
          {{"output", "DIR", "where the tables, the plots, the page index.html and references go", false, "", true},
           {"scenes", "DIR|LIST", "files, folders, names of generated scenes (default: twelve generated ones)"},
           {"techniques", "LIST", "which (default: all)"},
           {"budgets", "T1,T2,...", "seconds from the first step (default: 0.25,0.5,1,2,4,8)", false, "budget"},
           {"steps", "N1,N2,...", "passes instead of seconds: the same pictures on every run", false, "budget"},
           {"size", "WxH", "pixels (default: 256x256)"},
           {"seeds", "N", "runs of each, from seed 0 on; two or more tell noise from bias (default: 3)"},
           {"set", "[technique.]name=value", "a parameter, of all that have it or of one", true},
           {"references", "DIR", "where references are kept and looked for (default: OUTPUT/references)"},
           {"reference-seconds", "S", "most time for one scene's reference (default: 200)"},
           {"pictures", "LIST.csv", "another renderer's pictures, lines of scene,name,seconds,file.exr: more curves"},
           {"hard-cases", "FILE.json", "what the tests left in BUILD/hard_cases.json: a table of hard cases"},
           {"convergence", "SEEDS", "also slope and spread of unbiased techniques: 64x64 pixels, 4 to 64 samples"},
           {"ablation", "", "also time per step with everything at work against only what each scene needs"},
           {"growth", "", "also time per step and memory against triangles, lights, points, pixels of made scenes"}}};
}

Result<BenchOptions> benchOptions(const Arguments& arguments) {
  BenchOptions options;
  for (const auto read : {readSizes, readTechniques, readBudgets, readSettings, readPlaces, readScenes})
    if (Result<void> done = read(arguments, options); !done) return done.error();
  return options;
}

std::vector<std::pair<std::string, double>> parametersOf(const TechniqueInfo& technique,
                                                         const std::vector<Setting>& settings) {
  std::vector<std::pair<std::string, double>> parameters;
  for (const ParameterInfo& parameter : technique.parameters) {
    std::optional<double> value;
    if (parameter.name == kAdaptive) value = 0.0;
    for (const Setting& setting : settings)
      if (setting.parameter == parameter.name && (setting.technique.empty() || setting.technique == technique.name))
        value = setting.value;
    if (value) parameters.emplace_back(parameter.name, *value);
  }
  return parameters;
}

void setParameter(std::vector<std::pair<std::string, double>>& parameters, const std::string& name, double value) {
  std::erase_if(parameters, [&](const auto& entry) { return entry.first == name; });
  parameters.emplace_back(name, value);
}

void putOffTheEnd(std::vector<std::pair<std::string, double>>& parameters, const TechniqueInfo& technique) {
  for (const ParameterInfo& parameter : technique.parameters)
    if (parameter.name == kMaxSamples) setParameter(parameters, parameter.name, parameter.maximum);
}

}  // namespace limn::bench
