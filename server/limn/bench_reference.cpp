#include "server/limn/bench_reference.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "renderer/base/check.hpp"
#include "renderer/base/clock.hpp"
#include "renderer/base/hash.hpp"
#include "renderer/film/exr.hpp"
#include "renderer/techniques/path_tracing.hpp"
#include "server/limn/hex_text.hpp"
#include "server/limn/render_stats.hpp"
#include "shaders/embedded_shaders.hpp"

namespace limn::bench {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kSeeds[2] = {0x7fff0001u, 0x7fff0002u};  // of the halves; runs have small ones
constexpr const char* kKey = "limn:reference";

/// Of the path tracer's code: another model of light makes other references.
std::string modelKey() {
  const std::span<const uint32_t> words = embeddedShader("path_tracing");
  LIMN_CHECK(!words.empty());
  return hexText(fnv1a(words.data(), words.size_bytes()));
}

/// Everything that decides what the reference converges to.
std::string keyOf(const LoadedScene& loaded, const SessionConfig& config) {
  RenderStats stats;
  stats.sceneHash = loaded.scene.hash();
  stats.config = config;
  std::string key = modelKey() + " " + std::to_string(config.width) + "x" + std::to_string(config.height);
  for (const auto& [name, value] : filmMetadata(stats, loaded.scene.view, 0.0))
    for (const char* part : {"limn:sceneHash", "limn:view", "limn:parameters", "limn:version"})
      if (name == part) key += " " + value;
  return key;
}

std::string metadataOf(const FilmImage& image, const std::string& key) {
  for (const auto& [name, value] : image.metadata)
    if (name == key) return value;
  return "";
}

struct HalfSamples {
  RadianceImage picture;
  uint64_t samples = 0;                ///< of every pixel
  uint32_t passes = 0;
};

/// Whole passes from sample `config.firstSample` on: `passes`, or as many as begin within `seconds` when that is 0.
Result<HalfSamples> takeSamples(vk::Device& device, const LoadedScene& loaded, const SessionConfig& config,
                                uint32_t passes, double seconds) {
  Result<std::unique_ptr<BenchSession>> made = BenchSession::create(device, loaded, config);
  if (!made) return made.error();
  Session& session = ***made;
  HalfSamples half;
  const double end = nowSeconds() + seconds;
  do {
    half.passes = passes > 0 ? passes : half.passes + 1;
    if (Result<void> done = session.runSteps(half.passes); !done) return done.error();
  } while (passes == 0 && nowSeconds() < end);
  Result<SampledPicture> shown = readPicture(session);
  if (!shown) return shown.error();
  half.samples = uint64_t(*std::min_element(shown->samples.begin(), shown->samples.end()));
  half.picture = std::move(shown->picture);
  return half;
}

/// `into` holds `before` samples a pixel; adds those of `half`.
void addSamples(RadianceImage& into, uint64_t before, const HalfSamples& half) {
  if (before == 0) {
    into = half.picture;
    return;
  }
  const double share = double(half.samples) / double(before + half.samples);
  for (size_t i = 0; i < into.values.size(); ++i)
    into.values[i] = float(into.values[i] + (double(half.picture.values[i]) - into.values[i]) * share);
}

}  // namespace

SessionConfig referenceConfig(const BenchOptions& options) {
  const TechniqueInfo& judge = pathTracingInfo();
  SessionConfig config;
  config.width = options.width;
  config.height = options.height;
  config.technique = judge.name;
  config.parameters = parametersOf(judge, options.settings);
  setParameter(config.parameters, "adaptive", 0.0);
  putOffTheEnd(config.parameters, judge);
  return config;
}

Result<ReferencePictures> ReferencePictures::open(const std::string& directory, const std::string& name,
                                                  const LoadedScene& loaded, const SessionConfig& config) {
  std::error_code problem;
  fs::create_directories(directory, problem);
  if (problem) return Error{"io", problem.message(), directory};
  ReferencePictures pictures;
  pictures.m_config = config;
  pictures.m_key = keyOf(loaded, config);
  pictures.m_stem = (fs::path(directory) / (name + "-" + hexText(fnv1a(pictures.m_key)))).string();
  if (Result<void> done = pictures.load(); !done) return done.error();
  return pictures;
}

std::array<std::string, 2> ReferencePictures::files() const {
  return {m_stem + ".half0.exr", m_stem + ".half1.exr"};
}

Result<void> ReferencePictures::load() {
  uint64_t counts[2] = {};
  double seconds[2] = {};
  for (size_t i = 0; i < 2; ++i) {
    std::error_code problem;
    if (!fs::is_regular_file(files()[i], problem)) return {};
    const Result<FilmImage> image = readExr(files()[i]);
    if (!image) return image.error();
    const Result<RadianceView> radiance = radianceOf(*image, files()[i]);
    if (!radiance) return radiance.error();
    const bool readable = parseInteger(metadataOf(*image, "limn:referenceSamples"), counts[i]) &&
                          parseReal(metadataOf(*image, "limn:referenceSeconds"), seconds[i]);
    if (!readable || metadataOf(*image, kKey) != m_key) return {};
    m_halves[i] = imageOf(*radiance);
  }
  if (counts[0] != counts[1]) return {};  // written by two programs at once; made anew
  m_samples = 2 * counts[0];
  m_seconds = seconds[0] + seconds[1];
  updateMean();
  return {};
}

Result<void> ReferencePictures::refine(vk::Device& device, const LoadedScene& loaded, double seconds) {
  const double begin = nowSeconds();
  const uint64_t before = m_samples / 2;
  uint32_t passes = 0;
  for (size_t i = 0; i < 2; ++i) {
    SessionConfig config = m_config;
    config.seed = kSeeds[i];
    config.firstSample = uint32_t(before);
    const Result<HalfSamples> half = takeSamples(device, loaded, config, passes, seconds / 2.0);
    if (!half) return half.error();
    passes = half->passes;
    addSamples(m_halves[i], before, *half);
    m_samples += half->samples;
  }
  m_seconds += nowSeconds() - begin;
  updateMean();
  return {};
}

Result<void> ReferencePictures::save() const {
  for (size_t i = 0; i < 2; ++i) {
    FilmImage image{m_halves[i].width, m_halves[i].height, {{"beauty", 3, m_halves[i].values}}, {}};
    image.metadata = {{kKey, m_key},
                      {"limn:referenceSamples", std::to_string(m_samples / 2)},
                      {"limn:referenceSeconds", std::to_string(m_seconds / 2.0)}};
    if (Result<void> written = writeExr(files()[i], image); !written) return written;
  }
  return {};
}

void ReferencePictures::updateMean() {
  m_mean = m_halves[0];
  for (size_t i = 0; i < m_mean.values.size(); ++i)
    m_mean.values[i] = 0.5f * (m_halves[0].values[i] + m_halves[1].values[i]);
}

double ReferencePictures::noise() const {
  if (empty()) return std::numeric_limits<double>::infinity();
  // A half differs from the mean by as much as the mean errs: ((h0 - h1) / 2)² has the mean's variance.
  const Result<ErrorMetrics> metrics = compareImages(m_halves[0].view(), {m_mean.view(), {}, {}});
  return metrics ? metrics->relMse : std::numeric_limits<double>::infinity();
}

Reference ReferencePictures::reference() const { return {m_mean.view(), m_halves[0].view(), m_halves[1].view()}; }

}  // namespace limn::bench
