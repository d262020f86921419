#include "server/convert.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "server/convert_values.hpp"

namespace limn::server {
namespace {

template <class T, size_t N, glm::length_t L>
void copy(const std::array<T, N>& from, glm::vec<L, T>& to) {
  static_assert(N == size_t(L));
  for (size_t i = 0; i < N; ++i) to[glm::length_t(i)] = from[i];
}

template <class T, size_t N, glm::length_t L>
void copy(const std::optional<std::array<T, N>>& from, std::optional<glm::vec<L, T>>& to) {
  if (from) copy(*from, to.emplace());
}

std::optional<float> finite(float value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; }

/// Converts one kind of edit; an overload each.
struct EditReader {
  View& present;

  Edit operator()(const protocol::MaterialEdit& wire) const {
    SetMaterial set;
    set.material = wire.material;
    copy(wire.baseColor, set.baseColor);
    set.metallic = wire.metallic;
    set.roughness = wire.roughness;
    copy(wire.emission, set.emission);
    set.ior = wire.ior;
    set.transmission = wire.transmission;
    set.thickness = wire.thickness;
    set.attenuationDistance = wire.attenuationDistance;
    copy(wire.attenuationColor, set.attenuationColor);
    set.specular = wire.specular;
    copy(wire.specularColor, set.specularColor);
    set.clearcoat = wire.clearcoat;
    set.clearcoatRoughness = wire.clearcoatRoughness;
    set.normalScale = wire.normalScale;
    set.alphaCutoff = wire.alphaCutoff;
    if (wire.alphaMode) set.alphaMode = same<AlphaMode>(*wire.alphaMode);
    return set;
  }
  Edit operator()(const protocol::LightEdit& wire) const {
    SetLight set;
    set.light = wire.light;
    copy(wire.color, set.color);
    set.intensity = wire.intensity;
    set.range = wire.range;
    set.innerConeAngle = wire.innerConeAngle;
    set.outerConeAngle = wire.outerConeAngle;
    return set;
  }
  Edit operator()(const protocol::NodeEdit& wire) const {
    SetNodeTransform set;
    set.node = wire.node;
    copy(wire.translation, set.translation);
    if (wire.rotation) {
      const auto& [x, y, z, w] = *wire.rotation;
      set.rotation = glm::dquat(w, x, y, z);
    }
    copy(wire.scale, set.scale);
    return set;
  }
  Edit operator()(const protocol::EnvironmentEdit& wire) const {
    SetEnvironment set;
    copy(wire.radiance, set.radiance);
    set.rotation = wire.rotation;
    if (wire.image && wire.image->empty()) set.image = nullptr;
    return set;
  }
  Edit operator()(const protocol::CameraEdit& wire) const {
    present = viewFromWire(wire.view, present);
    return SetView{present};
  }
  Edit operator()(const protocol::TechniqueEdit& wire) const {
    return SetTechnique{wire.technique, wire.parameters.value_or(std::vector<std::pair<std::string, double>>())};
  }
  Edit operator()(const protocol::ResolveEdit& wire) const {
    SetResolve set;
    set.exposure = wire.exposure;
    if (wire.toneMap) set.toneMap = same<ToneMap>(*wire.toneMap);
    if (wire.view) set.view = same<ResolveView>(*wire.view);
    return set;
  }
  Edit operator()(const protocol::ImageEdit& wire) const { return SetImageSize{wire.width, wire.height}; }
};

}  // namespace

View viewFromWire(const protocol::View& wire, const View& present) {
  View view = present;
  copy(wire.eye, view.eye);
  copy(wire.target, view.target);
  copy(wire.up, view.up);
  view.lens.perspective = wire.perspective.value_or(present.lens.perspective);
  view.lens.yfov = wire.yfov.value_or(present.lens.yfov);
  view.lens.ymag = wire.ymag.value_or(present.lens.ymag);
  view.lens.znear = wire.znear.value_or(present.lens.znear);
  return view;
}

protocol::View toWire(const View& view) {
  protocol::View wire;
  wire.eye = array(view.eye);
  wire.target = array(view.target);
  wire.up = array(view.up);
  wire.perspective = view.lens.perspective;
  wire.yfov = view.lens.yfov;
  wire.ymag = view.lens.ymag;
  wire.znear = view.lens.znear;
  return wire;
}

Edit editFromWire(const protocol::Edit& wire, View& present) { return std::visit(EditReader{present}, wire); }

protocol::Ack toWire(const EditAck& ack) {
  return {ack.to.seq, same<protocol::CostClass>(ack.cost), ack.sceneRevision, ack.viewRevision, ack.superseded};
}

protocol::Waited toWire(const WaitReply& reply) {
  protocol::Waited wire{reply.to.seq, reply.steps, {reply.filmHash}, finite(reply.estimatedError), {}, {}};
  if (wire.estimatedError) {
    wire.errorLow = reply.errorLow;
    wire.errorHigh = finite(reply.errorHigh);
  }
  return wire;
}

protocol::Picked toWire(const PickReply& reply) {
  protocol::Picked wire;
  wire.seq = reply.to.seq;
  wire.hit = reply.node != kNone;
  if (!wire.hit) return wire;
  wire.node = index(reply.node);
  wire.material = index(reply.material);
  wire.primitive = index(reply.primitive);
  wire.posW = array(reply.posW);
  wire.normalW = array(reply.normalW);
  wire.distance = reply.distance;
  return wire;
}

protocol::Status toWire(const Status& status) {
  protocol::Status wire;
  wire.phase = same<protocol::Phase>(status.phase);
  wire.idle = status.idle;
  wire.steps = status.steps;
  wire.meanSamples = status.meanSamples;
  wire.estimatedError = finite(status.estimatedError);
  if (wire.estimatedError) {
    wire.errorLow = status.errorLow;
    wire.errorHigh = finite(status.errorHigh);
  }
  wire.raysPerSecond = status.raysPerSecond;
  wire.secondsSinceRestart = status.secondsSinceRestart;
  wire.discardedSamples = status.discardedSamples;
  wire.discardedShare = status.discardedShare;
  wire.editsApplied = status.editsApplied;
  wire.restarts = status.restarts;
  wire.framesPublished = status.framesPublished;
  wire.quanta = status.quanta;
  wire.pipelinesCreated = status.pipelinesCreated;
  wire.technique = status.technique;
  wire.ran = status.ran;
  wire.leftOut = status.leftOut;
  wire.memory = status.memory;
  for (const StageTime& stage : status.stages) wire.stageMs.emplace_back(stage.name, stage.ms);
  wire.figures = status.figures;
  return wire;
}

std::vector<protocol::Technique> toWire(const std::vector<TechniqueInfo>& techniques) {
  std::vector<protocol::Technique> wire;
  for (const TechniqueInfo& technique : techniques) {
    protocol::Technique& out = wire.emplace_back();
    out.name = technique.name;
    out.title = technique.title;
    out.description = technique.description;
    out.biased = technique.biased;
    for (const ParameterInfo& p : technique.parameters)
      out.parameters.push_back({p.name, p.description, p.unit, same<protocol::ParameterType>(p.type), p.minimum,
                                p.maximum, p.defaultValue, same<protocol::CostClass>(p.cost)});
  }
  return wire;
}

protocol::FrameHeader frameHeader(const FrameInfo& info, uint64_t client, const std::vector<std::string>& stages) {
  protocol::FrameHeader header;
  header.kind = protocol::FrameKind::image;
  header.phase = same<protocol::Phase>(info.phase);
  header.flags = protocol::kFrameFull;
  if (info.phase == Phase::coarse) header.flags |= protocol::kFrameMoving;
  header.frameId = uint32_t(info.frameId);
  for (const Origin& origin : info.applied)
    if (origin.client == client) header.ackSeq = origin.seq;
  header.sceneRevision = info.sceneRevision;
  header.viewRevision = info.viewRevision;
  header.width = header.fullWidth = header.imageWidth = uint16_t(info.width);
  header.height = header.fullHeight = header.imageHeight = uint16_t(info.height);
  header.steps = info.steps;
  header.gatheredShare = info.gatheredShare;
  header.meanSamples = info.meanSamples;
  header.estimatedError = info.estimatedError;
  header.errorLow = info.errorLow;
  header.errorHigh = info.errorHigh;
  header.msSinceEdit = info.msSinceEdit;
  header.stageCount = uint8_t(std::min(stages.size(), header.stageMs.size()));
  for (const StageTime& stage : info.stages) {
    header.renderMs += stage.ms;
    const auto slot = std::find(stages.begin(), stages.begin() + header.stageCount, stage.name);
    if (slot != stages.begin() + header.stageCount) header.stageMs[size_t(slot - stages.begin())] = stage.ms;
  }
  return header;
}

}  // namespace limn::server
