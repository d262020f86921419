#include <algorithm>
#include <cmath>

#include "renderer/base/clock.hpp"
#include "renderer/scene/clean_environment.hpp"
#include "renderer/session/session_impl.hpp"

namespace limn {
namespace {

constexpr uint32_t kMinSide = 16, kMaxSide = 8192;  ///< [pixel]

const ParameterInfo* findParameter(const TechniqueInfo& info, const std::string& name) {
  for (const ParameterInfo& p : info.parameters)
    if (p.name == name) return &p;
  return nullptr;
}

Result<void> checkParameter(const TechniqueInfo& info, const std::string& name, double value) {
  const ParameterInfo* p = findParameter(info, name);
  if (!p) return Error{"unknown-parameter", info.name + " has no parameter \"" + name + "\"", "parameters/" + name};
  const bool fractional = p->type != ParameterType::real && value != std::floor(value);
  if (!std::isfinite(value) || value < p->minimum || value > p->maximum || fractional)
    return Error{"out-of-range", name + " must be " + (fractional ? "a whole number" : "from " + std::to_string(p->minimum) + " to " +
                                                       std::to_string(p->maximum)), "parameters/" + name};
  return {};
}

void unite(std::vector<uint32_t>& into, const std::vector<uint32_t>& more) {
  into.insert(into.end(), more.begin(), more.end());
  std::sort(into.begin(), into.end());
  into.erase(std::unique(into.begin(), into.end()), into.end());
}

void unite(ChangeSet& into, const ChangeSet& more) {
  into.everything |= more.everything;
  unite(into.materials, more.materials);
  unite(into.emissive, more.emissive);
  unite(into.lights, more.lights);
  unite(into.nodes, more.nodes);
  into.environment |= more.environment;
  into.environmentImage |= more.environmentImage;
  into.view |= more.view;
  into.resolve |= more.resolve;
}

}  // namespace

Result<void> Session::Impl::drainMailbox() {
  std::vector<EditAck> superseded;
  std::vector<Request> requests = mailbox.drain(superseded);
  for (EditAck& ack : superseded) {
    ack.sceneRevision = sceneRevision;
    ack.viewRevision = viewRevision;
    replies.push(ack);
  }
  for (Request& request : requests) {
    // Edits in a row are redone once; whoever looks at the state sees all that came before.
    if (!std::holds_alternative<EditRequest>(request))
      if (auto done = redoPending(); !done) return done;
    if (auto done = std::visit([&](auto& r) { return handle(r); }, request); !done) return done;
  }
  return redoPending();
}

// An edit is checked against what the edits before it in its batch would leave.
Result<void> Session::Impl::checkEdit(std::span<const Edit> batch, size_t index) const {
  const Edit& edit = batch[index];
  if (const auto* size = std::get_if<SetImageSize>(&edit)) {
    const auto fits = [](uint32_t side) { return side >= kMinSide && side <= kMaxSide; };
    if (!fits(size->width) || !fits(size->height))
      return Error{"out-of-range", "width and height must be from 16 to 8192 pixels", fits(size->width) ? "height" : "width"};
    return {};
  }
  if (const auto* set = std::get_if<SetTechnique>(&edit)) {
    const TechniqueInfo* info = &technique->info();
    for (const Edit& earlier : batch.first(index))
      if (const auto* chosen = std::get_if<SetTechnique>(&earlier); chosen && chosen->technique) info = findTechnique(*chosen->technique);
    if (set->technique) info = findTechnique(*set->technique);
    if (!info) return Error{"unknown-technique", "no technique is named \"" + *set->technique + "\"", "technique"};
    for (const auto& [name, value] : set->parameters)
      if (auto checked = checkParameter(*info, name, value); !checked) return checked;
    return {};
  }
  if (const auto* set = std::get_if<SetEnvironment>(&edit); set && set->image.value_or(nullptr)) {
    const auto fits = mirror.checkEnvironment(**set->image);
    if (!fits) return Error{fits.error().code, fits.error().message, "image"};
  }
  return validate(scene, batch, index);
}

CostClass Session::Impl::applyTechnique(const SetTechnique& edit) {
  CostClass cost = CostClass::none;
  if (edit.technique && *edit.technique != technique->info().name) {
    chooseTechnique(*edit.technique);
    cost = CostClass::rebuild;
  }
  for (const auto& [name, value] : edit.parameters) {
    if (parameters[name] == value) continue;
    parameters[name] = value;
    technique->setParameter(name, value);
    cost = std::max(cost, findParameter(technique->info(), name)->cost);
  }
  return cost;
}

Result<void> Session::Impl::handle(EditRequest& request) {
  for (size_t i = 0; i < request.edits.size(); ++i)
    if (auto checked = checkEdit(request.edits, i); !checked) {
      Error answer = checked.error();
      answer.place = "/edits/" + std::to_string(i) + (answer.place.empty() ? "" : "/" + answer.place);
      replies.push(ErrorReply{request.from, answer});
      return {};
    }
  // A new size is the one edit that may fail when it is applied: it comes first, so that nothing else has changed then.
  const SetImageSize* size = nullptr;
  for (const Edit& edit : request.edits)
    if (const auto* set = std::get_if<SetImageSize>(&edit)) size = set;
  const bool sizeChanged = size && (size->width != config.width || size->height != config.height);
  if (sizeChanged)
    if (auto resized = resize(size->width, size->height); !resized) {
      replies.push(ErrorReply{request.from, resized.error()});
      return {};
    }
  const ChangeSet changes = apply(scene, resolve, request.edits);
  CostClass parameterCost = CostClass::none;
  for (const Edit& edit : request.edits)
    if (const auto* set = std::get_if<SetTechnique>(&edit))
      parameterCost = std::max(parameterCost, applyTechnique(*set));
  const RestartPlan plan = planRestart(changes, parameterCost, sizeChanged);
  if (plan.syncScene) ++sceneRevision;
  if (changes.view || sizeChanged) ++viewRevision;
  uint32_t& applied = appliedSeq[request.from.client];
  applied = std::max(applied, request.from.seq);  // an edit that waited for a file comes after later ones
  editReceivedAt = request.receivedAt > 0.0 ? request.receivedAt : nowSeconds();
  ++status.editsApplied;
  unite(pending.changes, changes);
  pending.parameterCost = std::max(pending.parameterCost, parameterCost);
  pending.sizeChanged |= sizeChanged;
  replies.push(EditAck{request.from, plan.cost, sceneRevision, viewRevision, false});
  return {};
}

Result<void> Session::Impl::handle(LoadRequest& request) {
  if (!request.loaded) return {};
  const double begin = nowSeconds();
  Scene before = std::exchange(scene, std::move(request.loaded->scene));
  LoadReport reportBefore = std::exchange(report, std::move(request.loaded->report));
  cleanEnvironment(scene, report.notes);
  ChangeSet all;
  all.everything = true;
  if (auto synced = syncScene(all); !synced) {
    // The scene does not fit the device: the old one comes back, and the client hears why.
    if (synced.error().code == "device-lost") return synced;
    scene = std::move(before);
    report = std::move(reportBefore);
    if (auto restored = syncScene(all); !restored) return restored;
    replies.push(ErrorReply{request.from, synced.error()});
  } else {
    ++sceneRevision;
    ++viewRevision;
    appliedSeq[request.from.client] = request.from.seq;
    editReceivedAt = request.receivedAt > 0.0 ? request.receivedAt : nowSeconds();
    replies.push(LoadReply{request.from, summary(), nowSeconds() - begin});
    planWarmUp();
  }
  if (auto done = writeCamera(); !done) return done;
  return restartFilm(CostClass::reload);
}

Result<void> Session::Impl::redoPending() {
  const PendingChanges todo = std::exchange(pending, {});
  const RestartPlan plan = planRestart(todo.changes, todo.parameterCost, todo.sizeChanged);
  if (plan.syncScene)
    if (auto done = syncScene(todo.changes); !done) return done;
  if (plan.writeCamera)
    if (auto done = writeCamera(); !done) return done;
  if (plan.restartFilm) return restartFilm(plan.cost);
  showAgain |= plan.showAgain;
  return {};
}

}  // namespace limn
