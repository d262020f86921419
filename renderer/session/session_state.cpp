#include <algorithm>

#include "renderer/base/clock.hpp"
#include "renderer/base/log.hpp"
#include "renderer/gpu/camera.hpp"
#include "renderer/gpu/needs_constants.hpp"
#include "renderer/scene/clean_environment.hpp"
#include "renderer/scene/scene_estimate.hpp"
#include "renderer/session/first_stride.hpp"
#include "renderer/session/session_impl.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/g_buffer_shared.h"

namespace limn {
namespace {

ChangeSet wholeScene() {
  ChangeSet all;
  all.everything = true;
  return all;
}

Result<vk::Buffer> smallBuffer(vk::Device& device, size_t bytes, vk::MemoryKind memory, const char* name) {
  vk::BufferDesc desc;
  desc.size = bytes;
  desc.memory = memory;
  desc.name = name;
  desc.owner = "session";
  return vk::Buffer::create(device, desc);
}

void setDefaults(Technique& technique) {
  for (const ParameterInfo& p : technique.info().parameters) technique.setParameter(p.name, p.defaultValue);
}

}  // namespace

ParameterValues defaultParameters(const TechniqueInfo& technique) {
  ParameterValues values;
  for (const ParameterInfo& p : technique.parameters) values[p.name] = p.defaultValue;
  return values;
}

Result<void> Session::Impl::init(Scene newScene, LoadReport newReport, const SessionConfig& newConfig) {
  config = newConfig;
  scene = std::move(newScene);
  report = std::move(newReport);
  cleanEnvironment(scene, report.notes);
  auto cameraBuffer = smallBuffer(device, sizeof(shared::CameraData), vk::MemoryKind::deviceLocal, "session.camera");
  if (!cameraBuffer) return cameraBuffer.error();
  camera = cameraBuffer.take();
  auto pickBuffer = smallBuffer(device, sizeof(shared::GBufferTexel), vk::MemoryKind::readback, "session.pick");
  if (!pickBuffer) return pickBuffer.error();
  pickResult = pickBuffer.take();

  const std::string name = config.technique.empty() ? techniqueInfos().front().name : config.technique;
  if (!findTechnique(name)) return Error{"unknown-technique", "no technique is named \"" + name + "\"", "technique"};
  chooseTechnique(name);
  SetTechnique given;
  given.parameters = config.parameters;
  const Edit edit(given);
  if (auto checked = checkEdit(std::span(&edit, 1), 0); !checked) return checked;
  ParameterValues wanted;
  for (const auto& [parameter, value] : given.parameters) wanted[parameter] = value;  // of one given twice the last counts
  setParameters(wanted);
  if (auto done = resize(config.width, config.height); !done) return done;
  const double begin = nowSeconds();
  if (auto done = syncScene(wholeScene()); !done) return done;
  const double built = nowSeconds();
  if (auto done = writeCamera(); !done) return done;
  if (auto done = restartFilm(CostClass::reload); !done) return done;
  const double ready = nowSeconds();
  stages = {{"build", float((built - begin) * 1e3)}, {"warmUp", float((ready - built) * 1e3)}};
  logInfo("scene built in " + std::to_string(int((built - begin) * 1e3)) + " ms, pipelines warm after " +
          std::to_string(int((ready - built) * 1e3)) + " ms (" + (device.pipelineCacheLoaded() ? "from the cache" : "cold") + "), " +
          std::to_string(device.pipelineStats().created) + " pipelines");
  sceneRevision = viewRevision = 1;
  planWarmUp();
  return {};
}

Technique& Session::Impl::keptTechnique(const std::string& name) {
  std::unique_ptr<Technique>& kept = techniques[name];
  if (kept) return *kept;
  kept = makeTechnique(name);
  LIMN_CHECK(kept != nullptr);
  setDefaults(*kept);
  return *kept;
}

// A technique is kept with its pipelines, so that nothing is compiled when it is chosen again.
void Session::Impl::chooseTechnique(const std::string& name) {
  technique = &keptTechnique(name);
  std::erase(coldTechniques, name);
  setDefaults(*technique);
  parameters = defaultParameters(technique->info());
}

void Session::Impl::setParameters(const ParameterValues& values) {
  for (const auto& [name, value] : values) {
    if (parameters[name] == value) continue;
    parameters[name] = value;
    technique->setParameter(name, value);
  }
}

// After an error it is half done: another setup has to be taken.
Result<void> Session::Impl::takeSetup(const FilmSetup& wanted, CostClass cost) {
  if (wanted.width != config.width || wanted.height != config.height)
    if (auto done = resize(wanted.width, wanted.height); !done) return done;
  if (wanted.technique != technique->info().name) chooseTechnique(wanted.technique);
  setParameters(wanted.parameters);
  if (auto done = writeCamera(); !done) return done;
  if (cost > CostClass::displayOnly) return restartFilm(cost);
  showAgain |= cost == CostClass::displayOnly;
  return {};
}

// What was too large goes first.
Result<void> Session::Impl::restoreSetup(const FilmSetup& before) {
  const std::string refused = technique->info().name;
  if (refused != before.technique) {
    chooseTechnique(before.technique);
    techniques.erase(refused);
  }
  film.reset();
  if (auto done = resize(before.width, before.height); !done) return done;
  return takeSetup(before, CostClass::rebuild);
}

Result<void> Session::Impl::showScene() {
  if (auto done = syncScene(wholeScene()); !done) return done;
  if (auto done = writeCamera(); !done) return done;
  return restartFilm(CostClass::reload);
}

Result<void> Session::Impl::resize(uint32_t width, uint32_t height) {
  auto newFilm = Film::create(device, width, height);
  if (!newFilm) return newFilm.error();
  config.width = width;  // from here on another size has to be taken when this one fails
  config.height = height;
  if (!resolver) {
    auto newResolver = Resolver::create(device, *newFilm);
    if (!newResolver) return newResolver.error();
    resolver = newResolver.take();
    auto newStatistics = FilmStatistics::create(device, *newFilm);
    if (!newStatistics) return newStatistics.error();
    statistics = newStatistics.take();
  } else {
    if (auto done = resolver->resize(device, *newFilm); !done) return done;
    if (auto done = statistics->resize(device, *newFilm); !done) return done;
  }
  film = newFilm.take();
  return {};
}

Result<void> Session::Impl::syncScene(const ChangeSet& changes) {
  auto synced = mirror.sync(scene, changes);
  if (!synced) return synced.error();
  if (auto done = updateTracer(*synced); !done) return done;
  needs = config.allNeeds ? gpu::allNeeds() : sceneNeeds(scene);
  measureHostMemory();
  ++lightingRevision;
  return {};
}

void Session::Impl::measureHostMemory() {
  status.hostMemory = {{"scene", hostBytes(scene)}, {"mirror", mirror.hostBytes()}, {"bvh", tracer.hostBytes()}};
}

Result<void> Session::Impl::updateTracer(const gpu::SyncReport& synced) {
  std::vector<uint32_t> changed = synced.movedBlocks;
  changed.insert(changed.end(), synced.alphaBlocks.begin(), synced.alphaBlocks.end());
  std::vector<TriangleBlock> blocks;
  for (size_t i = 0; i < mirror.blocks().size(); ++i) {
    blocks.push_back({mirror.blocks()[i].corners, mirror.blocks()[i].firstTriangle, mirror.blockNeedsAlpha(i)});
    if (synced.reloaded) changed.push_back(uint32_t(i));
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  if (changed.empty() && !synced.reloaded) return {};
  if (auto done = tracer.update(device, blocks, changed); !done) return done;
  status.blocksRebuilt += tracer.blocksRebuilt();
  return {};
}

Result<void> Session::Impl::writeCamera() {
  const shared::CameraData data = gpu::cameraData(scene.view, mirror.renderOrigin(), config.width, config.height);
  return vk::uploadArray(device, camera, std::span<const shared::CameraData>(&data, 1));
}

TechniqueContext Session::Impl::context() {
  return {device, scene, mirror, tracer, camera, *film, *statistics, config.seed, config.firstSample, lightingRevision,
          config.sampleCount, config.allNeeds};
}

std::vector<vk::Binding> Session::Impl::pickBindings() const {
  auto all = gpu::joined(mirror.bindings(), tracer.bindings());
  return gpu::joined(std::move(all), {vk::storage(BINDING_CAMERA, camera), vk::storage(BINDING_OUTPUT, pickResult)});
}

Result<void> Session::Impl::restartFilm(CostClass cost) {
  if (auto done = technique->prepare(context(), needs, cost >= CostClass::reload); !done) return done;
  if (auto done = technique->restart(context(), cost); !done) return done;
  if (auto done = restartAudit(cost >= CostClass::reload); !done) return done;
  if (!pickPass) {
    const auto all = pickBindings();
    auto pass = gpu::Pass::create(device, "g_buffer", all, sizeof(shared::GBufferPush));
    if (!pass) return pass.error();
    pickPass = pass.take();
    if (auto warm = gpu::runNow(device, [&](vk::CommandRecorder& r) { pickPass.warmUp(r, all); }); !warm) return warm;
  }
  firstStride = nextFirstStride(firstStride, config.firstFrameSeconds,
                                [&](uint32_t stride) { return technique->secondsToGrid(stride); });
  progress = {};
  knownHash.reset();
  progress.fillStride = 8;
  error = {};
  means = {};
  restartedAt = nowSeconds();
  raysAtRestart = technique->raysTraced();
  discardedAtRestart = technique->discardedSamples();
  sampledSeconds = sampledAtFrame = 0.0;
  frameOfState = newSamples = false;
  publishedPasses = 0;
  ++status.restarts;
  return {};
}

// Pipelines that an edit left as they were, cut to more than the scene needs, are made anew when nobody looks: a stop for
// the compiler is no matter then.
Result<bool> Session::Impl::tailorAtRest() {
  if (watched || technique->pipelines() == gpu::PipelineVariant::tailored) return false;
  if (auto done = technique->prepare(context(), needs, true); !done) return done.error();
  refreshStatus();
  return true;
}

}  // namespace limn
