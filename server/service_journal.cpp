#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "renderer/base/clock.hpp"
#include "renderer/base/log.hpp"
#include "server/convert.hpp"
#include "server/service.hpp"

namespace limn::server {
namespace {

constexpr ConnectionId kJournal = std::numeric_limits<ConnectionId>::max();  // whose edits those of a journal are
constexpr double kRetrySeconds = 1.0;                                        // of a disk that was full
constexpr size_t kMostRequests = Mailbox::kMaxPending / 2;

/// Edits that go together. The image of a sky is there when it is read: what else an edit says of the sky must not come so late, over
/// what a client says meanwhile.
std::vector<std::vector<protocol::Edit>> groupsOf(const protocol::Batch& batch) {
  const auto* sky = batch.edits.size() == 1 ? std::get_if<protocol::EnvironmentEdit>(&batch.edits[0]) : nullptr;
  if (!sky || !sky->image || sky->image->empty()) return {batch.edits};
  protocol::EnvironmentEdit light = *sky, image;
  image.image = std::exchange(light.image, std::nullopt);
  return {{light}, {image}};
}

bool holdsView(const std::vector<Edit>& edits) {
  return std::any_of(edits.begin(), edits.end(), [](const Edit& edit) { return std::holds_alternative<SetView>(edit); });
}

/// A technique's parameters say whose they are. `inUse`: the technique before.
void nameTechniques(protocol::Batch& batch, std::string inUse) {
  for (protocol::Edit& edit : batch.edits) {
    auto* technique = std::get_if<protocol::TechniqueEdit>(&edit);
    if (technique && technique->technique) inUse = *technique->technique;
    else if (technique && !inUse.empty()) technique->technique = inUse;
  }
}

/// Refusals that another start may not meet: a file that was not there, room that the device had not got.
bool mayFitLater(const std::string& code) {
  for (const char* passing : {"io", "path", "out-of-memory", "limit", "size"})
    if (code == passing) return true;
  return false;
}

/// What the renderer refused of a request, "/edits/N/field".
struct KeptPlace {
  size_t edit = SIZE_MAX;              ///< of the request; SIZE_MAX: none of them is to blame
  std::string field;                   ///< "/field", maybe empty
};
KeptPlace keptPlaceOf(const Error& error) {
  const std::string edits = "/edits/";
  if (!error.place.starts_with(edits) || mayFitLater(error.code)) return {};
  const size_t field = std::min(error.place.find('/', edits.size()), error.place.size());
  return {std::strtoull(error.place.c_str() + edits.size(), nullptr, 10), error.place.substr(field)};
}

}  // namespace

void Service::begin(const View& view, const std::vector<protocol::ClientMessage>& kept) {
  m_view = view;
  takeUp(kept);
  m_begun = true;
}

void Service::takeUp(const std::vector<protocol::ClientMessage>& messages) {
  std::vector<std::vector<protocol::Edit>> groups;
  for (const protocol::ClientMessage& message : messages)
    if (const auto* batch = std::get_if<protocol::Batch>(&message))
      for (std::vector<protocol::Edit>& group : groupsOf(*batch)) groups.push_back(std::move(group));
  // A request for each, so that one which the scene has no place for any more takes no other along; where there are more than the
  // mailbox holds, a few share one.
  const size_t shared = groups.size() / kMostRequests + 1;
  for (size_t first = 0; first < groups.size(); first += shared) {
    std::vector<protocol::Edit> edits;
    for (size_t i = first; i < std::min(groups.size(), first + shared); ++i)
      edits.insert(edits.end(), groups[i].begin(), groups[i].end());
    askForKept(uint32_t(first) + 1, std::move(edits));
  }
  if (!groups.empty()) logInfo("edits of the journal are taken up: " + std::to_string(groups.size()));
}

void Service::askForKept(uint32_t seq, std::vector<protocol::Edit> edits) {
  const Origin from{kJournal, seq};
  EditJob job{{from, {}, nowSeconds()}, {}};
  View view = m_view;
  for (const protocol::Edit& edit : edits) addEdit(job, edit, view);
  const bool moves = holdsView(job.request.edits);
  const bool taken = job.images.empty() ? m_mailbox.push(std::move(job.request)) : m_loader->request(std::move(job));
  if (!taken) return logWarning("an edit of the journal is not taken up: too many wait");
  m_takingUp.emplace(seq, std::move(edits));
  if (moves) noteMoved(from, view);
}

void Service::rememberUnacknowledged(const Origin& from, protocol::ClientMessage message) {
  if (m_config.journal) m_unacknowledged.emplace(std::pair(from.client, from.seq), std::move(message));
}

void Service::noteAccepted(const EditAck& ack) {
  auto accepted = m_unacknowledged.extract({ack.to.client, ack.to.seq});
  if (!accepted) return;
  if (auto* batch = std::get_if<protocol::Batch>(&accepted.mapped())) nameTechniques(*batch, ack.technique);
  m_accepted.push_back({std::move(accepted.mapped())});
}

void Service::noteAccepted(const LoadReply& reply) {
  auto accepted = m_unacknowledged.extract({reply.to.client, reply.to.seq});
  if (accepted) m_accepted.push_back({std::move(accepted.mapped()), reply.scene->report.contents});
}

void Service::noteTakenUp(const Origin& from) {
  if (from.client != kJournal) return;
  noteSettled(from);
  m_takenUp = std::max(m_takenUp, from.seq);
}

std::vector<protocol::Edit> Service::noteSettled(const Origin& from) {
  auto asked = m_takingUp.extract(from.seq);
  m_settledAt = nowSeconds();
  return asked ? std::move(asked.mapped()) : std::vector<protocol::Edit>();
}

// What does not fit any more is forgotten, and the others that came with it are asked for again, as they are by now.
void Service::noteRefused(const ErrorReply& reply) {
  if (reply.to.client != kJournal) return;
  const char* what = mayFitLater(reply.error.code) ? "cannot be taken up now: " : "does not fit any more: ";
  logWarning(std::string("an edit of the journal ") + what + reply.error.text());
  const std::vector<protocol::Edit> asked = noteSettled(reply.to);
  const KeptPlace place = keptPlaceOf(reply.error);
  if (!m_config.journal || place.edit >= asked.size()) return;
  m_config.journal->forget(asked[place.edit], place.field);
  std::vector<protocol::Edit> others;
  for (const protocol::Edit& edit : asked)
    if (const std::optional<protocol::Edit> newest = m_config.journal->newest(edit)) others.push_back(*newest);
  if (!others.empty()) askForKept(reply.to.seq, std::move(others));
}

// A picture of all that the journal holds was made, or a while has passed in which nobody wanted one.
void Service::confirmJournal(double now) {
  if (!m_config.journal || !m_ready || !m_takingUp.empty()) return;
  const std::shared_ptr<const Frame> newest = m_frames.newest();
  const auto shows = [&](const Origin& applied) { return applied.client == kJournal && applied.seq >= m_takenUp; };
  const bool shown = newest && (m_takenUp == 0 || std::any_of(newest->info.applied.begin(), newest->info.applied.end(), shows));
  if (shown || now - m_settledAt > m_config.safeSeconds) m_config.journal->confirm();
}

// Before any acknowledgement leaves: these are only queued while replies are routed.
void Service::keepAccepted() {
  if (m_accepted.empty()) return;
  if (m_takingUp.empty()) m_config.journal->confirm();
  noteKept(m_config.journal->append(m_accepted));
  m_accepted.clear();
}

void Service::catchUp(double now) {
  if (!m_ready || !m_config.journal || !m_config.journal->behind() || now - m_triedToKeep < kRetrySeconds) return;
  noteKept(m_config.journal->catchUp());
}

void Service::noteKept(const Result<void>& kept) {
  m_triedToKeep = nowSeconds();
  if (!kept && !m_journalFails) logWarning(kept.error().text() + "; edits go on, and what is accepted will be kept when it can be");
  m_journalFails = !kept;
}

}  // namespace limn::server
