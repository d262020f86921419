#include "server/limn/bench_run.hpp"

#include "renderer/base/clock.hpp"
#include "renderer/vk/device.hpp"

namespace limn::bench {
namespace {

/// 1 / mean(1/n) over pixels that have samples.
double harmonicMean(const std::vector<float>& samples) {
  double inverses = 0.0, count = 0.0;
  for (const float n : samples)
    if (n > 0.0f) inverses += 1.0 / n, count += 1.0;
  return count > 0.0 ? count / inverses : 0.0;
}

Result<void> advance(Session& session, const Budget& budget, double seconds) {
  return budget.steps > 0 ? session.runSteps(budget.steps) : session.runSeconds(budget.seconds - seconds);
}

Result<Checkpoint> takeCheckpoint(Session& session, double seconds) {
  const Result<std::shared_ptr<const Frame>> frame = session.resolveFrame();
  if (!frame) return frame.error();
  Result<SampledPicture> shown = readPicture(session);
  if (!shown) return shown.error();
  const Result<uint64_t> hash = session.filmHash();
  if (!hash) return hash.error();

  const FrameInfo& info = (*frame)->info;
  Checkpoint checkpoint;
  checkpoint.seconds = seconds;
  checkpoint.steps = info.steps;
  checkpoint.gatheredShare = info.gatheredShare;
  checkpoint.estimate = info.estimatedError;
  checkpoint.low = info.errorLow;
  checkpoint.high = info.errorHigh;
  checkpoint.converged = info.phase == Phase::converged;
  checkpoint.filmHash = *hash;
  checkpoint.samples = harmonicMean(shown->samples);
  checkpoint.picture = std::move(shown->picture);
  fillMissing(checkpoint.picture, shown->samples);
  return checkpoint;
}

}  // namespace

Result<std::unique_ptr<BenchSession>> BenchSession::create(vk::Device& device, const LoadedScene& loaded,
                                                           const SessionConfig& config) {
  auto made = std::make_unique<BenchSession>();
  Result<std::unique_ptr<Session>> session =
      Session::create(device, loaded.scene, loaded.report, config, made->m_mailbox, made->m_frames, made->m_replies);
  if (!session) return session.error();
  made->m_session = session.take();
  return made;
}

Result<SampledPicture> readPicture(Session& session) {
  const Result<FilmImage> film = session.readFilm();
  if (!film) return film.error();
  const Result<RadianceView> radiance = radianceOf(*film, "film");
  if (!radiance) return radiance.error();
  const FilmLayer* samples = film->find("samples");
  if (!samples) return Error{"bad-image", "the film has no sample counts", ""};
  return SampledPicture{imageOf(*radiance), samples->data};
}

Result<Run> measureRun(vk::Device& device, const LoadedScene& loaded, const SessionConfig& config,
                       const std::vector<Budget>& budgets) {
  Result<std::unique_ptr<BenchSession>> made = BenchSession::create(device, loaded, config);
  if (!made) return made.error();
  Session& session = ***made;
  Run run;
  run.technique = config.technique;
  run.seed = config.seed;
  double seconds = 0.0;
  for (const Budget& budget : budgets) {
    const double begin = nowSeconds();
    if (Result<void> done = advance(session, budget, seconds); !done) return done.error();
    seconds += nowSeconds() - begin;
    Result<Checkpoint> checkpoint = takeCheckpoint(session, seconds);
    if (!checkpoint) return checkpoint.error();
    run.checkpoints.push_back(checkpoint.take());
  }
  Result<Status> status = session.status();
  if (!status) return status.error();
  run.status = status.take();
  for (const StageTime& stage : run.status.stages) {
    if (stage.name == "build") run.buildSeconds = stage.ms * 1e-3;
    if (stage.name == "warmUp") run.warmUpSeconds = stage.ms * 1e-3;
  }
  return run;
}

void fillMissing(RadianceImage& picture, const std::vector<float>& samples) {
  for (uint32_t y = 0; y < picture.height; ++y)
    for (uint32_t x = 0; x < picture.width; ++x) {
      const size_t pixel = size_t(y) * picture.width + x;
      if (samples[pixel] > 0.0f) continue;
      for (const uint32_t stride : {2u, 4u, 8u}) {
        const size_t corner = size_t(y / stride * stride) * picture.width + x / stride * stride;
        if (!(samples[corner] > 0.0f)) continue;
        for (size_t c = 0; c < 3; ++c) picture.values[pixel * 3 + c] = picture.values[corner * 3 + c];
        break;
      }
    }
}

}  // namespace limn::bench
