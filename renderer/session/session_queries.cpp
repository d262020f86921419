#include <algorithm>

#include "renderer/film/exr.hpp"
#include "renderer/session/session_impl.hpp"
#include "renderer/vk/transfer.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/bvh_shared.h"
#include "shaders/shared/g_buffer_shared.h"

namespace limn {
namespace {

/// A field of the message that asked.
std::string placeIn(const Origin& from, const std::string& field) { return "seq " + std::to_string(from.seq) + " /" + field; }

}  // namespace

Result<void> Session::Impl::handle(const PickRequest& request) {
  if (request.x >= config.width || request.y >= config.height) {
    replies.push(ErrorReply{request.from, {"out-of-range", "the pixel is outside the picture", placeIn(request.from, request.x >= config.width ? "x" : "y")}});
    return {};
  }
  const auto all = pickBindings();
  const shared::GBufferPush push{request.x, request.y, 1, 1};
  if (auto done = gpu::runNow(device, [&](vk::CommandRecorder& r) { pickPass.record(r, all, push, 1); }); !done) return done;
  const shared::GBufferTexel hit = pickResult.as<shared::GBufferTexel>()[0];
  PickReply reply;
  reply.to = request.from;
  if (hit.triangle != shared::kNoTriangle) {
    const auto& blocks = mirror.blocks();
    const auto after = std::upper_bound(blocks.begin(), blocks.end(), hit.triangle,
                                        [](uint32_t id, const gpu::GeometryBlock& b) { return id < b.firstTriangle; });
    const gpu::GeometryBlock& block = *std::prev(after);
    const glm::vec3* corner = &block.corners[size_t(hit.triangle - block.firstTriangle) * 3];
    reply.node = int32_t(block.node);
    reply.material = int32_t(block.material) - 1;
    reply.primitive = int32_t(block.primitive);
    reply.posW = glm::dvec3(hit.posR) + mirror.renderOrigin();
    reply.normalW = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
    reply.distance = hit.distance;
  }
  replies.push(reply);
  return {};
}

Result<FilmImage> Session::Impl::readFilm() {
  auto read = film->read(device);
  if (!read) return read;
  const uint32_t last = config.firstSample + progress.samplesPerPixel;
  read->metadata = {{"limn:sceneHash", std::to_string(sceneHash())},
                    {"limn:technique", technique->info().name},
                    {"limn:seed", std::to_string(config.seed)},
                    {"limn:samples", std::to_string(config.firstSample) + ":" + std::to_string(last)},
                    {"limn:steps", std::to_string(progress.passes)},
                    {"limn:seconds", std::to_string(sampledSeconds)},
                    {"limn:scene", scene.name}};
  for (const auto& [name, value] : parameters) read->metadata.push_back({"limn:parameter:" + name, std::to_string(value)});
  return read;
}

Result<void> Session::Impl::handle(const SaveRequest& request) {
  auto image = readFilm();
  if (!image && image.error().code == "device-lost") return image.error();
  if (!image) {
    replies.push(ErrorReply{request.from, image.error()});
    return {};
  }
  if (!request.layers.empty()) {
    for (const std::string& wanted : request.layers)
      if (!image->find(wanted)) {
        replies.push(ErrorReply{request.from, {"unknown-layer", "no layer is named \"" + wanted + "\"", placeIn(request.from, "layers")}});
        return {};
      }
    std::erase_if(image->layers, [&](const FilmLayer& layer) {
      return std::find(request.layers.begin(), request.layers.end(), layer.name) == request.layers.end();
    });
  }
  auto bytes = encodeExr(*image);
  if (!bytes) replies.push(ErrorReply{request.from, bytes.error()});
  else replies.push(SaveReply{request.from, std::make_shared<const std::vector<uint8_t>>(bytes.take())});
  return {};
}

uint64_t Session::Impl::sceneHash() {
  if (!knownSceneHash) knownSceneHash = scene.hash();
  return *knownSceneHash;
}

void Session::Impl::forgetSummary(std::span<const Edit> edits) {
  knownSummary = nullptr;
  for (const Edit& edit : edits) {
    if (std::holds_alternative<SetNodeTransform>(edit)) knownBounds.reset();
    const bool besides = std::holds_alternative<SetView>(edit) || std::holds_alternative<SetResolve>(edit) ||
                         std::holds_alternative<SetTechnique>(edit) || std::holds_alternative<SetImageSize>(edit);
    if (!besides) knownSceneHash.reset();
  }
}

// Every vertex is looked at for hash and bounds, and clients ask while others drag.
std::shared_ptr<const SceneSummary> Session::Impl::summary() {
  if (knownSummary) return knownSummary;
  auto s = std::make_shared<SceneSummary>();
  s->name = scene.name;
  s->hash = sceneHash();
  s->sceneRevision = sceneRevision;
  s->viewRevision = viewRevision;
  s->materials = scene.materials;
  s->lights = scene.lights;
  s->nodes = scene.nodes;
  for (const Mesh& mesh : scene.meshes) s->meshNames.push_back(mesh.name);
  s->cameras = scene.cameras;
  s->environment = scene.environment;
  s->view = scene.view;
  s->resolve = resolve;
  s->technique = technique->info().name;
  s->parameters.assign(parameters.begin(), parameters.end());
  s->width = config.width;
  s->height = config.height;
  if (!knownBounds) knownBounds = worldBounds(scene);
  s->bounds = *knownBounds;
  s->report = report;
  return knownSummary = s;
}

Result<void> Session::Impl::handle(const DescribeRequest& request) {
  replies.push(DescribeReply{request.from, summary()});
  return {};
}

Result<void> Session::Impl::handle(const WaitRequest& request) {
  waits.push_back(request);
  return answerWaits();
}

Result<void> Session::Impl::answerWaits() {
  const auto isDone = [&](const WaitRequest& w) { return progress.converged || (w.steps > 0 && progress.passes >= w.steps); };
  if (std::none_of(waits.begin(), waits.end(), isDone)) return {};
  if (!knownHash) {
    auto hash = film->hash(device);
    if (!hash) return hash.error();
    if (progress.passes > 1)
      if (auto done = estimateError(); !done) return done;
    knownHash = *hash;
  }
  for (const WaitRequest& w : waits)
    if (isDone(w))
      replies.push(WaitReply{w.from, *knownHash, progress.passes, progress.converged, float(error.relMse), float(error.low),
                             float(error.high)});
  std::erase_if(waits, isDone);
  return {};
}

Result<void> Session::Impl::handle(const WatchRequest& request) {
  watched = request.watched;
  return {};
}

}  // namespace limn
