#include <cstdio>
#include <filesystem>

#include "renderer/base/clock.hpp"
#include "renderer/base/file_bytes.hpp"
#include "renderer/vk/device.hpp"
#include "server/limn/bench_figures.hpp"
#include "server/limn/bench_growth.hpp"
#include "server/limn/bench_page.hpp"
#include "server/limn/bench_plots.hpp"
#include "server/limn/bench_scene.hpp"
#include "server/limn/cache_directory.hpp"
#include "server/limn/commands.hpp"
#include "server/limn/output_file.hpp"

namespace limn {
namespace {

using namespace bench;

Result<void> writeText(const std::string& file, const std::string& text) {
  return writeFileAtomically(file, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

void printScene(const SceneResult& scene) {
  std::printf("%s: reference of %llu samples, noise %.2g", scene.name.c_str(),
              static_cast<unsigned long long>(scene.referenceSamples), scene.referenceNoise);
  if (scene.referenceMissing > 0.0) std::printf(", 20 times finer than the runs in %.0f s more", scene.referenceMissing);
  std::printf("\n");
  for (const Curve& curve : scene.curves) {
    std::printf("  %-18s", curve.technique.c_str());
    for (const CurvePoint& point : curve.points) std::printf("  %.2f s %.2e", point.seconds, point.relMse);
    if (curve.slope) std::printf("  slope %.3f", curve.slope->exponent);
    std::printf("\n");
    if (curve.points.empty() || !curve.points.back().parts) continue;
    const CurvePoint& last = curve.points.back();
    std::printf("  %-18s  at the end: noise %.2e, bias squared %.1e +- %.1e, spread of seeds %.1f %%, told %.1f %%\n",
                "", last.parts->noise, last.parts->biasSquared, 1.96 * last.parts->biasDeviation, 100.0 * last.spread,
                100.0 * last.toldSpread);
  }
  for (const Convergence& c : scene.convergences) {
    if (c.own.slopeAll && c.spread)
      std::printf("  %-18s  %u seeds: slope of every quotient %.3f +- %.3f, variance between seeds over told %.2f\n",
                  c.technique.c_str(), c.seeds, c.own.slopeAll->exponent, c.own.slopeAll->deviation, c.spread->ratio());
    if (c.independent && c.independent->slopeAll)
      std::printf("  %-18s  independent samples: slope %.3f +- %.3f, %.2f times the error\n", "",
                  c.independent->slopeAll->exponent, c.independent->slopeAll->deviation, *c.gain());
  }
  std::fflush(stdout);
}

void printSummary(const BenchResults& results) {
  for (const TechniqueCalibration& c : results.calibrations)
    std::printf("%s: %.0f %% of %zu intervals hold the error, median of estimate / error %.3f (%zu left out)\n",
                c.technique.c_str(), 100.0 * c.trimmed.heldShare, c.trimmed.count, c.trimmed.medianRatio, c.leftOut);
  for (const SceneResult& scene : results.scenes)
    for (const Ablation& a : scene.ablations)
      std::printf("%s, %s: %.3g s a step, %.3g s with everything at work: %.2f times as long\n", scene.name.c_str(),
                  a.technique.c_str(), a.needed.stepSeconds, a.all.stepSeconds,
                  a.all.stepSeconds / a.needed.stepSeconds);
  for (const Growth& g : results.growth)
    if (g.time && g.first && g.memory)
      std::printf("%s: time per step grows with %s to the %.2f, the first steps to the %.2f, memory to the %.2f\n",
                  g.technique.c_str(), g.axis.c_str(), g.time->exponent, g.first->exponent, g.memory->exponent);
  for (const std::string& sentence : results.absent) std::printf("%s\n", sentence.c_str());
}

/// Tables, plots and page. Plots come before the page, which holds them.
Result<void> writeReport(BenchResults& results) {
  const std::filesystem::path output = results.options.output;
  const Result<bool> drawn = drawPlots(plotsOf(results), output.string());
  if (!drawn) return drawn.error();
  if (!*drawn)
    results.absent.push_back("The plots are absent: gnuplot is not installed or failed; plots.gnuplot is there.");
  if (Result<void> done = writeText((output / "results.csv").string(), resultsCsv(results)); !done) return done;
  if (Result<void> done = writeText((output / "results.json").string(), resultsJson(results)); !done) return done;
  if (Result<void> done = writeText((output / "figures.md").string(), resultsFigures(results)); !done) return done;
  return writeText((output / "index.html").string(), resultsPage(results, output.string()));
}

/// After an error `results` holds what was done before it.
Result<void> measure(BenchResults& results) {
  const BenchOptions& options = results.options;
  const Result<std::vector<PeerPicture>> peers = readPeerPictures(options.pictures);
  if (!peers) return peers.error();
  if (peers->empty())
    results.absent.push_back("No other renderer's pictures were given with --pictures; tests/bench/peers makes some.");
  Result<std::vector<HardCell>> hardCases = readHardCases(options.hardCases);
  if (!hardCases) return hardCases.error();
  results.hardCases = hardCases.take();
  if (results.hardCases.empty())
    results.absent.push_back("The hard cases are absent: --hard-cases takes the file that the tests leave behind.");
  vk::DeviceOptions deviceOptions;
  deviceOptions.cacheDir = cacheDirectory();
  const Result<std::unique_ptr<vk::Device>> device = vk::Device::open(deviceOptions);
  if (!device) return device.error();
  results.device = (*device)->info().name;
  results.driver = (*device)->info().driver;
  for (const std::string& file : options.scenes) {
    Result<SceneResult> scene = measureScene(**device, file, options, *peers);
    if (!scene) return scene.error();
    printScene(*scene);
    results.scenes.push_back(scene.take());
  }
  if (!options.growth) return {};
  Result<std::vector<Growth>> growth = measureGrowth(**device, options);
  if (!growth) return growth.error();
  results.growth = growth.take();
  return {};
}

Result<void> run(const Arguments& arguments) {
  Result<BenchOptions> options = benchOptions(arguments);
  if (!options) return options.error();
  std::error_code problem;
  std::filesystem::create_directories(options->output, problem);
  if (problem) return Error{"io", problem.message(), options->output};
  const std::filesystem::path page = std::filesystem::path(options->output) / "index.html";
  if (Result<void> writable = checkWritable(page); !writable) return writable;
  BenchResults results;
  results.options = options.take();
  results.version = LIMN_VERSION;
  const double begin = nowSeconds();
  const Result<void> measured = measure(results);
  if (!measured && results.scenes.empty()) return measured;
  if (!measured) results.absent.push_back("The benchmark ended early. " + measured.error().text());
  results.seconds = nowSeconds() - begin;
  results.calibrations = calibrateAll(results.scenes);
  const Result<void> written = writeReport(results);
  if (written) printSummary(results);
  if (measured) return written;
  if (!written) reportFailure("limn bench", written.error());
  return measured;
}

}  // namespace

Command benchCommand() { return {benchSpec(), run}; }

}  // namespace limn
