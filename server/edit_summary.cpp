#include "server/edit_summary.hpp"

#include "renderer/base/log.hpp"

namespace limn::server {
namespace {

using nlohmann::json;

json jsonOf(const protocol::Edit& edit) { return json::parse(protocol::encode(protocol::Batch{1, {edit}}))["edits"][0]; }

Result<protocol::ClientMessage> batchOf(const std::vector<json>& edits) {
  return protocol::decodeClient(json{{"op", "batch"}, {"seq", 1}, {"edits", edits}}.dump());
}

/// Adds the batch of the edits; passes over what the protocol cannot say, and tells it.
void addBatch(std::vector<Accepted>& messages, const std::vector<json>& edits) {
  Result<protocol::ClientMessage> message = batchOf(edits);
  if (message) messages.push_back({message.take()});
  else logWarning("an edit cannot be kept: " + message.error().text() + " in " + json(edits).dump());
}

const std::string kTechnique = "technique/";   // what the subjects of techniques begin with; the rest is the name

bool isTechnique(const std::string& subject) { return subject.starts_with(kTechnique); }

/// "material/3", "environment", "technique/path-tracing": what an edit is about.
std::string subjectOf(const json& edit) {
  const std::string target = edit["target"];
  if (target == "technique") return kTechnique + edit.value("technique", "");
  return edit.contains(target) && edit[target].is_number() ? target + "/" + edit[target].dump() : target;
}

/// Whether another scene has its own; size, display and technique stay as they are.
bool isOfTheScene(const std::string& subject) { return subject != "image" && subject != "resolve" && !isTechnique(subject); }

/// Without the field that a place names; nothing where the rest would be no edit, or one of something else.
std::optional<json> without(json edit, const std::string& place) {
  const json::json_pointer field(place);
  if (field.empty() || !edit.contains(field)) return std::nullopt;
  const bool tellsWhich = field.back() == edit["target"];
  edit.at(field.parent_pointer()).erase(field.back());
  return !tellsWhich && batchOf({edit}) ? std::optional(edit) : std::nullopt;
}

/// Without what the other edit, of the same thing, says; nothing where that was all.
std::optional<json> withoutAllOf(const json& edit, const json& other) {
  json rest = edit;
  bool says = false;
  for (const auto& [name, value] : edit.items()) {
    if (name == "target" || name == edit["target"]) continue;
    if (other.contains(name)) rest.erase(name);
    else says = true;
  }
  return says && batchOf({rest}) ? std::optional(rest) : std::nullopt;
}

}  // namespace

void EditSummary::add(const Accepted& accepted) {
  if (const auto* load = std::get_if<protocol::Load>(&accepted.message)) {
    m_load = Accepted{protocol::Load{1, load->uri}, accepted.contents};
    std::erase_if(m_newest, [](const auto& entry) { return isOfTheScene(entry.first); });
  }
  if (const auto* batch = std::get_if<protocol::Batch>(&accepted.message))
    for (const protocol::Edit& edit : batch->edits) addEdit(edit);
}

void EditSummary::addEdit(const protocol::Edit& edit) {
  const json fields = jsonOf(edit);
  std::string subject = subjectOf(fields);
  // Techniques come last in the map, and behind one without a name the one in use. From one to another nothing is left of before.
  const std::string last = m_newest.empty() ? "" : m_newest.rbegin()->first;
  if (subject == kTechnique && isTechnique(last)) subject = last;
  if (isTechnique(subject) && isTechnique(last) && last != kTechnique && last != subject)
    std::erase_if(m_newest, [](const auto& entry) { return isTechnique(entry.first); });
  json& newest = m_newest[subject];
  if (newest.is_null()) newest = fields;
  else newest.merge_patch(fields);
}

bool EditSummary::forget(const protocol::Edit& edit, const std::string& place) {
  const json asked = jsonOf(edit);
  const auto kept = m_newest.find(subjectOf(asked));
  if (kept == m_newest.end()) return false;
  std::optional<json> rest = place.empty() ? withoutAllOf(kept->second, asked) : without(kept->second, place);
  if (rest) kept->second = std::move(*rest);
  else m_newest.erase(kept);
  return true;
}

std::optional<protocol::Edit> EditSummary::newest(const protocol::Edit& edit) const {
  const auto kept = m_newest.find(subjectOf(jsonOf(edit)));
  if (kept == m_newest.end()) return std::nullopt;
  const Result<protocol::ClientMessage> message = batchOf({kept->second});
  return message ? std::optional(std::get<protocol::Batch>(*message).edits[0]) : std::nullopt;
}

std::vector<Accepted> EditSummary::all() const {
  std::vector<Accepted> all;
  if (m_load) all.push_back(*m_load);
  // A technique may need the size, and the size the technique: they come in one.
  const auto size = m_newest.find("image");
  const auto inUse = m_newest.empty() || !isTechnique(m_newest.rbegin()->first) ? m_newest.end() : std::prev(m_newest.end());
  const bool both = size != m_newest.end() && inUse != m_newest.end();
  for (auto technique = m_newest.lower_bound(kTechnique); technique != m_newest.end(); ++technique) {
    if (both && technique == inUse) addBatch(all, {size->second, technique->second});
    else addBatch(all, {technique->second});
  }
  for (const auto& [subject, edit] : m_newest)
    if (!isTechnique(subject) && (!both || subject != "image")) addBatch(all, {edit});
  return all;
}

}  // namespace limn::server
