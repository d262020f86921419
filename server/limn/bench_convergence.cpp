#include "server/limn/bench_convergence.hpp"

#include <algorithm>

#include "renderer/vk/device.hpp"
#include "server/limn/bench_reference.hpp"
#include "server/limn/bench_statistics.hpp"

namespace limn::bench {
namespace {

constexpr double kFirstReferenceSeconds = 1.0;  // its rate is not known before
constexpr const char* kSobol = "sobol";

/// One seed: its picture whenever a multiple of kFewestSamples is reached, and what the film says of the last.
struct SeedRun {
  std::vector<RunningMean> means;
  double estimate = 0.0;               ///< relMSE
};

Result<RunningMean> runningMean(Session& session) {
  Result<SampledPicture> shown = readPicture(session);
  if (!shown) return shown.error();
  const auto [least, most] = std::minmax_element(shown->samples.begin(), shown->samples.end());
  if (*least != *most) return Error{"bad-image", "pixels have different numbers of samples", ""};
  return RunningMean{uint64_t(*least), std::move(shown->picture)};
}

Result<SeedRun> runSeed(vk::Device& device, const LoadedScene& loaded, const SessionConfig& config) {
  Result<std::unique_ptr<BenchSession>> made = BenchSession::create(device, loaded, config);
  if (!made) return made.error();
  Session& session = ***made;
  SeedRun run;
  uint64_t samples = 0;
  for (uint32_t step = 1; samples < kMostSamples; ++step) {
    if (Result<void> done = session.runSteps(step); !done) return done.error();
    Result<RunningMean> mean = runningMean(session);
    if (!mean) return mean.error();
    samples = mean->samples;
    if (samples % kFewestSamples == 0) run.means.push_back(mean.take());
  }
  const Result<Status> status = session.status();
  if (!status) return status.error();
  run.estimate = status->estimatedError;
  return run;
}

Result<std::vector<SeedRun>> runSeeds(vk::Device& device, const LoadedScene& loaded, SessionConfig config, uint32_t seeds) {
  std::vector<SeedRun> runs;
  for (config.seed = 0; config.seed < seeds; ++config.seed) {
    Result<SeedRun> run = runSeed(device, loaded, config);
    if (!run) return run.error();
    runs.push_back(run.take());
  }
  return runs;
}

/// Of the technique with each sample independent of all others; nothing where it has no such choice.
std::optional<SessionConfig> independentOf(SessionConfig config) {
  const auto isSobol = [](const ParameterInfo& parameter) { return parameter.name == kSobol; };
  const std::vector<ParameterInfo>& known = findTechnique(config.technique)->parameters;
  if (std::none_of(known.begin(), known.end(), isSobol)) return std::nullopt;
  std::erase_if(config.parameters, [](const auto& entry) { return entry.first == kSobol; });
  config.parameters.emplace_back(kSobol, 0.0);
  return config;
}

/// Halves whose noise is small beside that of the runs' own pictures, which is all that their product needs.
Result<ReferencePictures> makeReference(vk::Device& device, const LoadedScene& loaded, const BenchOptions& options,
                                        const std::string& name) {
  SessionConfig config = referenceConfig(options);
  config.width = config.height = kConvergenceSide;
  Result<ReferencePictures> opened = ReferencePictures::open(options.references, name, loaded, config);
  if (!opened) return opened.error();
  ReferencePictures reference = opened.take();
  const double wanted = double(options.convergence) * double(kMostSamples);
  double seconds = kFirstReferenceSeconds;
  while (double(reference.samples()) < wanted) {
    if (Result<void> done = reference.refine(device, loaded, seconds); !done) return done.error();
    if (Result<void> done = reference.save(); !done) return done.error();
    const double left = wanted / double(reference.samples()) - 1.0;
    seconds = std::max(0.0, left * reference.seconds());
  }
  return reference;
}

/// Errors of one seed at one level: means over its blocks.
Result<Convergence::Level> errorOfBlocks(const SeedRun& run, uint64_t samples, const Reference& reference) {
  Convergence::Level level{double(samples), 0.0, 0.0};
  const std::vector<RadianceImage> blocks = blockMeans(run.means, samples);
  for (const RadianceImage& block : blocks) {
    const Result<ErrorMetrics> metrics = compareImages(block.view(), reference);
    if (!metrics) return metrics.error();
    level.relMse += metrics->relMse / double(blocks.size());
    level.relMseAll += metrics->relMseAll / double(blocks.size());
  }
  return level;
}

Result<Convergence::Fall> fallOf(const std::vector<SeedRun>& runs, const Reference& reference) {
  Convergence::Fall result;
  std::vector<double> samples;
  std::vector<std::vector<double>> trimmed(runs.size()), all(runs.size());
  for (uint64_t n = kFewestSamples; n <= kMostSamples; n *= 2) {
    Convergence::Level mean{double(n), 0.0, 0.0};
    for (size_t seed = 0; seed < runs.size(); ++seed) {
      const Result<Convergence::Level> level = errorOfBlocks(runs[seed], n, reference);
      if (!level) return level.error();
      trimmed[seed].push_back(level->relMse);
      all[seed].push_back(level->relMseAll);
      mean.relMse += level->relMse / double(runs.size());
      mean.relMseAll += level->relMseAll / double(runs.size());
    }
    result.levels.push_back(mean);
    samples.push_back(mean.samples);
  }
  result.slope = slopeOfSeeds(samples, trimmed);
  result.slopeAll = slopeOfSeeds(samples, all);
  return result;
}

Result<std::optional<SeedSpread>> lastSpread(const std::vector<SeedRun>& runs, const Reference& reference) {
  std::vector<RadianceView> pictures;
  std::vector<double> estimates;
  for (const SeedRun& run : runs) {
    pictures.push_back(run.means.back().picture.view());
    estimates.push_back(run.estimate);
  }
  return spreadOfSeeds(pictures, estimates, reference);
}

}  // namespace

std::optional<double> Convergence::gain() const {
  if (!independent || independent->levels.empty() || own.levels.empty()) return std::nullopt;
  return independent->levels.back().relMseAll / own.levels.back().relMseAll;
}

Result<Convergence> measureConvergence(vk::Device& device, const LoadedScene& loaded, const BenchOptions& options,
                                       const std::string& name, SessionConfig config) {
  config.width = config.height = kConvergenceSide;
  config.sampleCount = uint32_t(kMostSamples);
  const Result<std::vector<SeedRun>> runs = runSeeds(device, loaded, config, options.convergence);
  if (!runs) return runs.error();
  const Result<ReferencePictures> reference = makeReference(device, loaded, options, name);
  if (!reference) return reference.error();
  Convergence result;
  result.technique = config.technique;
  result.seeds = options.convergence;
  Result<Convergence::Fall> own = fallOf(*runs, reference->reference());
  if (!own) return own.error();
  result.own = own.take();
  Result<std::optional<SeedSpread>> spread = lastSpread(*runs, reference->reference());
  if (!spread) return spread.error();
  result.spread = spread.take();
  if (const std::optional<SessionConfig> independent = independentOf(config)) {
    const Result<std::vector<SeedRun>> others = runSeeds(device, loaded, *independent, options.convergence);
    if (!others) return others.error();
    Result<Convergence::Fall> fall = fallOf(*others, reference->reference());
    if (!fall) return fall.error();
    result.independent = fall.take();
  }
  return result;
}

}  // namespace limn::bench
