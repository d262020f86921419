#include "server/edit_summary.hpp"

#include "renderer/base/log.hpp"

namespace limn::server {
namespace {

using nlohmann::json;

json jsonOf(const protocol::Edit& edit) { return json::parse(protocol::encode(protocol::Batch{1, {edit}}))["edits"][0]; }

/// Adds the batch of the edits; passes over what the protocol cannot say, and tells it.
void addBatch(std::vector<protocol::ClientMessage>& messages, const std::vector<json>& edits) {
  const json batch{{"op", "batch"}, {"seq", 1}, {"edits", edits}};
  Result<protocol::ClientMessage> message = protocol::decodeClient(batch.dump());
  if (message) messages.push_back(message.take());
  else logWarning("an edit cannot be kept: " + message.error().text() + " in " + batch.dump());
}

/// "material/3", "environment": what an edit is about.
std::string subjectOf(const json& edit) {
  const std::string target = edit["target"];
  return edit.contains(target) && edit[target].is_number() ? target + "/" + edit[target].dump() : target;
}

/// Whether another scene has its own; size, display and technique stay as they are.
bool isOfTheScene(const std::string& subject) { return subject != "image" && subject != "resolve"; }

}  // namespace

void EditSummary::add(const protocol::ClientMessage& message) {
  if (const auto* load = std::get_if<protocol::Load>(&message)) {
    m_scene = load->uri;
    std::erase_if(m_newest, [](const auto& entry) { return isOfTheScene(entry.first); });
  }
  if (const auto* batch = std::get_if<protocol::Batch>(&message))
    for (const protocol::Edit& edit : batch->edits) addEdit(edit);
}

void EditSummary::addEdit(const protocol::Edit& edit) {
  const json fields = jsonOf(edit);
  if (std::holds_alternative<protocol::TechniqueEdit>(edit)) return addTechnique(fields);
  json& newest = m_newest[subjectOf(fields)];
  if (newest.is_null()) newest = fields;
  else newest.update(fields);
}

void EditSummary::addTechnique(const json& edit) {
  const std::string last = m_techniques.empty() ? "" : m_techniques.back().value("technique", "");
  const bool named = edit.contains("technique");
  if (m_techniques.empty() || (named && last != edit["technique"])) {
    // From one technique to another nothing is left of before. Which one a first edit without a name was about is not known.
    if (!last.empty()) m_techniques.clear();
    m_techniques.push_back(edit);
    return;
  }
  if (edit.contains("parameters")) m_techniques.back()["parameters"].update(edit["parameters"]);
}

std::vector<protocol::ClientMessage> EditSummary::messages() const {
  std::vector<protocol::ClientMessage> all;
  if (!m_scene.empty()) all.push_back(protocol::Load{1, m_scene});
  // A technique may need the size, and the size the technique: they come in one.
  const auto size = m_newest.find("image");
  const bool both = size != m_newest.end() && !m_techniques.empty();
  for (const json& edit : m_techniques) {
    if (both && &edit == &m_techniques.back()) addBatch(all, {size->second, edit});
    else addBatch(all, {edit});
  }
  for (const auto& [subject, edit] : m_newest)
    if (!both || subject != "image") addBatch(all, {edit});
  return all;
}

}  // namespace limn::server
