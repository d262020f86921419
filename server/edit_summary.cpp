#include "server/edit_summary.hpp"

#include "renderer/base/check.hpp"

namespace limn::server {
namespace {

using nlohmann::json;

json jsonOf(const protocol::Edit& edit) { return json::parse(protocol::encode(protocol::Batch{1, {edit}}))["edits"][0]; }

protocol::ClientMessage messageOf(const json& edit) {
  const json batch{{"op", "batch"}, {"seq", 1}, {"edits", json::array({edit})}};
  Result<protocol::ClientMessage> message = protocol::decodeClient(batch.dump());
  LIMN_CHECK(message.ok());
  return message.take();
}

/// "material/3", "environment": what an edit is about.
std::string subjectOf(const json& edit) {
  const std::string target = edit["target"];
  return edit.contains(target) && edit[target].is_number() ? target + "/" + edit[target].dump() : target;
}

}  // namespace

void EditSummary::add(const protocol::ClientMessage& message) {
  if (const auto* load = std::get_if<protocol::Load>(&message)) {
    *this = {};
    m_scene = load->uri;
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
  const bool same = !m_techniques.empty() &&
                    (!edit.contains("technique") || m_techniques.back().value("technique", "") == edit["technique"]);
  if (!same) return m_techniques.push_back(edit);
  if (edit.contains("parameters")) m_techniques.back()["parameters"].update(edit["parameters"]);
}

std::vector<protocol::ClientMessage> EditSummary::messages() const {
  std::vector<protocol::ClientMessage> all;
  if (!m_scene.empty()) all.push_back(protocol::Load{1, m_scene});
  for (const json& edit : m_techniques) all.push_back(messageOf(edit));
  for (const auto& [subject, edit] : m_newest) all.push_back(messageOf(edit));
  return all;
}

}  // namespace limn::server
