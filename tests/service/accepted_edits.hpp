#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/edit_summary.hpp"

/// Edits as a journal keeps them.
namespace limn::server::testing {

using Messages = std::vector<protocol::ClientMessage>;

inline protocol::ClientMessage edited(protocol::Edit edit) { return protocol::Batch{1, {std::move(edit)}}; }

inline protocol::ClientMessage roughness(uint32_t material, float value) {
  protocol::MaterialEdit edit;
  edit.material = material;
  edit.roughness = value;
  return edited(edit);
}

inline protocol::ClientMessage view(double x) {
  protocol::CameraEdit edit;
  edit.view.eye = {x, 1.0, 2.0};
  edit.view.yfov = 0.5f;
  return edited(edit);
}

inline protocol::ClientMessage technique(std::optional<std::string> name, std::vector<std::pair<std::string, double>> parameters) {
  return edited(protocol::TechniqueEdit{std::move(name), std::move(parameters)});
}

inline Messages messagesOf(const EditSummary& summary) {
  Messages messages;
  for (const Accepted& accepted : summary.all()) messages.push_back(accepted.message);
  return messages;
}

/// What a journal has to say after these.
inline Messages summaryOf(const Messages& messages, size_t count) {
  EditSummary summary;
  for (size_t i = 0; i < count; ++i) summary.add({messages[i]});
  return messagesOf(summary);
}

/// A bit of everything.
inline Messages someEdits() {
  protocol::MaterialEdit coat;
  coat.material = 2;
  coat.clearcoat = 0.1f;
  protocol::EnvironmentEdit sky;
  sky.image = "skies/evening.hdr";
  return {roughness(2, 0.25f), view(1.0), edited(coat), technique({}, {{"maxBounces", 3.0}}), roughness(2, 0.75f), edited(sky),
          technique("point-projection", {{"bounces", 2.0}}), protocol::Load{7, "rooms/käse.glb"}, roughness(1, 0.5f), view(4.0)};
}

}  // namespace limn::server::testing
