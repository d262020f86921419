#include "tests/bench/projection_light.hpp"

#include "renderer/scene/scene_needs.hpp"
#include "server/limn/bench_page.hpp"
#include "server/limn/bench_run.hpp"
#include "tests/bench/projection_pictures.hpp"

namespace limn::projection {
namespace {

constexpr uint32_t kSeeds[2] = {11, 12};  // of the path tracer's halves
constexpr uint32_t kOverviewPasses = 8;
constexpr float kDifferenceFactor = 2.0f;  // as the paper shows it
constexpr uint32_t kFilterSizes[] = {7, 1};

/// Bounces of the technique and of paths that see the same light.
struct Bounces {
  uint32_t technique, paths;
};

std::vector<Bounces> bouncesFor(const SceneNeeds& needs) {
  if (needs.sharp) return {{8, 16}};
  return {{1, 1}, {3, 3}};
}

SessionConfig configOf(const ValidationOptions& options, const char* technique) {
  SessionConfig config;
  config.width = options.size.width;
  config.height = options.size.height;
  config.technique = technique;
  return config;
}

Result<FilmImage> filmOf(vk::Device& device, const LoadedScene& loaded, const SessionConfig& config) {
  auto session = bench::BenchSession::create(device, loaded, config);
  if (!session) return session.error();
  if (auto done = (**session)->runSteps(config.sampleCount); !done) return done.error();
  return (**session)->readFilm();
}

Result<RadianceImage> indirectOf(vk::Device& device, const LoadedScene& loaded, const SessionConfig& config) {
  const auto film = filmOf(device, loaded, config);
  if (!film) return film.error();
  return layerOf(*film, "indirect");
}

/// Indirect light of paths twice, independently.
struct Halves {
  RadianceImage a, b, mean;
};

Result<Halves> pathsOf(vk::Device& device, const LoadedScene& loaded, const ValidationOptions& options,
                       uint32_t bounces) {
  SessionConfig config = configOf(options, "path-tracing");
  config.sampleCount = options.pathSamples;
  config.parameters = {{"adaptive", 0.0}, {"maxBounces", double(bounces)}};
  std::vector<RadianceImage> halves;
  for (const uint32_t seed : kSeeds) {
    config.seed = seed;
    auto half = indirectOf(device, loaded, config);
    if (!half) return half.error();
    halves.push_back(half.take());
  }
  const RadianceImage mean = meanOf(halves[0], halves[1]);
  return Halves{halves[0], halves[1], mean};
}

Result<void> measure(const RadianceImage& picture, const Halves& truth, LightReport& report) {
  const auto error = compareImages(picture.view(), {truth.mean.view(), truth.a.view(), truth.b.view()});
  const auto noise = compareImages(truth.a.view(), {truth.b.view(), {}, {}});
  if (!error || !noise) return error ? noise.error() : error.error();
  report.relMse = error->relMse;
  report.relMseAll = error->relMseAll;
  report.pathNoise = noise->relMse / 4.0;  // the mean of two has half the variance of one, their difference twice
  report.energy = meanValue(picture) / meanValue(truth.mean);
  return {};
}

Result<void> draw(const RadianceImage& picture, const RadianceImage& truth, const std::string& stem,
                  LightReport& report) {
  const double exposure = bench::exposureFor(truth);
  const RadianceImage difference = differenceOf(picture, truth, kDifferenceFactor);
  const struct {
    const char *ending, *caption;
    const RadianceImage& image;
  } kPictures[] = {{"-technique.png", "point projection", picture},
                   {"-paths.png", "path tracing", truth},
                   {"-difference.png", "difference, twice", difference}};
  for (const auto& [ending, caption, image] : kPictures) {
    auto drawn = pictureOf(stem + ending, caption, image, exposure);
    if (!drawn) return drawn.error();
    report.pictures.push_back(drawn.take());
  }
  return {};
}

Result<LightReport> compareLight(vk::Device& device, const LoadedScene& loaded, const std::string& name,
                                 const ValidationOptions& options, const Halves& truth, LightReport report) {
  SessionConfig config = configOf(options, "point-projection");
  config.firstSample = 1;  // sample 0 goes through the middle of the pixel
  config.sampleCount = options.passes;
  config.parameters = {{"bounces", double(report.bounces)},
                       {"filterSize", double(report.filterSize)},
                       {"projections", double(options.projections)},
                       {"points", double(options.points)}};
  const auto picture = indirectOf(device, loaded, config);
  if (!picture) return picture.error();
  if (auto done = measure(*picture, truth, report); !done) return done.error();
  const std::string stem =
      name + "-bounces-" + std::to_string(report.bounces) + "-filter-" + std::to_string(report.filterSize);
  if (auto done = draw(*picture, truth.mean, stem, report); !done) return done.error();
  return report;
}

}  // namespace

Result<RadianceImage> beautyOf(vk::Device& device, const LoadedScene& loaded, const ValidationOptions& options) {
  SessionConfig config = configOf(options, "point-projection");
  config.sampleCount = kOverviewPasses;
  const auto film = filmOf(device, loaded, config);
  if (!film) return film.error();
  return layerOf(*film, "beauty");
}

Result<std::vector<LightReport>> reportLight(vk::Device& device, const LoadedScene& loaded, const std::string& name,
                                             const ValidationOptions& options) {
  std::vector<LightReport> reports;
  for (const Bounces bounces : bouncesFor(sceneNeeds(loaded.scene))) {
    const auto truth = pathsOf(device, loaded, options, bounces.paths);
    if (!truth) return truth.error();
    for (const uint32_t filterSize : kFilterSizes) {
      LightReport begun;
      begun.bounces = bounces.technique;
      begun.pathBounces = bounces.paths;
      begun.filterSize = filterSize;
      auto report = compareLight(device, loaded, name, options, *truth, begun);
      if (!report) return report.error();
      reports.push_back(report.take());
    }
  }
  return reports;
}

}  // namespace limn::projection
