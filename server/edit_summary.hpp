#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/journal_lines.hpp"

namespace limn::server {

/// The newest value of everything that edits have set: what an old scene needs to become the present one.
class EditSummary {
 public:
  /// A `load` forgets what was edited of the scene before it; edits of `batch` are added in their order; other messages are
  /// nothing.
  void add(const Accepted& accepted);
  /// Forgets what a renderer refused of an edit that all() held: the field that `place` names, "/roughness" or
  /// "/parameters/bounces", or all that was edited there where nothing of use would be left. False where nothing of it is known.
  bool forget(const protocol::Edit& edit, const std::string& place);
  /// The newest value of what an edit is about; nothing where it was forgotten.
  std::optional<protocol::Edit> newest(const protocol::Edit& edit) const;
  /// Few messages that say the same: maybe a `load`, then a `batch` for each thing that was edited.
  std::vector<Accepted> all() const;
  const std::optional<Accepted>& load() const { return m_load; }   ///< the last

 private:
  void addEdit(const protocol::Edit& edit);

  std::optional<Accepted> m_load;                    ///< the last
  std::map<std::string, nlohmann::json> m_newest;    ///< edits by what they are about; at most one technique has a name
};

}  // namespace limn::server
