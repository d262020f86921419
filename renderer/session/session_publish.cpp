#include <algorithm>
#include <cmath>

#include "renderer/base/clock.hpp"
#include "renderer/session/session_impl.hpp"

namespace limn {

Phase Session::Impl::phase() const {
  if (progress.converged) return Phase::converged;
  return progress.passes == 0 ? Phase::coarse : Phase::converging;
}

// The first picture waits for its grid; the next for a whole level or pass; later ones come ever more slowly, for noise falls
// with the root of time.
bool Session::Impl::frameIsDue(double now) const {
  if (!watched) return false;
  if (!frameOfState) return progress.converged || progress.passes > 0 || (progress.gatheredShare > 0.0 && progress.fillStride <= firstStride &&
                                                                          gridComplete());
  if (showAgain || progress.converged) return newSamples || showAgain;
  if (!newSamples) return false;
  if (progress.passes > 0 && publishedPasses == 0) return true;  // the first picture without a filled pixel
  const double wait = std::clamp(0.25 * (now - restartedAt), config.frameSeconds, 10.0 * config.frameSeconds);
  return now - publishedAt >= wait;
}

// Whether the grid of fillStride is whole, not merely the coarsest that there is.
bool Session::Impl::gridComplete() const {
  const double share = 1.0 / (double(progress.fillStride) * progress.fillStride);
  return progress.gatheredShare >= share * 0.999;
}

Result<void> Session::Impl::publishIfDue() {
  if (!frameIsDue(nowSeconds())) return {};
  return publish();
}

Result<void> Session::Impl::publish() {
  // The estimate needs pairs of samples; during the first passes there are none, and the coarse frame is not kept waiting.
  if (progress.passes > 1)
    if (auto done = estimateError(); !done) return done;
  auto frame = makeFrame();
  if (!frame) return frame.error();
  publishedAt = nowSeconds();
  publishedPasses = progress.passes;
  frameOfState = sceneShown = true;
  showAgain = newSamples = false;
  ++status.framesPublished;
  frames.publish(frame.take());
  refreshStatus();
  return {};
}

Result<std::shared_ptr<const Frame>> Session::Impl::makeFrame() {
  const double begin = nowSeconds();
  auto rgba = resolver->resolve(device, *film, resolve, progress.passes > 0 ? 0 : progress.fillStride, technique->indirect());
  if (!rgba) return rgba.error();
  const double end = nowSeconds();
  auto frame = std::make_shared<Frame>();
  frame->rgba = rgba.take();
  FrameInfo& info = frame->info;
  info.frameId = ++frameId;
  info.sceneRevision = sceneRevision;
  info.viewRevision = viewRevision;
  info.width = config.width;
  info.height = config.height;
  info.phase = phase();
  info.steps = progress.passes;
  info.gatheredShare = float(progress.gatheredShare);
  info.meanSamples = progress.passes > 1 ? float(means.samples) : float(progress.gatheredShare);
  info.estimatedError = float(error.relMse);
  info.errorLow = float(error.low);
  info.errorHigh = float(error.high);
  info.msSinceEdit = editReceivedAt > 0.0 ? float((end - editReceivedAt) * 1e3) : 0.0f;
  info.discardedSamples = technique->discardedSamples() - discardedAtRestart;
  info.stages = {{"sample", float((sampledSeconds - sampledAtFrame) * 1e3)}, {"resolve", float((end - begin) * 1e3)}};
  sampledAtFrame = sampledSeconds;
  for (const auto& [client, seq] : appliedSeq) info.applied.push_back({client, seq});
  return std::shared_ptr<const Frame>(std::move(frame));
}

void Session::Impl::listWork() {
  static constexpr const char* kPipelines[] = {"pipelines tailored to the scene", "pipelines tailored to more than the scene",
                                               "pipelines for any scene"};
  status.ran.clear();
  status.leftOut.clear();
  for (const PassUse& pass : technique->passes()) (pass.ran ? status.ran : status.leftOut).push_back(pass.name);
  if (technique->info().biased) (auditShare() > 0.0 ? status.ran : status.leftOut).emplace_back("audit pixels");
  status.ran.emplace_back(config.allNeeds ? "everything, needed or not" : kPipelines[uint32_t(technique->pipelines())]);
  for (const auto& [name, flag] : sceneNeedFlags())
    (needs.*flag ? status.ran : status.leftOut).push_back("scene: " + std::string(name));
}

void Session::Impl::refreshStatus() {
  status.phase = phase();
  status.idle = idle();
  status.steps = progress.passes;
  status.meanSamples = float(means.samples);
  status.estimatedError = float(error.relMse);
  status.errorLow = float(error.low);
  status.errorHigh = float(error.high);
  status.secondsSinceRestart = nowSeconds() - restartedAt;
  status.raysPerSecond = sampledSeconds > 0.0 ? double(technique->raysTraced() - raysAtRestart) / sampledSeconds : 0.0;
  status.discardedSamples = technique->discardedSamples() - discardedAtRestart;
  const double taken = means.samples * film->pixelCount() + double(status.discardedSamples);
  status.discardedShare = taken > 0.0 ? double(status.discardedSamples) / taken : 0.0;
  status.pipelinesCreated = device.pipelineStats().created;
  status.technique = technique->info().name;
  status.device = device.info().name;
  listWork();
  status.memory.assign(device.memory().byOwner().begin(), device.memory().byOwner().end());
  status.stages = stages;
  status.stages.push_back({"sample", float(sampledSeconds * 1e3)});
  if (auditShare() > 0.0) status.stages.push_back({"audit", float(auditedSeconds * 1e3)});
  for (StageTime& stage : technique->stages()) status.stages.push_back(std::move(stage));
  status.figures = technique->figures();
  replies.setStatus(status);
}

}  // namespace limn
