#include "renderer/base/clock.hpp"
#include "renderer/base/log.hpp"
#include "renderer/session/session_impl.hpp"

namespace limn {

void Session::Impl::planWarmUp() {
  coldTechniques.clear();
  for (const TechniqueInfo& info : techniqueInfos())
    if (info.name != technique->info().name) coldTechniques.push_back(info.name);
  warmUpScene.reset();
  warmUpSeconds = 0.0;
  sceneShown = false;
}

// The first picture of a scene, and of every edit, comes before the pipelines of techniques that nobody has asked for.
bool Session::Impl::warmUpIsDue() const { return !coldTechniques.empty() && sceneShown && (frameOfState || idle()); }

Result<void> Session::Impl::warmUpOnePipeline() {
  const double begin = nowSeconds();
  if (!warmUpScene) {
    auto made = WarmUpScene::create(device, scene);
    if (!made) return made.error();
    warmUpScene = made.take();
  }
  WarmUpScene& w = *warmUpScene;
  const TechniqueContext standIn{device, w.description, w.mirror, w.tracer, camera, *w.film, *statistics};
  const vk::PipelineAllowance allowance(device, 1);
  Technique& cold = keptTechnique(coldTechniques.back());
  auto done = cold.prepare(standIn, w.needs, true);
  if (done && cold.info().biased && !technique->info().biased) done = audit.prepare(standIn, w.needs, true);
  warmUpSeconds += nowSeconds() - begin;
  if (!done && done.error().code == vk::PipelineAllowance::kSpent) return {};  // the rest in later turns
  if (!done && done.error().code == "device-lost") return done;
  if (!done) logWarning(coldTechniques.back() + " cannot be warmed up: " + done.error().text());
  coldTechniques.pop_back();
  if (!coldTechniques.empty()) return {};
  warmUpScene.reset();
  logInfo("every technique warm after " + std::to_string(int(warmUpSeconds * 1e3)) + " ms more (" +
          (device.pipelineCacheLoaded() ? "from the cache" : "cold") + "), " +
          std::to_string(device.pipelineStats().created) + " pipelines");
  return {};
}

}  // namespace limn
