#include "server/daemon/journal_start.hpp"

#include <span>
#include <utility>

#include "renderer/base/log.hpp"
#include "server/loader_worker.hpp"

namespace limn::server {

JournalStart::JournalStart(const DaemonOptions& options, std::shared_ptr<Journal> journal)
    : m_given(options.scene), m_assetRoot(options.assetRoot), m_journal(std::move(journal)) {}

Result<std::filesystem::path> JournalStart::scene() {
  if (!m_journal) return m_given;
  if (Result<void> begun = m_journal->begin(); !begun) return begun.error();
  const std::optional<Accepted> load = m_journal->load();
  if (!load) return m_given;
  const Result<std::filesystem::path> scene = resolveAsset(m_assetRoot, std::get<protocol::Load>(load->message).uri);
  m_loaded = scene.ok();
  if (scene) return scene;
  if (Result<void> aside = setAside("the scene that was loaded last is gone: " + scene.error().text()); !aside) return aside.error();
  return m_given;
}

std::optional<std::filesystem::path> JournalStart::insteadOf(const Error& error) {
  if (!m_loaded || error.code == "device-lost") return std::nullopt;
  m_loaded = false;
  if (Result<void> aside = setAside("the scene that was loaded last cannot be begun with: " + error.text()); !aside) {
    logWarning(aside.error().text());
    return std::nullopt;
  }
  return m_given;
}

void JournalStart::read(const LoadReport& report) {
  std::optional<Accepted> load = m_loaded ? m_journal->load() : std::nullopt;
  if (!load || load->contents == 0 || load->contents == report.contents) return;
  load->contents = report.contents;
  Result<void> kept = setAside("the scene that was loaded last has changed");
  if (kept) kept = m_journal->append(std::span(&*load, 1));
  if (!kept) logWarning(kept.error().text());
}

std::vector<protocol::ClientMessage> JournalStart::messages() const {
  return m_journal ? m_journal->messages() : std::vector<protocol::ClientMessage>();
}

void JournalStart::ended(const Result<void>& outcome, bool begun) {
  if (!m_journal) return;
  const bool before = !begun && !m_loaded;  // that the given scene cannot be begun with is not the edits' fault
  if (outcome || before) m_journal->confirm();
  if (const Result<void> kept = m_journal->catchUp(); !kept) logWarning("accepted edits end with the process: " + kept.error().text());
}

Result<void> JournalStart::setAside(const std::string& why) {
  logWarning(why + "; the journal is set aside");
  return m_journal->setAside();
}

}  // namespace limn::server
