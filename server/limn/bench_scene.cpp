#include "server/limn/bench_scene.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "renderer/film/exr.hpp"
#include "renderer/vk/device.hpp"
#include "server/limn/bench_ablation.hpp"
#include "server/limn/bench_page.hpp"
#include "server/limn/bench_reference.hpp"
#include "server/limn/hex_text.hpp"

namespace limn::bench {
namespace {

constexpr double kFirstShare = 1.0 / 16.0;  // of the time for the reference, before its noise is first looked at

/// A peer's picture and its place on the curve.
struct PeerPoint {
  std::string renderer;
  double seconds = 0.0;
  RadianceImage picture;
};

Result<std::vector<PeerPoint>> loadPeers(const std::string& scene, const std::vector<PeerPicture>& pictures) {
  std::vector<PeerPoint> points;
  for (const PeerPicture& entry : pictures) {
    if (entry.scene != scene) continue;
    const Result<FilmImage> image = readExr(entry.file);
    if (!image) return image.error();
    const Result<RadianceView> radiance = radianceOf(*image, entry.file);
    if (!radiance) return radiance.error();
    points.push_back({entry.renderer, entry.seconds, imageOf(*radiance)});
  }
  return points;
}

/// What is measured on one scene, on its way to a SceneResult.
class SceneBench {
 public:
  SceneBench(vk::Device& device, const std::string& file, const BenchOptions& options)
      : m_device(device), m_file(file), m_options(options) {}

  Result<SceneResult> run(const std::vector<PeerPicture>& pictures) {
    if (Result<void> done = load(pictures); !done) return done.error();
    if (Result<void> done = measureAll(); !done) return done.error();
    if (m_options.ablation)
      if (Result<void> done = measureAblations(); !done) return done.error();
    if (m_options.convergence > 0)
      if (Result<void> done = measureConvergences(); !done) return done.error();
    Result<ReferencePictures> reference = makeReference();
    if (!reference) return reference.error();
    if (Result<void> done = reportCurves(*reference); !done) return done.error();
    if (Result<void> done = drawPictures(*reference); !done) return done.error();
    for (Run& run : m_result.runs)
      for (Checkpoint& checkpoint : run.checkpoints) checkpoint.picture = {};
    return std::move(m_result);
  }

 private:
  Result<void> load(const std::vector<PeerPicture>& pictures) {
    Result<LoadedScene> loaded = loadGltf(m_file);
    if (!loaded) return loaded.error();
    m_loaded = loaded.take();
    m_result.name = std::filesystem::path(m_file).stem().string();
    m_result.file = m_file;
    m_result.hash = hexText(m_loaded.scene.hash());
    m_result.triangles = m_loaded.report.instancedTriangles;
    for (const LoadReport::Item& item : m_loaded.report.unsupported) m_result.unsupported.push_back(item.feature);
    Result<std::vector<PeerPoint>> peers = loadPeers(m_result.name, pictures);
    if (!peers) return peers.error();
    m_peers = peers.take();
    return {};
  }

  SessionConfig configOf(const std::string& technique) const {
    SessionConfig config;
    config.width = m_options.width;
    config.height = m_options.height;
    config.technique = technique;
    config.parameters = parametersOf(*findTechnique(technique), m_options.settings);
    return config;
  }

  Result<void> measureAblations() {
    for (const std::string& name : m_options.techniques) {
      SessionConfig config = configOf(name);
      putOffTheEnd(config.parameters, *findTechnique(name));
      Result<Ablation> ablation = measureAblation(m_device, m_loaded, config);
      if (!ablation) return ablation.error();
      m_result.ablations.push_back(ablation.take());
    }
    return {};
  }

  /// A biased technique's error does not go on falling with the samples.
  Result<void> measureConvergences() {
    for (const std::string& technique : m_options.techniques) {
      if (findTechnique(technique)->biased) continue;
      Result<Convergence> measured =
          measureConvergence(m_device, m_loaded, m_options, m_result.name, configOf(technique));
      if (!measured) return measured.error();
      m_result.convergences.push_back(measured.take());
    }
    return {};
  }

  Result<void> measureAll() {
    for (const std::string& name : m_options.techniques)
      for (uint32_t seed = 0; seed < m_options.seeds; ++seed) {
        SessionConfig config = configOf(name);
        config.seed = seed;
        Result<Run> run = measureRun(m_device, m_loaded, config, m_options.budgets);
        if (!run) return run.error();
        m_result.runs.push_back(run.take());
      }
    return {};
  }

  /// The smallest error that will be reported, as far as the reference can tell by now.
  Result<double> smallestError(const ReferencePictures& reference) {
    if (Result<void> done = compareRuns(m_result.runs, reference.reference()); !done) return done.error();
    double smallest = std::numeric_limits<double>::infinity();
    for (const Run& run : m_result.runs)
      for (const Checkpoint& checkpoint : run.checkpoints) smallest = std::min(smallest, checkpoint.relMse);
    return smallest;
  }

  /// Of the reference's own technique. Where light comes by rare paths a noise that is estimated from few samples
  /// deceives, but it does fall with their number.
  double mostSamplesOfJudge() const {
    double most = 0.0;
    for (const Run& run : m_result.runs)
      if (run.technique == referenceConfig(m_options).technique)
        for (const Checkpoint& checkpoint : run.checkpoints) most = std::max(most, checkpoint.samples);
    return most;
  }

  /// 0: the reference is fine enough. Infinity: what it is to be finer than is no positive number, for its noise is too large.
  double secondsMissing(const ReferencePictures& reference, double smallest) const {
    if (!(smallest > 0.0)) return std::numeric_limits<double>::infinity();
    const double byNoise = reference.noise() / smallest, bySamples = mostSamplesOfJudge() / double(reference.samples());
    return std::max(kReferenceMargin * std::max(byNoise, bySamples) - 1.0, 0.0) * reference.seconds();
  }

  /// Samples until the reference's noise is small beside every error, or its time is over. What an earlier benchmark
  /// kept is not made again.
  Result<ReferencePictures> makeReference() {
    Result<ReferencePictures> opened =
        ReferencePictures::open(m_options.references, m_result.name, m_loaded, referenceConfig(m_options));
    if (!opened) return opened.error();
    ReferencePictures reference = opened.take();
    double spent = 0.0, next = m_options.referenceSeconds * kFirstShare;
    for (bool first = reference.empty();; first = false) {
      if (!first) {
        const Result<double> smallest = smallestError(reference);
        if (!smallest) return smallest.error();
        m_result.smallestError = *smallest;
        m_result.referenceMissing = secondsMissing(reference, *smallest);
        if (m_result.referenceMissing == 0.0 || spent >= m_options.referenceSeconds * 0.99) break;
      }
      const double before = reference.seconds();
      if (Result<void> done = reference.refine(m_device, m_loaded, next); !done) return done.error();
      spent += reference.seconds() - before;
      if (Result<void> done = reference.save(); !done) return done.error();
      next = std::clamp(m_options.referenceSeconds - spent, 0.0, std::max(spent, next));
    }
    m_result.referenceSamples = reference.samples();
    m_result.referenceSeconds = reference.seconds();
    m_result.referenceNoise = reference.noise();
    return reference;
  }

  Result<void> reportCurves(const ReferencePictures& reference) {
    Result<std::vector<Curve>> curves = makeCurves(m_result.runs, m_options.budgets, reference.reference());
    if (!curves) return curves.error();
    m_result.curves = curves.take();
    for (const PeerPoint& peer : m_peers)
      if (Result<void> done = addPeer(peer, reference); !done) return done;
    for (Curve& curve : m_result.curves)
      if (curve.times.empty()) finishCurve(curve);
    return {};
  }

  Result<void> addPeer(const PeerPoint& peer, const ReferencePictures& reference) {
    const Result<ErrorMetrics> metrics = compareImages(peer.picture.view(), reference.reference());
    if (!metrics) return metrics.error();
    CurvePoint point;
    point.budget = "peer";
    point.seconds = peer.seconds;
    point.gatheredShare = 1.0;
    point.relMse = metrics->relMse;
    point.relMseAll = metrics->relMseAll;
    const auto same = [&](const Curve& curve) { return curve.technique == peer.renderer; };
    auto curve = std::find_if(m_result.curves.begin(), m_result.curves.end(), same);
    if (curve == m_result.curves.end())
      curve = m_result.curves.insert(curve, Curve{peer.renderer, {}, {}, {}, {}, "", "", ""});
    curve->points.push_back(point);
    return {};
  }

  /// First and last picture and heat map of a curve.
  Result<void> draw(Curve& curve, const RadianceImage& first, const RadianceImage& last, const RadianceImage& truth) {
    const double exposure = exposureFor(truth);
    Result<std::string> firstPng = picturePng(first, exposure), lastPng = picturePng(last, exposure);
    Result<std::string> heat = heatPng(last, truth);
    for (const Result<std::string>* png : {&firstPng, &lastPng, &heat})
      if (!*png) return png->error();
    curve.firstPng = firstPng.take();
    curve.lastPng = lastPng.take();
    curve.heatPng = heat.take();
    return {};
  }

  Result<void> drawPictures(const ReferencePictures& reference) {
    Result<std::string> png = picturePng(reference.mean(), exposureFor(reference.mean()));
    if (!png) return png.error();
    m_result.referencePng = png.take();
    for (Curve& curve : m_result.curves) {
      const RadianceImage *first = nullptr, *last = nullptr;
      for (const Run& run : m_result.runs)
        if (run.technique == curve.technique && run.seed == 0)
          first = &run.checkpoints.front().picture, last = &run.checkpoints.back().picture;
      for (const PeerPoint& peer : m_peers)
        if (peer.renderer == curve.technique) first = first ? first : &peer.picture, last = &peer.picture;
      if (!first) continue;
      if (Result<void> done = draw(curve, *first, *last, reference.mean()); !done) return done;
    }
    return {};
  }

  vk::Device& m_device;
  const std::string& m_file;
  const BenchOptions& m_options;
  LoadedScene m_loaded;
  std::vector<PeerPoint> m_peers;
  SceneResult m_result;
};

}  // namespace

Result<SceneResult> measureScene(vk::Device& device, const std::string& file, const BenchOptions& options,
                                 const std::vector<PeerPicture>& peers) {
  Result<SceneResult> result = SceneBench(device, file, options).run(peers);
  if (result || !result.error().place.empty()) return result;
  Error error = result.error();
  error.place = file;
  return error;
}

}  // namespace limn::bench
