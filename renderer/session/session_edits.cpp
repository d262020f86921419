#include <algorithm>
#include <cmath>
#include <tuple>

#include "renderer/base/clock.hpp"
#include "renderer/scene/clean_environment.hpp"
#include "renderer/scene/reach.hpp"
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

/// Adds what an edit asks for; the dearest class of what it changes.
CostClass amend(FilmSetup& setup, const SetTechnique& edit) {
  CostClass cost = CostClass::none;
  if (edit.technique && *edit.technique != setup.technique) {
    setup.technique = *edit.technique;
    setup.parameters = defaultParameters(*findTechnique(setup.technique));
    cost = CostClass::rebuild;
  }
  for (const auto& [name, value] : edit.parameters) {
    if (setup.parameters[name] == value) continue;
    setup.parameters[name] = value;
    cost = std::max(cost, findParameter(*findTechnique(setup.technique), name)->cost);
  }
  return cost;
}

bool asksForSetup(const Edit& edit) {
  return std::holds_alternative<SetImageSize>(edit) || std::holds_alternative<SetTechnique>(edit);
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

Result<void> Session::Impl::checkBatch(std::span<const Edit> batch) const {
  for (size_t i = 0; i < batch.size(); ++i)
    if (auto checked = checkEdit(batch, i); !checked) {
      Error answer = checked.error();
      answer.place = "/edits/" + std::to_string(i) + (answer.place.empty() ? "" : "/" + answer.place);
      return answer;
    }
  return validateReach(scene, batch);
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

// What decides the device memory that is asked for comes before the rest of its batch and before its answer: when the device has
// none, nothing else has changed, and what was before comes back.
Result<Session::Impl::SetupOutcome> Session::Impl::applySetup(const EditRequest& request) {
  const FilmSetup before = setup();
  FilmSetup wanted = before;
  SetupOutcome outcome;
  std::string place;
  for (size_t i = 0; i < request.edits.size(); ++i) {
    const auto* size = std::get_if<SetImageSize>(&request.edits[i]);
    const auto* chosen = std::get_if<SetTechnique>(&request.edits[i]);
    if (size) std::tie(wanted.width, wanted.height) = std::tie(size->width, size->height);
    if (chosen) outcome.parameterCost = std::max(outcome.parameterCost, amend(wanted, *chosen));
    if (asksForSetup(request.edits[i])) place = "/edits/" + std::to_string(i);
  }
  outcome.sizeChanged = wanted.width != before.width || wanted.height != before.height;
  if (wanted == before) return SetupOutcome{};
  const Result<void> taken = takeSetup(wanted, planRestart({}, outcome.parameterCost, outcome.sizeChanged).cost);
  if (taken) {
    outcome.before = before;
    return outcome;
  }
  if (taken.error().code == "device-lost") return taken.error();
  if (setup() != before)
    if (auto restored = restoreSetup(before); !restored) return restored.error();
  outcome.refusal = Error{taken.error().code, taken.error().message, place};
  return outcome;
}

Result<void> Session::Impl::handle(EditRequest& request) {
  // Another setup is tried on what surely stays.
  if (std::any_of(request.edits.begin(), request.edits.end(), asksForSetup))
    if (auto done = redoPending(); !done) return done;
  if (auto checked = checkBatch(request.edits); !checked) {
    replies.push(ErrorReply{request.from, checked.error()});
    return {};
  }
  const std::string before = technique->info().name;
  Result<SetupOutcome> setUp = applySetup(request);
  if (!setUp) return setUp.error();
  if (setUp->refusal) {
    replies.push(ErrorReply{request.from, *setUp->refusal});
    return {};
  }
  AppliedEdits applied = apply(scene, resolve, request.edits);
  forgetSummary(request.edits);
  pending.push_back({std::move(request), std::move(applied), setUp.take(), before});
  return {};
}

Result<void> Session::Impl::handle(LoadRequest& request) {
  if (!request.loaded) return {};
  const double begin = nowSeconds();
  Scene before = std::exchange(scene, std::move(request.loaded->scene));
  LoadReport reportBefore = std::exchange(report, std::move(request.loaded->report));
  cleanEnvironment(scene, report.notes);
  knownSummary = nullptr;
  knownSceneHash.reset();
  knownBounds.reset();
  if (auto shown = showScene(); !shown) {
    // The scene does not fit the device: the old one comes back, and the client hears why.
    if (shown.error().code == "device-lost") return shown;
    scene = std::move(before);
    report = std::move(reportBefore);
    if (auto restored = showScene(); !restored) return restored;
    replies.push(ErrorReply{request.from, shown.error()});
    return {};
  }
  ++sceneRevision;
  ++viewRevision;
  acknowledge(request.from, request.receivedAt);
  replies.push(LoadReply{request.from, summary(), nowSeconds() - begin});
  planWarmUp();
  return {};
}

Result<void> Session::Impl::handle(const LeaveRequest& request) {
  appliedSeq.erase(request.client);
  std::erase_if(waits, [&](const WaitRequest& wait) { return wait.from.client == request.client; });
  return {};
}

// What waited for a file comes after later edits of the same client.
void Session::Impl::acknowledge(const Origin& from, double receivedAt) {
  uint32_t& applied = appliedSeq[from.client];
  applied = std::max(applied, from.seq);
  editReceivedAt = receivedAt > 0.0 ? receivedAt : nowSeconds();
}

void Session::Impl::accept(const PendingEdit& edit) {
  const ChangeSet& changes = edit.applied.changes;
  const RestartPlan plan = planRestart(changes, edit.setup.parameterCost, edit.setup.sizeChanged);
  if (plan.syncScene) ++sceneRevision;
  if (changes.view || edit.setup.sizeChanged) ++viewRevision;
  acknowledge(edit.request.from, edit.request.receivedAt);
  ++status.editsApplied;
  knownSummary = nullptr;  // of the revisions before
  replies.push(EditAck{edit.request.from, plan.cost, sceneRevision, viewRevision, false, edit.technique});
}

// Which of several edits asks for too much cannot be told: together they did.
void Session::Impl::refuse(const EditRequest& request, const Error& why) {
  const std::string place = request.edits.size() == 1 ? "/edits/0" : "seq " + std::to_string(request.from.seq) + " /edits";
  replies.push(ErrorReply{request.from, {why.code, why.message, place}});
}

// Requests of one turn are redone together, and answered when that is done. Where the device has no room halves of them are tried, in
// order, down to one: that which is refused is as if it had never come, and takes no other along.
Result<void> Session::Impl::redoPending() {
  std::vector<PendingEdit> edits = std::exchange(pending, {});
  ChangeSet changes;
  for (const PendingEdit& edit : edits) unite(changes, edit.applied.changes);
  const Result<void> redone = redo(changes);
  if (redone) {
    for (const PendingEdit& edit : edits) accept(edit);
    return {};
  }
  if (redone.error().code == "device-lost") return redone;
  if (auto restored = takeBackEdits(edits); !restored) return restored;
  if (edits.size() == 1) {
    refuse(edits[0].request, redone.error());
    return {};
  }
  for (size_t i = 0; i < edits.size(); ++i) {
    if (auto done = handle(edits[i].request); !done) return done;
    if (i + 1 == edits.size() / 2)
      if (auto done = redoPending(); !done) return done;
  }
  return redoPending();
}

Result<void> Session::Impl::redo(const ChangeSet& changes) {
  const RestartPlan plan = planRestart(changes, CostClass::none, false);
  if (plan.syncScene)
    if (auto done = syncScene(changes); !done) return done;
  if (plan.writeCamera)
    if (auto done = writeCamera(); !done) return done;
  if (plan.restartFilm) return restartFilm(plan.cost);
  showAgain |= plan.showAgain;
  return {};
}

// Another setup is of the first edit alone: those before it were redone when it was taken.
Result<void> Session::Impl::takeBackEdits(std::span<const PendingEdit> edits) {
  for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
    takeBack(scene, resolve, edit->applied.before);
    forgetSummary(edit->request.edits);
  }
  if (auto shown = showScene(); !shown) return shown;
  return edits.front().setup.before ? restoreSetup(*edits.front().setup.before) : Result<void>{};
}

}  // namespace limn
