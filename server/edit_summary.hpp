#pragma once
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/messages.gen.hpp"

namespace limn::server {

/// The newest value of everything that edits have set: what an old scene needs to become the present one.
class EditSummary {
 public:
  /// A `load` forgets what was edited of the scene before it; edits of `batch` are added in their order; other messages are
  /// nothing.
  void add(const protocol::ClientMessage& message);
  /// Few messages that say the same: maybe a `load`, then a `batch` for each thing that was edited.
  std::vector<protocol::ClientMessage> messages() const;

 private:
  void addEdit(const protocol::Edit& edit);
  void addTechnique(const nlohmann::json& edit);

  std::string m_scene;                               ///< uri of the last `load`; empty: none
  std::map<std::string, nlohmann::json> m_newest;    ///< edits by what they are about
  std::vector<nlohmann::json> m_techniques;          ///< in their order; at most one without a name, and the newest with one
};

}  // namespace limn::server
