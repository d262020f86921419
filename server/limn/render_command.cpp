#include <algorithm>
#include <cmath>
#include <cstdio>

#include "renderer/base/clock.hpp"
#include "renderer/film/exr.hpp"
#include "renderer/base/file_bytes.hpp"
#include "renderer/vk/device.hpp"
#include "server/limn/cache_directory.hpp"
#include "server/limn/commands.hpp"
#include "server/limn/interruption.hpp"
#include "server/limn/render_stats.hpp"

namespace limn {
namespace {

void keepLayers(FilmImage& image, const std::vector<std::string>& asked) {
  if (asked.empty()) return;
  std::erase_if(image.layers, [&](const FilmLayer& layer) {
    return layer.name != "beauty" && std::find(asked.begin(), asked.end(), layer.name) == asked.end();
  });
}

/// One render: the boxes that nobody else looks into, and the session between them.
class Render {
 public:
  explicit Render(const RenderOptions& options) : m_options(options) {}

  Result<void> run() {
    if (Result<void> done = load(); !done) return done;
    if (Result<void> done = build(); !done) return done;
    const Interruption interruption;  // before the first pass there is nothing to write, and a signal ends it at once
    Result<RenderOutcome> outcome = renderUntil(m_options.stop, m_options.checkpoints, hooks());
    if (!outcome) return outcome.error();
    m_stats.outcome = outcome.take();
    if (Result<void> done = writePicture(); !done) return done;
    if (Result<void> done = report(); !done) return done;
    if (Result<void> done = checkpointsWritten(); !done) return done;
    return interruptionError();
  }

 private:
  Result<void> load() {
    const double begin = nowSeconds();
    Result<LoadedScene> loaded = loadGltf(m_options.scene);
    if (!loaded) return loaded.error();
    const Result<View> view = findView(loaded->scene, m_options.camera);
    if (!view) return view.error();
    loaded->scene.view = *view;
    m_loaded = loaded.take();
    m_stats.scene = m_options.scene;
    m_stats.output = m_options.output;
    m_stats.report = m_loaded.report;
    m_stats.sceneHash = m_loaded.scene.hash();
    m_stats.loadSeconds = nowSeconds() - begin;
    return {};
  }

  Result<void> build() {
    vk::DeviceOptions deviceOptions;
    deviceOptions.cacheDir = cacheDirectory();
    Result<std::unique_ptr<vk::Device>> device = vk::Device::open(deviceOptions);
    if (!device) return device.error();
    m_device = device.take();
    m_stats.device = m_device->info();
    m_stats.config = sessionConfig(m_options);

    Result<std::unique_ptr<Session>> session = Session::create(*m_device, std::move(m_loaded.scene), m_loaded.report,
                                                               m_stats.config, m_mailbox, m_frames, m_replies);
    if (!session) return session.error();
    m_session = session.take();
    const Result<Status> status = m_session->status();
    if (!status) return status.error();
    for (const StageTime& stage : status->stages) {
      if (stage.name == "build") m_stats.buildSeconds = stage.ms * 1e-3;
      if (stage.name == "warmUp") m_stats.warmUpSeconds = stage.ms * 1e-3;
    }
    return {};
  }

  RenderHooks hooks() {
    return {.pass = [this] { return pass(); },
            .takeCheckpoint = [this](const CheckpointTaken& taken) { return writeCheckpoint(taken); },
            .now = nowSeconds,
            .interrupted = [] { return Interruption::signal() != 0; }};
  }

  Result<PassState> pass() {
    if (Result<void> done = m_session->runSteps(++m_passes); !done) return done.error();
    const Result<Status> status = m_session->status();
    if (!status) return status.error();
    m_stats.status = *status;
    return PassState{status->steps, status->estimatedError, status->errorLow, status->errorHigh,
                     status->phase == Phase::converged};
  }

  Result<FilmImage> film(double seconds) {
    Result<FilmImage> image = m_session->readFilm();
    if (!image) return image.error();
    m_stats.samples = {m_stats.config.firstSample, m_stats.config.firstSample + largestCount(*image)};
    image->metadata = filmMetadata(m_stats, m_session->scene().view, seconds);
    keepLayers(*image, m_options.layers);
    return image;
  }

  static uint64_t largestCount(const FilmImage& image) {
    const FilmLayer* samples = image.find("samples");
    return samples ? uint64_t(*std::max_element(samples->data.begin(), samples->data.end())) : 0;
  }

  Result<void> writeCheckpoint(const CheckpointTaken& taken) {
    const Result<FilmImage> image = film(taken.seconds);
    if (!image) return image.error();
    return writeExr(checkpointFile(m_options.output, taken.request.text), *image);
  }

  Result<void> writePicture() {
    const double begin = nowSeconds();
    const Result<FilmImage> image = film(m_stats.outcome.seconds);
    if (!image) return image.error();
    const Result<std::shared_ptr<const Frame>> frame = m_session->resolveFrame();
    if (!frame) return frame.error();
    m_stats.frame = (*frame)->info;
    const Result<void> written = m_options.png
                                     ? writePng(m_options.output, m_options.width, m_options.height, (*frame)->rgba)
                                     : writeExr(m_options.output, *image);
    m_stats.writeSeconds = nowSeconds() - begin;
    return written;
  }

  Result<void> report() {
    std::printf("%s: %ux%u, samples %s in %.2f s, %s\n", m_options.output.c_str(), m_options.width, m_options.height,
                sampleRangeText(m_stats.samples).c_str(), m_stats.outcome.seconds, errorText().c_str());
    for (const LoadReport::Item& item : m_stats.report.unsupported)
      std::fprintf(stderr, "limn render: not supported: %s: %s\n", item.feature.c_str(), item.note.c_str());
    if (m_options.stats.empty()) return {};
    const std::string json = renderStatsJson(m_stats);
    return writeFileAtomically(m_options.stats, {reinterpret_cast<const uint8_t*>(json.data()), json.size()});
  }

  /// The first failure, told with how many there are.
  Result<void> checkpointsWritten() const {
    const std::vector<CheckpointTaken>& taken = m_stats.outcome.checkpoints;
    const auto failed = [](const CheckpointTaken& checkpoint) { return checkpoint.failure.has_value(); };
    const auto first = std::find_if(taken.begin(), taken.end(), failed);
    if (first == taken.end()) return {};
    Error error = *first->failure;
    error.message += "; " + std::to_string(std::count_if(first, taken.end(), failed)) + " of " +
                     std::to_string(taken.size()) + " checkpoints were not written";
    return error;
  }

  Result<void> interruptionError() const {
    if (!m_stats.outcome.interrupted) return {};
    return Error{kInterrupted, "interrupted after " + std::to_string(m_stats.outcome.state.steps) + " passes; " +
                                   m_options.output + " holds them", ""};
  }

  std::string errorText() const {
    const PassState& state = m_stats.outcome.state;
    if (!std::isfinite(state.errorHigh)) return "error not known";
    char text[96];
    std::snprintf(text, sizeof text, "estimated relMSE %.3g (%.3g to %.3g)", state.error, state.errorLow,
                  state.errorHigh);
    return text;
  }

  const RenderOptions& m_options;
  LoadedScene m_loaded;
  RenderStats m_stats;
  Mailbox m_mailbox;
  FrameSlot m_frames;
  StatusQueue m_replies;
  std::unique_ptr<vk::Device> m_device;
  std::unique_ptr<Session> m_session;
  uint32_t m_passes = 0;
};

Result<void> run(const Arguments& arguments) {
  const Result<RenderOptions> options = renderOptions(arguments);
  if (!options) return options.error();
  return Render(*options).run();
}

}  // namespace

Command renderCommand() { return {renderSpec(), run}; }

}  // namespace limn
