#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/base/result.hpp"
#include "server/edit_summary.hpp"

namespace limn::server {

/// Accepted edits in a file that outlives the process. A line a message (journal_lines.hpp). What
/// was appended survives the end of the process at once, and of the machine too, but for mere views, which are not synced. When
/// the file has grown far beyond what it says it is written anew, atomically. One thread.
class Journal {
 public:
  /// Opens the file, or makes it, and reads it; from the first line on that is torn or wrong it is cut off. Errors: "io",
  /// "busy" where another process has it open, "bad-file" for a file that is no journal.
  static Result<std::unique_ptr<Journal>> open(const std::filesystem::path& file);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// All that was accepted, by the fewest messages: maybe a `load`, then `batch`es.
  std::vector<protocol::ClientMessage> messages() const;
  /// The scene that was loaded last, if one was: its `load`.
  std::optional<Accepted> load() const { return m_summary.load(); }
  /// `load`s and `batch`es. Errors: "io"; then the file holds none of them, and catchUp() or the next call tries again.
  Result<void> append(std::span<const Accepted> messages);
  /// As EditSummary::forget(); catchUp() writes it.
  void forget(const protocol::Edit& edit, const std::string& place) { m_behind |= m_summary.forget(edit, place); }
  std::optional<protocol::Edit> newest(const protocol::Edit& edit) const { return m_summary.newest(edit); }
  /// Whether the file lacks something that was accepted, or holds something that was forgotten.
  bool behind() const { return m_behind; }
  /// Writes the file as it should be. Errors: "io".
  Result<void> catchUp();
  static constexpr uint32_t kMostStarts = 3;
  /// A process is about to take up what the journal holds. Where so many before did and none came to confirm(), that may be
  /// what ended them: it is set aside. Errors: "io".
  Result<void> begin();
  /// The process lives on with what the journal holds, or did not end because of it.
  void confirm();
  /// Moves what there is to FILE.aside.N and goes on empty and confirmed. Errors: "io".
  Result<void> setAside();

  const std::filesystem::path& file() const { return m_file; }
  uint64_t bytes() const { return m_bytes; }

 private:
  explicit Journal(std::filesystem::path file) : m_file(std::move(file)) {}
  Result<void> lock();
  Result<void> openFile();
  Result<void> read();
  Result<void> rewrite();
  void shorten();
  void writeStarts(uint32_t count);

  std::filesystem::path m_file;
  int m_fd = -1, m_lock = -1;
  uint64_t m_bytes = 0;                ///< of whole lines in the file
  uint64_t m_leastBytes = 0;           ///< that said the same when this was looked at last
  EditSummary m_summary;               ///< of all that was accepted, written or not
  bool m_behind = false;               ///< the file does not say what m_summary says
  bool m_confirmed = false;
};

/// The journal in `directory` that belongs to a scene file, by its contents. Errors: "io".
Result<std::filesystem::path> journalFileFor(const std::filesystem::path& directory, const std::filesystem::path& scene);

}  // namespace limn::server
