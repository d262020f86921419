// Point projection against truth: micro-buffers against all points, indirect light against paths, and where it gathers
// as time goes by. Writes pictures, results.json and index.html; bench_projection --help tells the rest.
#include <cstdio>
#include <filesystem>

#include "server/limn/cache_directory.hpp"
#include "tests/bench/projection_light.hpp"
#include "tests/bench/projection_micro.hpp"
#include "tests/bench/projection_pictures.hpp"
#include "tests/bench/projection_placement.hpp"
#include "tests/bench/projection_report.hpp"

namespace limn::projection {
namespace {

const CommandSpec kSpec{"bench_projection",
                        "Holds point projection against all points and against paths.",
                        {"OUTPUT"},
                        {{"scenes", "LIST", "files or generated scenes (cornell-box,cornell-glossy,demo)"},
                         {"size", "WxH", "of all pictures (256x256)"},
                         {"points", "N", "on the scene's surfaces (262144)"},
                         {"projections", "N", "a micro-buffer (3072)"},
                         {"path-samples", "N", "of a pixel in each half of the path tracer's pictures (128)"},
                         {"stamps", "LIST", "times at which samples are shown, in seconds (0.25,0.5,1,2,4)"},
                         {"device", "NAME|INDEX", "the Vulkan device"}}};

std::string sceneFile(const std::string& name, const std::filesystem::path& generated) {
  return std::filesystem::exists(name) ? name : (generated / (name + ".glb")).string();
}

Result<std::vector<double>> stampsOf(const Arguments& arguments, std::vector<double> otherwise) {
  if (!arguments.has("stamps")) return otherwise;
  std::vector<double> stamps;
  for (const std::string& text : arguments.list("stamps")) {
    double seconds = 0.0;
    const bool later = parseReal(text, seconds) && seconds > (stamps.empty() ? 0.0 : stamps.back());
    if (!later) return usageError("--stamps takes ascending seconds, not '" + text + "'");
    stamps.push_back(seconds);
  }
  return stamps;
}

Result<ValidationOptions> optionsOf(const Arguments& arguments, const std::filesystem::path& generated) {
  ValidationOptions options;
  options.output = arguments.positionals().front();
  auto names = arguments.has("scenes") ? arguments.list("scenes")
                                       : std::vector<std::string>{"cornell-box", "cornell-glossy", "demo"};
  for (const std::string& name : names) options.scenes.push_back(sceneFile(name, generated));
  const auto size = parsePixelSize(arguments.text("size", "256x256"));
  const auto points = arguments.integer("points", options.points, 16384, 1048576);
  const auto projections = arguments.integer("projections", options.projections, 1024, kMostProjections);
  const auto samples = arguments.integer("path-samples", options.pathSamples, 1, 65536);
  auto stamps = stampsOf(arguments, options.stamps);
  if (!size) return size.error();
  for (const auto* whole : {&points, &projections, &samples})
    if (!*whole) return whole->error();
  if (!stamps) return stamps.error();
  options.size = *size;
  options.points = uint32_t(*points);
  options.projections = uint32_t(*projections);
  options.pathSamples = uint32_t(*samples);
  options.stamps = stamps.take();
  return options;
}

Result<MicroBufferReport> microBuffers(vk::Device& device, const LoadedScene& loaded, const std::string& name,
                                       const ValidationOptions& options) {
  const auto beauty = beautyOf(device, loaded, options);
  if (!beauty) return beauty.error();
  const auto scene = LitScene::create(device, loaded.scene, options.size.width, options.size.height, options.points);
  if (!scene) return scene.error();
  auto report = reportMicroBuffers(**scene, name, options);
  if (!report) return report;
  auto where = markNamedPixels(*beauty, name);
  if (!where) return where.error();
  report->pictures.insert(report->pictures.begin(), where.take());
  return report;
}

Result<SceneReport> validate(vk::Device& device, const std::string& file, const ValidationOptions& options) {
  const auto loaded = loadGltf(file);
  if (!loaded) return loaded.error();
  SceneReport report;
  report.name = std::filesystem::path(file).stem().string();
  auto micro = microBuffers(device, *loaded, report.name, options);
  if (!micro) return micro.error();
  report.microBuffers = micro.take();
  auto placement = reportPlacement(device, *loaded, report.name, options);
  if (!placement) return placement.error();
  report.placement = placement.take();
  auto light = reportLight(device, *loaded, report.name, options);
  if (!light) return light.error();
  report.light = light.take();
  return report;
}

void print(const SceneReport& scene) {
  std::printf("%s\n", scene.name.c_str());
  for (const GatherError& e : scene.microBuffers.errors)
    std::printf("  %-32s relMSE %.2e, relative square %.2e, irradiance %.2e, %.1f %% empty\n", e.way.c_str(), e.texels,
                e.square, e.irradiance, 100.0 * e.holes);
  for (const LightReport& l : scene.light)
    std::printf("  %u bounces, filter of %u: relMSE %.2e (%.2e with every quotient), energy %.3f\n", l.bounces,
                l.filterSize, l.relMse, l.relMseAll, l.energy);
  for (const PlacementReport& p : scene.placement) std::printf("  %s\n", p.picture.caption.c_str());
  std::fflush(stdout);
}

Result<void> run(const Arguments& arguments, const std::filesystem::path& generated) {
  ValidationReport report;
  auto options = optionsOf(arguments, generated);
  if (!options) return options.error();
  report.options = options.take();
  vk::DeviceOptions deviceOptions;
  deviceOptions.select = arguments.text("device");
  deviceOptions.cacheDir = cacheDirectory();
  const auto device = vk::Device::open(deviceOptions);
  if (!device) return device.error();
  report.device = (*device)->info().name;
  for (const std::string& file : report.options.scenes) {
    auto scene = validate(**device, file, report.options);
    if (!scene) return scene.error();
    print(*scene);
    report.scenes.push_back(scene.take());
  }
  return writeReport(report);
}

}  // namespace
}  // namespace limn::projection

int main(int argc, char** argv) {
  using namespace limn;
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto arguments = Arguments::parse(projection::kSpec, words);
  if (!arguments) return reportFailure(projection::kSpec.name, arguments.error());
  if (arguments->help()) return std::fputs(helpText(projection::kSpec).c_str(), stdout) < 0 ? kExitFailed : kExitOk;
  const auto scenes = std::filesystem::canonical(argv[0]).parent_path().parent_path() / "scenes";
  const auto done = projection::run(*arguments, scenes);
  return done ? kExitOk : reportFailure(projection::kSpec.name, done.error());
}
