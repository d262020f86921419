#include <algorithm>
#include <limits>

#include "renderer/base/clock.hpp"
#include "renderer/base/log.hpp"
#include "server/convert.hpp"
#include "server/service.hpp"

namespace limn::server {
namespace {

constexpr ConnectionId kJournal = std::numeric_limits<ConnectionId>::max();  // whose edits those of a journal are
constexpr double kSafeSeconds = 60.0;
constexpr size_t kMostRequests = Mailbox::kMaxPending / 2;

}  // namespace

void Service::takeUp(const std::vector<protocol::ClientMessage>& messages) {
  std::vector<const protocol::Batch*> batches;
  for (const protocol::ClientMessage& message : messages)
    if (const auto* batch = std::get_if<protocol::Batch>(&message)) batches.push_back(batch);
  // A request holds one edit, so that one which the scene has no place for any more takes no other along; where there are more
  // than the mailbox holds, a few share one.
  const size_t shared = batches.size() / kMostRequests + 1;
  uint32_t seq = 0;
  for (size_t first = 0; first < batches.size(); first += shared) {
    EditJob job{{{kJournal, ++seq}, {}, nowSeconds()}, {}};
    View view = m_view;
    for (size_t i = first; i < std::min(batches.size(), first + shared); ++i)
      for (const protocol::Edit& edit : batches[i]->edits) addEdit(job, edit, view);
    const bool taken = job.images.empty() ? m_mailbox.push(std::move(job.request)) : m_loader->request(std::move(job));
    if (!taken) logWarning("an edit of the journal is lost: too many wait");
  }
  if (seq > 0) logInfo("edits of the journal are taken up: " + std::to_string(batches.size()));
}

void Service::rememberUnacknowledged(const Origin& from, protocol::ClientMessage message) {
  if (m_config.journal) m_unacknowledged.emplace(std::pair(from.client, from.seq), std::move(message));
}

void Service::noteAccepted(const Origin& from) {
  auto accepted = m_unacknowledged.extract({from.client, from.seq});
  if (accepted) m_accepted.push_back(std::move(accepted.mapped()));
}

void Service::noteRefused(const ErrorReply& reply) const {
  if (reply.to.client == kJournal) logWarning("an edit of the journal does not fit any more: " + reply.error.text());
}

// A picture of what the journal holds was made, or a while has passed in which nobody wanted one.
void Service::confirmJournal(double now) {
  if (m_config.journal && (m_frames.newest() || now - m_begunAt > kSafeSeconds)) m_config.journal->confirm();
}

// Before any acknowledgement leaves: these are only queued while replies are routed.
void Service::keepAccepted() {
  if (m_accepted.empty()) return;
  m_config.journal->confirm();
  const Result<void> kept = m_config.journal->append(m_accepted);
  m_accepted.clear();
  if (!kept && !m_journalFails) logWarning(kept.error().text() + "; edits go on, and what is accepted will be kept when it can be");
  m_journalFails = !kept;
}

}  // namespace limn::server
