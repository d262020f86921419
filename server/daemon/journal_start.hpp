#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/scene/gltf_loader.hpp"
#include "server/daemon/daemon_options.hpp"
#include "server/journal.hpp"

namespace limn::server {

/// What a daemon begins with: the scene that its journal says was loaded last, and the edits of it. Without a journal: `--scene` and
/// nothing else. One thread at a time.
class JournalStart {
 public:
  /// `journal`: null where none is kept.
  JournalStart(const DaemonOptions& options, std::shared_ptr<Journal> journal);

  /// The scene to begin with. Errors: "io" of the journal.
  Result<std::filesystem::path> scene();
  /// The scene cannot be begun with: another, for which the journal is set aside. Nothing where the scene is `--scene`, or where the
  /// device was lost.
  std::optional<std::filesystem::path> insteadOf(const Error& error);
  /// The scene was read. One that is not what it was when it was loaded keeps none of its edits.
  void read(const LoadReport& report);
  /// To be taken up.
  std::vector<protocol::ClientMessage> messages() const;
  /// The process ends. `begun`: the renderer had the scene.
  void ended(const Result<void>& outcome, bool begun);

 private:
  Result<void> setAside(const std::string& why);

  std::filesystem::path m_given, m_assetRoot;
  std::shared_ptr<Journal> m_journal;
  bool m_loaded = false;               ///< the scene is the one that was loaded last, not the given one
};

}  // namespace limn::server
